// Reader of pbrt's lens tables (.dat). A row is radius, thickness, index behind the surface, clear diameter; rows go
// from the scene to the film, lengths are in mm. A radius of 0 marks the aperture stop, an index of 0 means air.
//
// There are two conventions for the thickness: in pbrt it is the distance to the next surface, in other programs that
// read such tables the distance from the preceding one. The first row distinguishes them: its thickness is 0 in the
// second convention, because no surface precedes it, and not in the first one, where it is that of an element.

#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_format.hpp"
#include "../lens_material.hpp"
#include "../lens_text.hpp"

namespace realcam::io {

PbrtThickness pbrt_thickness_named(const std::string& name) {
    if (name == "after") return PbrtThickness::after;
    if (name == "before") return PbrtThickness::before;
    throw InputError("the thickness in a pbrt lens table must be \"after\" or \"before\" its surface; it is " +
                     in_quotes(name));
}

Prescription read_pbrt(std::string_view text, const std::string& file, LensGlasses& glasses) {
    const PbrtThickness thickness = glasses.options().pbrt_thickness;
    LensLines lines(text, file, glasses.options().keep_going);
    Prescription p;
    p.file = file;
    p.format = "pbrt";
    p.has_film_distance = false;  // pbrt focuses the lens itself
    std::string_view line;
    while (lines.next(line)) {
        const std::size_t comment = line.find('#');
        if (comment != line.npos && p.title.empty()) p.title = without_blanks(line.substr(comment + 1));
        const std::vector<LensWord> words = lines.words(line.substr(0, comment));
        if (words.empty()) continue;
        if (words.size() == 1 && p.surfaces.empty()) {  // ISETCam's files begin with such a line
            p.remarks.push_back("the focal length before the rows, " +
                                number_label(lines.number_of(words[0].text, "the focal length")) +
                                " mm, is ignored: it follows from the surfaces");
            continue;
        }
        if (p.surfaces.size() >= kMaxFileSurfaces)
            lines.fail("the file has more than " + std::to_string(kMaxFileSurfaces) + " surfaces");
        const int number = static_cast<int>(p.surfaces.size()) + 1;
        lines.set_surface(number);
        if (words.size() != 4)
            lines.fail("has " + std::to_string(words.size()) +
                       " columns; expected radius, thickness, index and diameter");
        const auto value = [&](std::size_t i, const char* what) { return lines.number_of(words[i].text, what); };
        const bool is_plane = is_infinity(words[0].text);
        PrescriptionSurface row;
        row.line = lines.number();
        row.number = number;
        const double radius = is_plane ? kInfinity : value(0, "the radius"), index = value(2, "the index");
        row.is_stop = radius == 0;
        row.curvature = row.is_stop ? 0 : 1 / radius;
        row.thickness = value(1, "the thickness");
        if (index != 0 && !(index >= 1 && index < 10)) lines.fail("the index must be 0 (air), or lie between 1 and 10");
        if (index > 1 && !row.is_stop) {
            row.material = Glass::constant(index);
            row.material.label = number_label(index);
        }
        row.clear_semi_diameter = 0.5 * value(3, "the diameter");
        if (!(row.clear_semi_diameter > 0)) lines.fail("the diameter must be positive");
        p.surfaces.push_back(std::move(row));
    }
    if (p.surfaces.empty()) throw LensFileError("has no rows; expected radius, thickness, index and diameter", file);
    const bool is_before_surface = thickness == PbrtThickness::before ||
                                   (thickness == PbrtThickness::by_first_row && p.surfaces.front().thickness == 0);
    if (is_before_surface) {
        for (std::size_t i = 0; i + 1 < p.surfaces.size(); ++i) p.surfaces[i].thickness = p.surfaces[i + 1].thickness;
    }
    p.surfaces.back().thickness = 0;
    // The stop is a plane in the surrounding medium.
    for (std::size_t i = 1; i < p.surfaces.size(); ++i)
        if (p.surfaces[i].is_stop) p.surfaces[i].material = p.surfaces[i - 1].material;
    p.remarks.push_back(std::string("thicknesses are assumed to be those ") + (is_before_surface ? "before" : "after") +
                        " their surfaces" +
                        (thickness == PbrtThickness::by_first_row
                             ? std::string(", because the first is ") + (is_before_surface ? "0" : "not 0")
                             : ""));
    return p;
}

}  // namespace realcam::io
