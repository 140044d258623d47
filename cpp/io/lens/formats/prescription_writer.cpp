#include "prescription_writer.hpp"

#include <cmath>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"

namespace realcam::io {
namespace {

/// Adds the powers of r of Forbes terms on a conic: u^4 times a polynomial in t = 2 u^2 - 1, with u = r / radius.
void add_forbes(const ForbesTerms& forbes, std::map<int, double>& terms) {
    const std::vector<double> in_t = forbes.in_powers();
    std::vector<double> in_square(in_t.size(), 0.0);
    for (std::size_t k = in_t.size(); k-- > 0;) {
        for (std::size_t i = in_square.size(); i-- > 0;)
            in_square[i] = (i > 0 ? 2 * in_square[i - 1] : 0) - in_square[i];
        in_square[0] += in_t[k];
    }
    for (std::size_t k = 0; k < in_square.size(); ++k) {
        const int power = 4 + 2 * static_cast<int>(k);
        if (in_square[k] != 0) terms[power] += in_square[k] / std::pow(forbes.radius, power);
    }
}

}  // namespace

PrescriptionWriter::PrescriptionWriter(const LensSystem& lens, const std::string& format) : lens_(lens) {
    std::vector<std::string>& list = result_.warnings;
    const std::string cannot_express = ", which a " + format + " file cannot express";
    std::string coated;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (!(lens.surfaces[i].coating == Coating())) coated += (coated.empty() ? "" : ", ") + std::to_string(i + 1);
    if (!coated.empty()) list.push_back("the coatings of surfaces " + coated + cannot_express);
    if (lens.iris.blades != 0)
        list.push_back("the " + std::to_string(lens.iris.blades) + " blades of the diaphragm" + cannot_express);
    if (lens.focusing.moves_group() || lens.focusing.nearest_mm > 0)
        list.push_back("the focusing of the lens" + cannot_express);
    if (lens.stop_semi_diameter < lens.stop().clear_semi_diameter)
        list.push_back("the full opening of the diaphragm: its current opening is written");
    if (!lens.source.empty()) list.push_back("the source of the lens" + cannot_express);
    if (std::fabs(lens.film_width * 2 - lens.film_height * 3) > 1e-9 * lens.film_width)
        list.push_back("the film's aspect ratio: only the height of its corner is written");
    if (lens.allow_overlap) list.push_back("the permission that faces may overlap" + cannot_express);
}

std::string PrescriptionWriter::title() const {
    return printable(lens_.title.empty() ? lens_.name : lens_.title);
}

double PrescriptionWriter::film_corner() const {
    return 0.5 * hypotenuse(lens_.film_width, lens_.film_height);
}

double PrescriptionWriter::thickness(std::size_t surface) const {
    return surface + 1 == lens_.surfaces.size() ? lens_.film_distance : lens_.surfaces[surface].thickness;
}

double PrescriptionWriter::entrance_pupil_diameter(const std::string& suffix) const {
    const double diameter = first_order(centred(lens_), lens_.wavelength_nm).entrance_pupil_diameter;
    if (!std::isfinite(diameter))
        throw InputError("lens \"" + lens_.name + "\" has its entrance pupil at infinity, so that a " + suffix +
                         " file cannot express its aperture");
    return diameter;
}

const Glass& PrescriptionWriter::medium_behind(std::size_t surface) const {
    for (std::size_t k = surface + 1; k-- > 0;)
        if (lens_.surfaces[k].type == SurfaceType::refracting) return lens_.surfaces[k].material;
    static const Glass air = Glass::air();
    return air;
}

std::vector<PrescriptionWriter::ZoomedQuantity> PrescriptionWriter::zoomed_quantities() const {
    const ZoomRange& zoom = lens_.zoom;
    std::vector<ZoomedQuantity> rows;
    for (const int i : zoom.surfaces) rows.push_back({i + 1, {}});
    for (const int i :
         {static_cast<int>(lens_.surfaces.size()), ZoomedQuantity::kObject, ZoomedQuantity::kEntrancePupil})
        rows.push_back({i, {}});
    for (int k = 0; k < static_cast<int>(zoom.positions.size()); ++k) {
        const LensSystem lens = k == zoom.current ? lens_ : at_zoom_position(lens_, k);
        std::size_t row = 0;
        for (const int i : zoom.surfaces)
            rows[row++].values.push_back(lens.surfaces[static_cast<std::size_t>(i)].thickness);
        rows[row++].values.push_back(lens.film_distance);
        rows[row++].values.push_back(lens.focus_distance - lens.film_position());
        rows[row++].values.push_back(first_order(lens, lens.wavelength_nm).entrance_pupil_diameter);
    }
    return rows;
}

std::map<int, double> radial_terms_of(const Surface& surface) {
    std::map<int, double> terms;
    for (std::size_t k = 0; k < surface.aspheric.size(); ++k)
        if (surface.aspheric[k] != 0) terms[2 * static_cast<int>(k) + 4] += surface.aspheric[k];
    const SurfaceForm& form = surface.form;
    for (std::size_t k = 0; k < form.radial.size(); ++k)
        if (form.radial[k] != 0) terms[static_cast<int>(k) + 1] += form.radial[k];
    if (form.forbes && form.forbes->kind == ForbesKind::con) add_forbes(*form.forbes, terms);
    return terms;
}

std::string beyond_polynomials(const SurfaceForm& form) {
    std::string found;
    for_each_present_terms(form, [&](const auto& terms) {
        if (found.empty()) found = terms.beyond_polynomials();
    });
    return found;
}

std::vector<double> radial_list(const std::map<int, double>& terms, int step) {
    std::vector<double> list;
    for (const auto& [power, value] : terms) {
        if (power % step != 0) continue;
        list.resize(static_cast<std::size_t>(power / step), 0.0);
        list.back() = value;
    }
    return list;
}

std::map<XyPower, double> xy_terms_of(const Surface& surface) {
    std::map<XyPower, double> terms;
    const auto add = [&](int x, int y, double value) {
        if (value != 0) terms[{x + y, y}] += value;
    };
    const SurfaceForm& form = surface.form;
    for (const XyTerm& term : form.xy) add(term.x, term.y, term.coefficient);
    if (form.zernike)
        for (const XyTerm& term : form.zernike->as_xy())
            add(term.x, term.y, term.coefficient / std::pow(form.zernike->radius, term.x + term.y));
    for (const auto& [power, value] : radial_terms_of(surface)) {
        if (power % 2 != 0) continue;
        double binomial = 1;
        for (int k = 0; k <= power / 2; ++k) {
            add(power - 2 * k, 2 * k, binomial * value);
            binomial *= static_cast<double>(power / 2 - k) / (k + 1);
        }
    }
    return terms;
}

bool has_odd_terms(const Surface& surface) {
    for (const auto& [power, value] : radial_terms_of(surface))
        if (power % 2 != 0) return true;
    return false;
}

std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm) {
    std::set<double> lines{365.0146,  404.6561,  435.8343, kLineF_nm, 546.0740,
                           kLineD_nm, kLineC_nm, 706.5188, 852.11,    wavelength_nm};
    std::vector<Glass::TablePoint> points;
    for (const double nm : lines) points.push_back({nm, glass.index(nm)});
    return points;
}

}  // namespace realcam::io
