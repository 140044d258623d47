// The lines of one surface in a .zmx file.

#include <algorithm>

#include "lens_zemax_reader.hpp"
#include "printable.hpp"

namespace realcam::io {

bool ZemaxReader::read_surface_line(const std::string& word, std::string_view rest) {
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
        s.at_infinity = upper_case(words[0].text) == "INFINITY";
        s.row.thickness = s.at_infinity ? 0 : length(words, 0, "the thickness");
    } else if (word == "DIAM") {
        s.diameter = length(words, 0, "the semi-diameter");
    } else if (word == "CLAP" || word == "FLAP") {
        s.row.blocks = true;
        // A floating aperture is as large as the semi-diameter.
        const double inner = length(words, 0, "the inner radius"), outer = length(words, 1, "the outer radius");
        s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, inner);
        if (word == "CLAP") s.row.clear_semi_diameter = outer;
    } else if (word == "OBSC") {
        s.row.blocks = true;
        if (length(words, 0, "the inner radius") != 0)
            foreign("an obscuration with a hole");
        else
            s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, length(words, 1, "the outer radius"));
    } else if (word == "OBDC") {
        if (number(words, 0, "the decentre") != 0 || number(words, 1, "the decentre") != 0)
            foreign("a decentred aperture");
    } else if (word == "SQAP" || word == "ELAP" || word == "SPID" || word == "SQOB" || word == "ELOB" ||
               word == "UDAD" || word == "USAP" || word == "UDOB") {
        foreign("an aperture that is no circle (" + word + ")");
    } else if (word == "SCBD" || word == "TILT" || word == "SDEC") {
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
        out_.coatings.insert(words.empty() ? std::string() : printable(words[0].text));
    } else {
        return false;
    }
    return true;
}

void ZemaxReader::read_glass(ZemaxSurface& s, const Words& words) {
    if (words.empty()) lines_.fail("GLAS needs the name of the glass");
    s.glass = std::string(words[0].text);
    s.glass_line = lines_.number();
    s.glass_kind = words.size() > 1 ? lines_.whole_number_of(words[1].text, "the kind of the glass", 0, 100) : 0;
    s.n_d = number_or(words, 3, "the glass's n_d", 0);
    s.v_d = number_or(words, 4, "the glass's V_d", 0);
    s.partial = number_or(words, 5, "the glass's partial dispersion", 0);
    // Of a glass of a catalogue these are what the program had there before: 1.5 and 40 in new files.
    if (s.n_d > 1 && s.v_d > 0 && !(s.n_d == 1.5 && s.v_d == 40))
        s.hint = "n_d = " + std::string(words[3].text) + ", V_d = " + std::string(words[4].text);
}
}  // namespace realcam::io
