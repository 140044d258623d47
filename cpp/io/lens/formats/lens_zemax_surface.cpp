// Lines of a surface in a .zmx file.

#include <algorithm>
#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "lens_zemax_reader.hpp"
#include "lens_zemax_shape.hpp"

namespace realcam::io {

bool states_a_glass(const ZemaxSurface& s) {
    const bool are_defaults = s.n_d == 1.5 && s.v_d == 40;
    return s.n_d >= 1.3 && s.n_d <= 2.4 && s.v_d >= 10 && s.v_d <= 100 && !are_defaults;
}

bool ZemaxReader::read_surface_line(const std::string& word, std::string_view rest) {
    static const std::set<std::string> ours{"STOP", "TYPE", "CURV", "CONI", "DISZ", "DIAM", "CLAP", "FLAP", "OBSC",
                                            "OBDC", "SQAP", "ELAP", "SPID", "SQOB", "ELOB", "UDAD", "USAP", "UDOB",
                                            "SCBD", "TILT", "SDEC", "GLAS", "PARM", "XDAT", "COAT"};
    if (!ours.contains(word)) return false;
    ZemaxSurface& s = out_.surfaces.back();
    if (word == "STOP") return s.row.is_stop = true;
    const Words words = lines_.words(rest);
    if (word == "TYPE") {
        if (words.empty()) lines_.fail("TYPE needs the type of the surface");
        s.type = upper_case(words[0].text);
    } else if (word == "CURV") {
        s.row.curvature = number(words, 0, "the curvature") / out_.unit;
    } else if (word == "CONI") {
        s.row.conic = number(words, 0, "the conic");
    } else if (word == "DISZ") {
        if (words.empty()) lines_.fail("DISZ needs the thickness");
        s.has_thickness = true;
        const double thickness = length_or_infinity(words, 0, "the thickness");
        s.at_infinity = std::isinf(thickness);
        s.row.thickness = s.at_infinity ? 0 : thickness;
    } else if (word == "DIAM") {
        s.diameter = length(words, 0, "the semi-diameter");
    } else if (word == "CLAP" || word == "FLAP") {
        s.row.blocks = true;
        // A floating aperture is as large as the semi-diameter.
        const double inner = length(words, 0, "the inner radius"),
                     outer = length_or_infinity(words, 1, "the outer radius");
        s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, inner);
        s.row.is_open_outside = word == "CLAP" && outer == kInfinity;
        if (word == "CLAP" && !s.row.is_open_outside) s.row.clear_semi_diameter = outer;
    } else if (word == "OBSC") {
        s.row.blocks = true;
        if (length(words, 0, "the inner radius") != 0)
            foreign("an obscuration with a hole");
        else
            s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, length(words, 1, "the outer radius"));
        // An obscuration is the complement of a circular aperture. The semi-diameter (DIAM) of a surface with an
        // obscuration does not limit light.
        s.row.is_open_outside = s.row.clear_semi_diameter == 0;
    } else if (word == "OBDC") {
        s.aperture_offset = {out_.unit * number(words, 0, "the decentre"),
                             out_.unit * number(words, 1, "the decentre")};
    } else if (word == "SQAP" || word == "ELAP") {
        s.row.blocks = true;
        s.row.aperture_shape.kind = word == "SQAP" ? ApertureOutline::rectangle : ApertureOutline::ellipse;
        s.row.aperture_shape.half = {length(words, 0, "the half width"), length(words, 1, "the half width")};
    } else if (word == "SQOB" || word == "ELOB") {
        s.row.blocks = true;
        Obscuration piece;
        piece.is_rectangle = word == "SQOB";
        piece.half = {length(words, 0, "the half width"), length(words, 1, "the half width")};
        s.row.aperture_shape.obscurations.push_back(piece);
    } else if (word == "SPID") {
        s.row.blocks = true;
        s.arm_width = length(words, 0, "the width of the arms");
        if (words.size() < 2) lines_.fail("SPID needs the number of arms");
        s.arms = lines_.whole_number_of(words[1].text, "the number of arms", 1, kMaxObscurations);
    } else if (word == "UDAD" || word == "USAP" || word == "UDOB") {
        foreign("an aperture that is no circle (" + word + ")");
    } else if (word == "SCBD") {
        read_tilt(s, words);
    } else if (word == "TILT" || word == "SDEC") {
        foreign("a tilted or decentred surface (" + word + ")");
    } else if (word == "GLAS") {
        read_glass(s, words);
    } else if (word == "PARM") {
        const int i = whole(words, "the number of the parameter", 0, 300);
        s.parameters[i] = number(words, 1, "the parameter");
        s.parameter_lines[i] = lines_.number();
    } else if (word == "XDAT") {
        s.extra[whole(words, "the number of the extra datum", 1, 1000)] = number(words, 1, "the extra datum");
    } else if (word == "COAT") {
        out_.coatings.insert(words.empty() ? std::string() : printable(words[0].text.substr(0, 40)));
    }
    return true;
}

/// Reads tilt and decentre of the surface itself: 1 before or 2 behind it, their order, their source, and five values.
void ZemaxReader::read_tilt(ZemaxSurface& s, const Words& words) {
    const int side = whole(words, "the side of the tilt", 1, 2);
    const auto at = [&](std::size_t i) { return number_or(words, i, "the tilt or decentre", 0); };
    const Affine<double> frame = zemax_break({length(words, 3, "the decentre"), length(words, 4, "the decentre"), 0},
                                             {at(5), at(6), at(7)}, at(1) != 0);
    // Source of the tilt behind the surface: 1 repeats the one before it, and 2 reverses that.
    const double source = at(2);
    if (side == 1)
        s.row.before = frame;
    else
        s.row.behind = source == 1 ? s.row.before : source == 2 ? inverse_motion(s.row.before) : frame;
    if (source != 0 && (side == 1 || source > 2)) foreign("a tilt that is picked up (SCBD)");
}

void ZemaxReader::read_glass(ZemaxSurface& s, const Words& words) {
    if (words.empty()) lines_.fail("GLAS needs the name of the glass");
    s.glass = std::string(words[0].text);
    s.glass_line = lines_.number();
    s.glass_kind = words.size() > 1 ? lines_.whole_number_of(words[1].text, "the kind of the glass", 0, 100) : 0;
    s.pickup = s.glass_kind == 2 && words.size() > 2
                   ? lines_.whole_number_of(words[2].text, "the surface whose glass is picked up", 0, 1 << 20)
                   : 0;
    s.n_d = number_or(words, 3, "the glass's n_d", 0);
    s.v_d = number_or(words, 4, "the glass's V_d", 0);
    s.partial = number_or(words, 5, "the glass's partial dispersion", 0);
    if (states_a_glass(s))
        s.hint =
            "n_d = " + printable(words[3].text.substr(0, 30)) + ", V_d = " + printable(words[4].text.substr(0, 30));
}
}  // namespace realcam::io
