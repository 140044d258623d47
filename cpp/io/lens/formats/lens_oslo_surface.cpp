// Commands of a .len file for one surface.

#include <cmath>

#include "../../text/printable.hpp"
#include "../../text/text_number.hpp"
#include "lens_oslo_reader.hpp"

namespace realcam::io {

bool OsloReader::read_surface(const std::string& word, const Words& words) {
    OsloSurface& s = surface();
    if (word == "RD" || word == "RDF") {
        const bool is_plane = words.size() > 1 && is_infinity(words[1].text);
        const double radius = is_plane ? 0 : number(words, 1, "the radius");
        s.curvature = radius == 0 || std::fabs(radius) > 1e17 ? 0 : 1 / radius;
    } else if (word == "CV" || word == "CVF") {
        s.curvature = number(words, 1, "the curvature");
    } else if (word == "TH" || word == "THF") {
        const bool is_infinite = words.size() > 1 && is_infinity(words[1].text);
        if (is_infinite && s.number > 0) lines_.fail("the thickness is infinite; only the object may be as far away");
        s.thickness = is_infinite ? kInfinity : number(words, 1, "the thickness");
    } else if (word == "CC") {
        s.conic = number(words, 1, "the conic");
    } else if (word == "AST") {
        for (OsloSurface& other : rows_) other.is_stop = false;
        s.is_stop = true;
    } else if (word == "AIR" || word == "AIF" || word == "RFL" || word == "RFH") {
        s.is_mirror = word[0] == 'R';
        s.glass.clear();
        s.indices.clear();
        s.pair.reset();
    } else if (word == "GLA" || word == "GLF") {
        read_glass(words);
    } else if (word == "AP" || word == "APF") {
        read_aperture(words);
    } else if (word == "PK") {
        read_pickup(words);
    } else if (word == "PU") {
        s.axial_slope = number(words, 1, "the slope of the axial ray");
    } else if (word == "PY") {
        s.axial_height = number(words, 1, "the height of the axial ray");
    } else {
        return read_asphere(word, words) || read_foreign(word, words);
    }
    return true;
}

bool OsloReader::read_asphere(const std::string& word, const Words& words) {
    OsloSurface& s = surface();
    if (word.size() == 2 && word[0] == 'A' && word[1] >= 'D' && word[1] <= 'G') {
        s.plain_terms[4 + 2 * (word[1] - 'D')] = number(words, 1, "the coefficient " + word);
    } else if (word == "ASP") {
        const std::string kind = words.size() > 1 ? upper_case(words[1].text.substr(0, 10)) : "";
        if (kind == "ASR" || kind == "1")
            s.aspheric_step = 2;
        else if (kind == "ARA")
            s.aspheric_step = 1;
        else if (kind != "ADO" && kind != "0")
            foreign("an aspheric surface of the kind " + printable(kind));
    } else if (word.starts_with("AS") && word.size() > 2 && word.size() < 6 &&
               word.find_first_not_of("0123456789", 2) == word.npos) {
        const int index = std::stoi(word.substr(2));
        s.aspheric[index] = number(words, 1, "the coefficient " + word);
        if (s.aspheric_step == 0) s.aspheric_step = 2;
    } else {
        return false;
    }
    return true;
}

bool OsloReader::read_foreign(const std::string& word, const Words& words) {
    static const std::map<std::string, std::string> numbers{{"DCX", "a tilt or decentre"},
                                                            {"DCY", "a tilt or decentre"},
                                                            {"DCZ", "a tilt or decentre"},
                                                            {"TLA", "a tilt or decentre"},
                                                            {"TLB", "a tilt or decentre"},
                                                            {"TLC", "a tilt or decentre"},
                                                            {"TOX", "a tilt or decentre"},
                                                            {"TOY", "a tilt or decentre"},
                                                            {"TOZ", "a tilt or decentre"},
                                                            {"CVX", "a toric surface"},
                                                            {"RDX", "a toric surface"},
                                                            {"PFL", "a perfect lens"},
                                                            {"GSP", "a grating"},
                                                            {"APN", "a special aperture"},
                                                            {"PUC", "a solve of the chief ray"},
                                                            {"PYC", "a solve of the chief ray"},
                                                            {"EC", "a solve of the edge"},
                                                            {"PI", "a solve of the angle"},
                                                            {"PIC", "a solve of the angle"},
                                                            {"DOR", "a diffractive surface"},
                                                            {"HOR", "a hologram"}};
    static const std::map<std::string, std::string> words_alone{{"BEN", "a bent axis"},
                                                                {"GC", "global coordinates"},
                                                                {"RCO", "a return of coordinates"},
                                                                {"GOR", "a grating"},
                                                                {"TIR", "total internal reflection"},
                                                                {"ELI", "a non-sequential element"},
                                                                {"NAC", "a non-sequential element"},
                                                                {"GRC", "a glass with a gradient"},
                                                                {"GRD", "a glass with a gradient"},
                                                                {"GRT", "a glass with a gradient"},
                                                                {"SPL", "a spline surface"},
                                                                {"ARR", "an array of lenses"},
                                                                {"EIK", "an eikonal surface"},
                                                                {"FZL", "a Fresnel surface"},
                                                                {"FRN", "a Fresnel surface"}};
    if (const auto found = numbers.find(word); found != numbers.end()) {
        const bool is_solve = found->second.starts_with("a solve");
        if (is_solve || number(words, 1, word) != 0) foreign(found->second + " (" + word + ")");
        return true;
    }
    if (const auto found = words_alone.find(word); found != words_alone.end()) {
        foreign(found->second + " (" + word + ")");
        return true;
    }
    if (word == "LMO") {
        if (words.size() > 1 && upper_case(words[1].text) == "NSS") foreign("a non-sequential group (LMO NSS)");
        return true;
    }
    // Parts of a special aperture, which is recorded by its own command.
    static const std::set<std::string> parts{"ATP", "AAC", "AGN", "AAN", "AX1", "AX2", "AY1", "AY2", "APK"};
    return parts.contains(word) || word.starts_with("AVX") || word.starts_with("AVY");
}

void OsloReader::read_glass(const Words& words) {
    OsloSurface& s = surface();
    if (words.size() < 2) lines_.fail("GLA needs a glass");
    s.glass.clear();
    s.indices.clear();
    s.pair.reset();
    s.is_mirror = false;
    s.glass_line = lines_.number();
    std::size_t first = 1;
    const bool is_model = upper_case(words[1].text.substr(0, 4)) == "MOD";
    const auto is_number = [&](std::size_t i) {
        std::string_view rest = i < words.size() ? words[i].text : "";
        return take_number(rest) && rest.empty();
    };
    const bool is_code = words.size() == 2 && glass_of_number(words[1].text);
    if (is_model) {
        first = is_number(2) ? 2 : 3;  // a name may come between
    } else if (!is_number(1) || is_code) {
        s.glass = std::string(words[1].text);
        return;
    }
    for (std::size_t i = first; i < words.size() && s.indices.size() < kMostFileIndices; ++i)
        s.indices.push_back(number(words, i, "the index"));
    if (is_model && s.indices.size() == 2 && s.indices[1] >= 10) {
        s.pair = AbbePair{s.indices[0], s.indices[1]};
        s.indices.clear();
    } else if (s.indices.empty()) {
        lines_.fail("GLA needs a glass, or its indices");
    }
}

void OsloReader::read_aperture(const Words& words) {
    OsloSurface& s = surface();
    std::size_t i = 1;
    for (; i < words.size(); ++i) {
        const std::string kind = upper_case(words[i].text.substr(0, 4));
        if (kind == "CHK")
            s.is_checked = true;
        else if (kind == "UNC" || kind == "SPC")
            s.is_checked = false;
        else
            break;
    }
    const double radius = number(words, i, "the radius of the aperture");
    if (radius < 0) lines_.fail("the radius of the aperture must be positive");
    // An object at infinity has a radius as large as its distance.
    s.semi_diameter = unit_ * radius > kLongest ? 0 : radius;
}

void OsloReader::read_pickup(const Words& words) {
    if (words.size() < 3) lines_.fail("PK needs what is picked up, and a surface");
    const std::string what = upper_case(words[1].text.substr(0, 8));
    static const std::set<std::string> known{"CV", "CVM", "TH", "THM", "GLA", "AP"};
    if (!known.contains(what)) return foreign("a pickup of " + printable(what) + " (PK)");
    const int stated = lines_.whole_number_of(words[2].text, "the surface that is picked up", -1000, 1000);
    // A negative number is relative to this surface.
    const int from = stated < 0 ? surface().number + stated : stated;
    if (from < 0 || from >= surface().number)
        lines_.fail("PK " + what + " picks up from surface " + std::to_string(from) + "; one in front is wanted");
    const double added = words.size() > 3 ? number(words, 3, "what is added") : 0;
    surface().pickups.push_back({what, from, added, lines_.number()});
}

}  // namespace realcam::io
