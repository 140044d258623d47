// Pickups and solves of a .len file, which does not always contain their results.

#include <cmath>

#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"
#include "lens_oslo_reader.hpp"

namespace realcam::io {

void OsloReader::resolve_pickups() {
    // Pickups refer to surfaces in front, whose own pickups are resolved by then.
    for (OsloSurface& s : rows_)
        for (const OsloSurface::Pickup& pickup : s.pickups) pick_up(s, pickup);
}

void OsloReader::pick_up(OsloSurface& s, const OsloSurface::Pickup& pickup) {
    const OsloSurface& from = rows_[static_cast<std::size_t>(pickup.from)];
    const double sign = pickup.what.ends_with('M') ? -1 : 1;
    if (pickup.what.starts_with("CV")) {  // the complete shape
        s.curvature = sign * from.curvature + pickup.added;
        s.conic = from.conic;
        s.aspheric_step = from.aspheric_step;
        s.aspheric = from.aspheric;
        s.plain_terms = from.plain_terms;
        for (auto* terms : {&s.aspheric, &s.plain_terms})
            for (auto& [power, value] : *terms) value *= sign;
        if (from.axial_slope)
            throw LensFileError("picks up the curvature of surface " + std::to_string(from.number) +
                                    ", which a solve has; a stated one is wanted",
                                p_.file, pickup.line, s.number);
    } else if (pickup.what.starts_with("TH")) {
        s.thickness = sign * from.thickness + pickup.added;
        if (from.axial_height)
            throw LensFileError("picks up the thickness of surface " + std::to_string(from.number) +
                                    ", which a solve has; a stated one is wanted",
                                p_.file, pickup.line, s.number);
    } else if (pickup.what == "AP") {
        s.semi_diameter = from.semi_diameter;
    } else {
        if (from.is_mirror) throw LensFileError("picks up the glass of a mirror", p_.file, pickup.line, s.number);
        s.glass = from.glass;
        s.indices = from.indices;
        s.pair = from.pair;
        s.is_mirror = false;
        s.glass_line = pickup.line;
    }
}

Glass OsloReader::named_glass(const std::string& name) {
    // OSLO's files name no maker; OSLO searches Schott's catalogue first, which shares plain names with other makers.
    const std::vector<std::string> first{"SCHOTT"};
    if (!glasses_.in_catalogue(name, first)) return glasses_.find(name, {});
    if (!glasses_.in_catalogue(name, {}) && shared_names_.insert(name).second)
        p_.remarks.push_back("the glass " + in_quotes(name) + ", whose name several makers use, is taken for Schott's");
    return glasses_.find(name, first);
}

Glass OsloReader::medium_of(const OsloSurface& s) {
    try {
        if (s.pair) return glass_of_pair(s.pair->n_d, s.pair->v_d);
        if (!s.glass.empty()) return named_glass(s.glass);
        if (s.indices.empty() || s.is_mirror) return Glass::air();
        const std::vector<double> wavelengths = wavelengths_um();
        bool is_one = true;
        for (const double index : s.indices) is_one = is_one && index == s.indices.front();
        if (is_one) return glass_of_pair(s.indices.front(), 0);
        if (s.indices.size() != wavelengths.size())
            throw InputError("has " + std::to_string(s.indices.size()) + " indices for " +
                             std::to_string(wavelengths.size()) + " wavelengths (WV)");
        std::vector<Glass::TablePoint> points;
        for (std::size_t i = 0; i < wavelengths.size(); ++i) points.push_back({1000 * wavelengths[i], s.indices[i]});
        Glass glass = Glass::table(std::move(points));
        glass.label = "glass of surface " + std::to_string(s.number);
        return glass;
    } catch (const InputError& error) {
        throw LensReadError(error, p_.file, s.glass_line, s.number);
    }
}

void OsloReader::resolve_solves() {
    const auto fail = [&](const OsloSurface& s, const std::string& message) {
        throw LensFileError(message, p_.file, s.line, s.number);
    };
    // In the file's unit, beginning at the object's distance. Only a beam radius determines the height of the ray; a
    // solve for height 0 does not need it.
    const bool is_far = rows_.front().thickness >= 1e8;
    const double radius = beam_radius_.value_or(1);
    ParaxialRay ray{radius, is_far ? 0 : radius / rows_.front().thickness};
    double index = media_.front().index(p_.wavelength_nm), sign = 1;
    for (std::size_t i = 1; i + 1 < rows_.size(); ++i) {
        OsloSurface& s = rows_[i];
        if (s.is_mirror) media_[i] = media_[i - 1];  // light returns through the medium in front of it
        const double before = sign * index;
        if (s.is_mirror) sign = -sign;
        index = media_[i].index(p_.wavelength_nm);
        const double after = sign * index;
        if ((s.axial_slope || s.axial_height.value_or(0) != 0) && aperture_)
            fail(s, "a solve of the axial ray (PU, PY) needs the radius of the beam (EBR)");
        if (s.axial_slope) {
            const double bend = ray.height * (after - before);
            if (bend == 0) fail(s, "no curvature gives the axial ray the slope of the solve (PU)");
            s.curvature = (before * ray.slope - after * *s.axial_slope) / bend;
        }
        ray = refract_paraxial(ray, s.curvature, before, after);
        if (s.axial_height) {
            if (ray.slope == 0) fail(s, "no thickness gives the axial ray the height of the solve (PY)");
            s.thickness = (*s.axial_height - ray.height) / ray.slope;
        }
        ray.height += s.thickness * ray.slope;
    }
}

}  // namespace realcam::io
