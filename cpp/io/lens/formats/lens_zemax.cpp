// Converts the content of a Zemax OpticStudio .zmx file to a prescription. Surface 0 is the object, the last one the
// image.

#include <algorithm>
#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_readers.hpp"
#include "../lens_text.hpp"
#include "lens_zemax_file.hpp"
#include "lens_zemax_shape.hpp"

namespace realcam::io {
namespace {

class Converter {
public:
    Converter(ZemaxFile file, LensGlasses& glasses)
        : file_(std::move(file)), p_(std::move(file_.prescription)), glasses_(glasses) {}

    Prescription prescription() {
        complete_ends();
        glasses_are_stated_ = find_out_whether_glasses_are_stated();
        for (std::size_t i = 0; i < file_.surfaces.size(); ++i) convert(file_.surfaces[i], i);
        set_object();
        set_fields();
        set_wavelength();
        set_zoom();
        if (!file_.unknown.empty())
            p_.remarks.push_back("lines of keywords that are not known were left out: " + short_list(file_.unknown));
        return std::move(p_);
    }

private:
    /// Adds object and image to lists of refracting faces alone: some exporters give surface 0 the glass of the first
    /// element, and end the list at the last face.
    void complete_ends() {
        const bool begins_in_glass = !file_.surfaces.front().glass.empty() && !file_.surfaces.front().at_infinity;
        const ZemaxSurface end = file_.surfaces.back();  // a copy, because surfaces are inserted below
        const bool ends_in_glass = !file_.surfaces[file_.surfaces.size() - 2].glass.empty() && end.glass.empty();
        if (begins_in_glass && ends_in_glass) {
            ZemaxSurface object;
            object.has_thickness = object.at_infinity = true;
            file_.surfaces.insert(file_.surfaces.begin(), object);
            file_.has_faces_alone = true;
        }
        if (!file_.has_faces_alone) return check_image();
        ZemaxSurface image;
        image.row.number = end.row.number + 1;
        image.has_thickness = true;
        file_.surfaces.push_back(image);
        p_.has_film_distance = false;
        p_.remarks.push_back(
            "lists faces alone: the object is taken to be distant, and the film to lie where its image is sharpest");
    }

    /// Checks that the last surface is the image. If it has a glass or a thickness, the file is truncated.
    void check_image() const {
        const ZemaxSurface& image = file_.surfaces.back();
        if (!image.has_thickness || image.row.thickness != 0 || !image.glass.empty())
            throw LensFileError("the file ends with a surface that is no image: it " +
                                    std::string(!image.glass.empty()  ? "has a glass"
                                                : image.has_thickness ? "has a thickness"
                                                                      : "has no thickness (DISZ)"),
                                p_.file, image.row.line, image.row.number);
    }

    void convert(ZemaxSurface& s, std::size_t i) {
        const bool is_object = i == 0, is_image = i + 1 == file_.surfaces.size();
        const auto fail = [&](const std::string& message, int line = 0) {
            throw LensFileError(message, p_.file, line > 0 ? line : s.row.line, s.row.number);
        };
        const auto add_foreign = [&](const std::string& what) {
            p_.foreign.push_back({what, s.row.line, s.row.number});
        };
        if (!s.has_thickness) fail("the surface has no thickness (DISZ)");
        if (s.at_infinity && !is_object) fail("the thickness is infinite; only the object may be as far away");
        if (is_image) {
            p_.image_curvature = s.row.curvature;
            if (s.row.curvature != 0 && (s.row.conic != 0 || s.type != "STANDARD"))
                add_foreign("an image surface that is no sphere");
            if (s.row.is_stop) fail("the image is the aperture stop");
            if (s.type == "COORDBRK") fail("the image is a coordinate break");
            p_.image_semi_diameter = s.diameter;
            return;
        }
        if (is_object) return;
        if (s.row.clear_semi_diameter == 0) s.row.clear_semi_diameter = s.diameter;
        const std::string foreign = set_zemax_shape(s, file_.unit);
        if (!foreign.empty()) add_foreign(foreign);
        set_zemax_aperture(s);
        convert_glass(s, fail, add_foreign);
        glass_behind_.push_back(&s);
        p_.surfaces.push_back(s.row);
    }

    template <class Fail, class Foreign>
    void convert_glass(ZemaxSurface& s, const Fail& fail, const Foreign& add_foreign) {
        if (s.glass_kind == 2 && !s.glass.empty() && pick_up_glass(s, fail)) return;
        // A medium of index -1 is a mirror by Snell's law.
        s.row.is_mirror = upper_case(s.glass) == "MIRROR" || (s.glass_kind == 1 && s.n_d == -1);
        if (s.row.is_mirror) return;
        if (s.glass.empty()) {
            // A coordinate break is not a surface: the medium continues behind it.
            if (s.type == "COORDBRK") s.row.material = medium_;
            medium_ = s.row.material;
            return;
        }
        try {
            if (s.glass_kind == 1) {
                s.row.material = glass_of_pair(s.n_d, s.v_d);
                if (s.partial != 0)
                    p_.remarks.push_back("the partial dispersion of the model glass of surface " +
                                         std::to_string(s.row.number) + " is left out");
            } else {
                if (s.glass_kind == 4) add_foreign("a glass with an offset");
                s.row.material = named_glass(s);
            }
        } catch (const InputError& error) {
            throw LensReadError(error, p_.file, s.glass_line, s.row.number);
        }
        medium_ = s.row.material;
    }

    /// Resolves a pickup of the glass from a surface in front. Returns false if the glass is determined by its name.
    template <class Fail>
    bool pick_up_glass(ZemaxSurface& s, const Fail& fail) {
        const int from = s.pickup;
        const bool is_named = s.glass != "___BLANK";
        const bool is_in_front = from > 0 && from <= static_cast<int>(glass_behind_.size());
        const ZemaxSurface* source = is_in_front ? glass_behind_[static_cast<std::size_t>(from) - 1] : nullptr;
        if (!source || source->glass.empty()) {
            if (is_named) return false;
            fail("picks up the glass of surface " + std::to_string(from) +
                     (source ? ", which has none" : "; a surface of the lens in front of this one is wanted"),
                 s.glass_line);
        }
        s.row.is_mirror = source->row.is_mirror;
        s.row.material = source->row.material;
        if (!s.row.is_mirror) medium_ = s.row.material;
        return true;
    }

    Glass named_glass(const ZemaxSurface& s) {
        try {
            return glasses_.find(s.glass, file_.catalogues, s.hint);
        } catch (const UnknownGlass& error) {
            if (!glasses_are_stated_ || !states_a_glass(s) || !error.candidate.empty()) throw;
            Glass stated = glass_of_pair(s.n_d, s.v_d);
            if (told_.insert(s.glass).second)
                p_.remarks.push_back("the glass " + in_quotes(s.glass) +
                                     " is in no catalogue that the file lists: " + s.hint + " are taken from its line");
            return stated;
        }
    }

    /// Tells whether n_d and V_d in the lines of catalogue glasses can be trusted: they may be left over from an
    /// earlier glass. Compares those of known glasses in the file.
    bool find_out_whether_glasses_are_stated() const {
        for (const ZemaxSurface& s : file_.surfaces) {
            if (s.glass.empty() || s.glass_kind != 0 || upper_case(s.glass) == "MIRROR") continue;
            const std::optional<Glass> known = glasses_.in_catalogue(s.glass, file_.catalogues);
            if (!known) continue;
            const AbbePair pair = abbe_pair(*known);
            // Melts and catalogue editions differ by less.
            if (std::fabs(pair.n_d - s.n_d) > 2e-3 || std::fabs(pair.v_d - s.v_d) > 1) return false;
        }
        return true;
    }

    void set_object() {
        const ZemaxSurface& object = file_.surfaces.front();
        p_.object_distance = object.at_infinity || object.row.thickness >= kLongest ? kInfinity : object.row.thickness;
        if (object.row.curvature != 0 && !object.at_infinity)
            p_.foreign.push_back({"a curved object", object.row.line, 0});
        if (!object.glass.empty() && object.at_infinity)
            add_window(object);
        else if (!object.glass.empty())
            p_.foreign.push_back({"an object inside a glass", object.glass_line, 0});
        if (object.row.is_stop) throw LensFileError("the object is the aperture stop", p_.file, object.row.line, 0);
        if (!file_.coatings.empty()) p_.remarks.push_back("coatings are left out: " + short_list(file_.coatings));
    }

    /// Adds a plane surface from air to the object's medium that touches the first face, like the pane of an aquarium:
    /// a plane has no power, so that focal length and f-number are those in the medium.
    void add_window(const ZemaxSurface& object) {
        ZemaxSurface medium = object;
        const auto fail = [&](const std::string& message, int line = 0) {
            throw LensFileError(message, p_.file, line, 0);
        };
        convert_glass(medium, fail, [](const std::string&) {});
        PrescriptionSurface window;
        window.line = object.glass_line;
        window.material = medium.row.material;
        const PrescriptionSurface& first = p_.surfaces.front();
        const double c = first.curvature, r = first.clear_semi_diameter;
        if (c < 0)
            window.thickness = -c * r * r / (1 + std::sqrt(std::max(0.0, 1 - (1 + first.conic) * c * c * r * r)));
        p_.surfaces.insert(p_.surfaces.begin(), window);
        p_.remarks.push_back("its object lies in a medium, " + window.material.label +
                             ": a plane window in front of the lens stands between it and the air of scenes");
    }

    void set_fields() {
        const std::size_t given = std::max(file_.x.size(), file_.y.size());
        const std::size_t count = file_.field_count > 0 ? std::min(file_.field_count, given) : given;
        const auto at = [](const std::vector<double>& list, std::size_t i) { return i < list.size() ? list[i] : 0.0; };
        p_.field_kind = file_.field_type == 0   ? FieldKind::angle_deg
                        : file_.field_type == 1 ? FieldKind::object_height
                                                : FieldKind::image_height;
        if (file_.field_type > 3) p_.remarks.push_back("its fields are of a kind that is not known");
        const double scale = file_.field_type == 0 ? 1 : file_.unit;
        for (std::size_t i = 0; i < count && file_.field_type <= 3; ++i) {
            // The edge of the pupil moves to decentre + (1 - compression).
            const double shift = at(file_.decentre_y, i), narrow = at(file_.compress_y, i);
            p_.fields.push_back({scale * at(file_.x, i), scale * at(file_.y, i), 0, 0,
                                 std::clamp(narrow - shift, 0.0, 0.999), std::clamp(narrow + shift, 0.0, 0.999)});
        }
    }

    void set_wavelength() {
        if (file_.wavelengths.empty()) {
            p_.remarks.push_back("it states no wavelength: that of the d line is taken");
            return;
        }
        const auto found = file_.wavelengths.find(file_.primary);
        if (found == file_.wavelengths.end())
            throw LensFileError("the primary wavelength (PWAV) is number " + std::to_string(file_.primary) +
                                    ", which the file does not have",
                                p_.file);
        p_.wavelength_nm = 1000 * found->second;
        for (const auto& [number, um] : file_.wavelengths) p_.wavelengths_nm.push_back(1000 * um);
        // A file has 24 rows; unused ones repeat the same value after the used ones.
        std::vector<double>& all = p_.wavelengths_nm;
        const double unused = all.back();
        if (all.size() < 2 || all[all.size() - 2] != unused) return;
        while (all.size() > 1 && all.back() == unused) all.pop_back();
        if (std::ranges::find(all, p_.wavelength_nm) == all.end()) all.push_back(p_.wavelength_nm);
    }

    void set_zoom() {
        if (file_.zoom.empty() && file_.zoom_apertures.empty()) return;
        const auto count = static_cast<std::size_t>(file_.positions);
        const auto filled = [&](std::vector<double> values, double otherwise) {
            values.resize(count, std::nan(""));
            for (double& value : values)
                if (std::isnan(value)) value = otherwise;
            return values;
        };
        for (std::size_t i = 0; i < count; ++i) p_.zoom_names.push_back(std::to_string(i + 1));
        p_.zoom_current = std::min(file_.current, file_.positions) - 1;
        for (const auto& [surface, values] : file_.zoom) {
            if (surface == file_.surfaces.back().row.number) {
                p_.remarks.push_back("the thickness behind the image, which configurations change, is left out");
                continue;
            }
            const int row = row_of_number(surface);
            std::vector<double> list = values;
            for (double& value : list) value = file_.unit * value >= kLongest ? kInfinity : file_.unit * value;
            const double otherwise =
                row < 0 ? p_.object_distance : p_.surfaces[static_cast<std::size_t>(row)].thickness;
            p_.zoom_thicknesses[row] = filled(list, otherwise);
            for (const double value : p_.zoom_thicknesses[row])
                if (row >= 0 && !std::isfinite(value))
                    throw LensFileError(
                        "a configuration makes the thickness of surface " + std::to_string(surface) + " infinite",
                        p_.file);
        }
        set_zoom_sizes(filled);
        if (!file_.zoom_apertures.empty()) {
            const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
            for (double& value : file_.zoom_apertures) value *= is_length ? file_.unit : 1;
            p_.zoom_apertures = filled(file_.zoom_apertures, p_.aperture);
        }
    }

    /// Returns the index of a surface's row; -1: the object.
    int row_of_number(int surface) const {
        if (surface == 0 && !file_.has_faces_alone) return -1;
        const auto found =
            std::ranges::find_if(p_.surfaces, [&](const PrescriptionSurface& s) { return s.number == surface; });
        if (found == p_.surfaces.end())
            throw LensFileError(
                "a configuration changes surface " + std::to_string(surface) + ", which the lens does not have",
                p_.file);
        return static_cast<int>(found - p_.surfaces.begin());
    }

    /// Sets the sizes of the stop in the zoom positions, if the file defines the aperture by its semi-diameter. Other
    /// surfaces have one clear semi-diameter for all configurations, which is the largest.
    template <class Filled>
    void set_zoom_sizes(const Filled& filled) {
        for (const auto& [surface, values] : file_.zoom_sizes) {
            if (surface == 0 || surface == file_.surfaces.back().row.number) continue;
            PrescriptionSurface& row = p_.surfaces[static_cast<std::size_t>(row_of_number(surface))];
            std::vector<double> sizes = filled(values, row.clear_semi_diameter / file_.unit);
            for (double& size : sizes) size *= file_.unit;
            if (row.is_stop && p_.aperture_kind == ApertureKind::stop_size) {
                p_.zoom_apertures = sizes;
            } else {
                row.clear_semi_diameter = *std::ranges::max_element(sizes);
                p_.remarks.push_back("the largest of the semi-diameters that configurations give surface " +
                                     std::to_string(surface) + " is taken for all of them");
            }
        }
    }

    ZemaxFile file_;
    Prescription p_;
    LensGlasses& glasses_;
    Glass medium_ = Glass::air();  ///< medium behind the last surface converted
    std::vector<const ZemaxSurface*> glass_behind_;  ///< the surfaces converted so far
    bool glasses_are_stated_ = true;
    std::set<std::string> told_;
};

}  // namespace

Prescription read_zemax(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Converter(zemax_file_of(text, file, glasses.options()), glasses).prescription();
}

}  // namespace realcam::io
