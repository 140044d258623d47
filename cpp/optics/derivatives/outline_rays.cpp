#include "outline_rays.hpp"

#include "../trace/open_iris.hpp"

namespace realcam {

OutlineRays::OutlineRays(const LensSystem& lens, double wavelength_nm)
    : lens_(lens, LightDirection::to_scene, wavelength_nm, film_path_ends(lens, LightDirection::to_scene)),
      view_{.lens = lens_.view(),
            .film_distance = lens.film_distance,
            .squared_index = lens_.entry_index * lens_.entry_index,
            .stop_is_rim = false,
            .stop_index = lens.stop_index(),
            .apothem_rate = 0,
            .curvature_rate = 0} {
    for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
        if (!lens.surfaces[k].aperture_shape.is_plain())
            throw InputError("derivatives of pictures need circular apertures; surface " + std::to_string(k + 1) +
                             " of lens \"" + lens.name + "\" has one of another shape");
    view_.stop_is_rim = view_.lens.iris.blades == 0;
    if (view_.stop_is_rim) return;
    // An opening inside the rim scales with the radius, so that these differences are exact.
    const double rim = lens.stop().clear_semi_diameter, step = 1e-3 * lens.stop_semi_diameter;
    const auto at = [&](double change) { return open_iris(lens.iris, lens.stop_semi_diameter + change, rim); };
    view_.apothem_rate = (at(step).apothem - at(-step).apothem) / (2 * step);
    view_.curvature_rate = (at(step).curvature - at(-step).curvature) / (2 * step);
}

// target_clones compiles only inlined code for each instruction set, hence `flatten`.
__attribute__((flatten)) REALCAM_CLONES void OutlineRays::trace(const DirectionLine (&lines)[kLanes],
                                                                const double (&t)[kLanes],
                                                                const WavelengthsInDouble* wavelengths,
                                                                int (&passes)[kLanes]) const {
    TangentPath::Rays rays = start(lines, t);
    auto& without_tangents = static_cast<LensRays<double, kLanes>&>(rays);
    if (wavelengths)
        trace_lens(view_.lens, without_tangents, NoRecord{}, *wavelengths);
    else
        trace_lens(view_.lens, without_tangents);
    for (int i = 0; i < kLanes; ++i) passes[i] = rays.status[i] == 0;
}

__attribute__((flatten)) REALCAM_CLONES void OutlineRays::measure(const TangentLens& surfaces,
                                                                  const DirectionLine (&lines)[kLanes],
                                                                  const double (&t)[kLanes],
                                                                  const WavelengthsInDouble* wavelengths,
                                                                  double (&clearance)[kLanes]) const {
    if (wavelengths)
        measure_clearance<LensKind::any>(
            view_, surfaces,
            [&](int k) { return WavelengthsInDouble{wavelengths->surfaces + k, wavelengths->variable}; }, lines, t,
            clearance);
    else
        measure_clearance<LensKind::any>(view_, surfaces, [](int) { return OneWavelength{}; }, lines, t, clearance);
}

int OutlineRays::find(const TangentPath& path, const DirectionLine (&lines)[kLanes], double end,
                      const WavelengthsInDouble* wavelengths, OutlinePoint (&points)[kMostPoints][kLanes]) const {
    const auto trace_lines = [&](const DirectionLine(&on)[kLanes], const double (&t)[kLanes], int (&passes)[kLanes]) {
        trace(on, t, wavelengths, passes);
    };
    const auto measure_lines = [&](const DirectionLine(&on)[kLanes], const double (&t)[kLanes],
                                   double (&clearance)[kLanes]) {
        measure(path.view(), on, t, wavelengths, clearance);
    };
    std::vector<TangentPath::Crossing> crossings;
    const auto record = [&](TangentPath::Rays& rays, auto&& visit) {
        path.record(rays, crossings, wavelengths);
        for (std::size_t k = 0; k < crossings.size(); ++k)
            visit(static_cast<int>(k), crossings[k].origin, crossings[k].direction, crossings[k].origin_tangent);
    };
    return find_outline(view_, lines, end, trace_lines, measure_lines, record, points);
}

}  // namespace realcam
