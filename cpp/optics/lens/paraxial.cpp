#include "paraxial.hpp"

#include <limits>

#include "../prescription/lens_system.hpp"
#include "lens_changes.hpp"
#include "parabasal.hpp"

namespace realcam {

double sum_or_zero(double a, double b) {
    constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
    const double sum = a + b;
    return std::fabs(sum) <= kRounding * std::fabs(a) ? 0.0 : sum;
}

ParaxialRay trace_paraxial(const LensSystem& lens, double wavelength_nm, ParaxialRay ray, int first, int last) {
    if (!has_axis(lens)) lens.require_rotational("first-order data");
    const std::vector<double> index = lens.indices(wavelength_nm);
    double sign = 1;
    for (int i = 0; i < last; ++i) {
        const Surface& s = lens.surfaces[static_cast<std::size_t>(i)];
        const double before = sign * index[static_cast<std::size_t>(i)];
        if (s.type == SurfaceType::mirror) sign = -sign;
        if (i < first) continue;
        const double after = sign * index[static_cast<std::size_t>(i) + 1];
        ray = refract_paraxial(ray, s.vertex_curvature(), before, after);
        if (i + 1 < last) ray.height = sum_or_zero(ray.height, s.thickness * ray.slope);
    }
    return ray;
}

FirstOrder first_order(const LensSystem& lens, double wavelength_nm) {
    if (!lens.is_rotational()) {
        const LensSystem unmoved = without_move(lens);
        return unmoved.is_rotational() ? first_order(unmoved, wavelength_nm) : parabasal_data(lens, wavelength_nm).mean;
    }
    const int count = static_cast<int>(lens.surfaces.size()), stop = lens.stop_index();
    const ParaxialRay marginal = trace_paraxial(lens, wavelength_nm, {1, 0}, 0, count);
    const ParaxialRay inclined = trace_paraxial(lens, wavelength_nm, {0, 1}, 0, count);
    FirstOrder data{};
    const bool is_afocal = marginal.slope == 0;
    data.image_index = lens.indices(wavelength_nm).back();
    data.effective_focal_length = is_afocal ? kInfinity : -1 / (data.image_index * marginal.slope);
    data.back_focal_distance = is_afocal ? kInfinity : -marginal.height / marginal.slope;
    // A ray through the front focal point, in front of the vertex by -ffd, leaves parallel to the axis.
    data.front_focal_distance = is_afocal ? -kInfinity : inclined.slope / marginal.slope;

    // Height and slope at the stop are linear in those at the front vertex; the ray through the stop's centre crosses
    // the axis at the centre of the entrance pupil.
    const ParaxialRay height_at_stop = trace_paraxial(lens, wavelength_nm, {1, 0}, 0, stop + 1);
    const ParaxialRay slope_at_stop = trace_paraxial(lens, wavelength_nm, {0, 1}, 0, stop + 1);
    const double radius = lens.open_stop_radius();
    data.entrance_pupil_position = slope_at_stop.height / height_at_stop.height;
    data.entrance_pupil_diameter = radius > 0 ? 2 * radius / std::fabs(height_at_stop.height) : 0.0;
    data.f_number = is_afocal ? kInfinity : std::fabs(data.effective_focal_length) / data.entrance_pupil_diameter;

    const ParaxialRay chief = trace_paraxial(lens, wavelength_nm, {0, 1}, stop, count);
    const ParaxialRay edge = trace_paraxial(lens, wavelength_nm, {radius, 0}, stop, count);
    const double from_last = -chief.height / chief.slope;  // infinite for a lens that is telecentric on the film side
    data.exit_pupil_position = lens.last_vertex() + from_last;
    data.exit_pupil_diameter = radius > 0 ? 2 * std::fabs(edge.height + edge.slope * from_last) : 0.0;
    data.film_distance = lens.film_distance;
    return data;
}

FirstOrder nominal_first_order(const LensSystem& lens) {
    try {
        return first_order(lens, lens.wavelength_nm);
    } catch (const InputError&) {
        return first_order(centred(lens), lens.wavelength_nm);
    }
}

double paraxial_image_distance(const LensSystem& lens, double wavelength_nm, double object_distance) {
    const ParaxialRay start = std::isinf(object_distance) ? ParaxialRay{1, 0} : ParaxialRay{object_distance, 1};
    const ParaxialRay end = trace_paraxial(lens, wavelength_nm, start, 0, static_cast<int>(lens.surfaces.size()));
    return -end.height / end.slope;
}

}  // namespace realcam
