#include "lens_placements.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"

namespace realcam::io {

namespace {

/// Returns the placement of a frame, without the rounding errors of breaks that undo each other.
SurfacePlacement placement_of(const Affine<double>& frame) {
    SurfacePlacement placement = SurfacePlacement::of(frame);
    constexpr double kRounding = 1e-12;
    for (Vec3d* of : {&placement.decentre, &placement.tilt_deg})
        for (double* value : {&of->x, &of->y, &of->z})
            if (std::fabs(*value) < kRounding) *value = 0;
    return placement;
}

/// Adds a plane that blocks nothing at the end of the lens.
void put_before_film(LensSystem& lens, const SurfacePlacement& placement, double thickness) {
    Surface carrier;
    carrier.type = SurfaceType::aperture;
    double reach = hypotenuse(lens.film_width, lens.film_height);
    for (const Surface& surface : lens.surfaces) reach = std::max(reach, surface.clear_semi_diameter);
    carrier.clear_semi_diameter = 100 * (reach + std::fabs(lens.film_distance));
    carrier.placement = placement;
    lens.surfaces.back().thickness = thickness;
    lens.surfaces.push_back(carrier);
}

bool is_alone(const std::vector<KeptRow>& kept, std::size_t index) {
    return (index == 0 || kept[index - 1].row != kept[index].row) &&
           (index + 1 == kept.size() || kept[index + 1].row != kept[index].row);
}

}  // namespace

bool is_moved(const PrescriptionSurface& row) {
    return !(row.before == Affine<double>{}) || !(row.behind == Affine<double>{});
}

void set_placements(const Prescription& p, const std::vector<KeptRow>& kept, LensSystem& lens) {
    Affine<double> from_last;      // from the axis of the last kept surface to here
    double thickness = 0;    // along that path, as if it were straight
    bool is_straight = true;  // true while there are only thicknesses
    std::size_t next = 0;
    for (std::size_t row = 0; row < p.surfaces.size(); ++row) {
        const PrescriptionSurface& here = p.surfaces[row];
        const bool returns = here.behind == inverse_motion(here.before) && !(here.before == Affine<double>{});
        const bool moves_alone =
            returns && is_straight && next < kept.size() && kept[next].row == row && is_alone(kept, next);
        from_last = from_last * here.before;
        is_straight &= here.before == Affine<double>{};
        for (; next < kept.size() && kept[next].row == row; ++next) {
            if (!is_straight) lens.surfaces[next].placement = placement_of(along_axis(-thickness) * from_last);
            from_last = {};
            thickness = 0;
            is_straight = true;
        }
        if (moves_alone) {
            lens.surfaces[next - 1].placement.returns = true;
        } else {
            from_last = from_last * here.behind;
            is_straight &= here.behind == Affine<double>{};
        }
        from_last = from_last * along_axis(here.thickness);
        thickness += here.thickness;
    }
    from_last = from_last * p.image_placement.frame();
    constexpr double kSteepest = 0.5;  // cosine of 60 degrees
    if (from_last.z.z > kSteepest)
        lens.film_placement = placement_of(along_axis(-thickness) * from_last);
    else
        put_before_film(lens, placement_of(from_last * along_axis(-thickness)), 0);
}

void set_film(const Prescription& p, LensSystem& lens) {
    // The sag of the film is measured along the light, which after a mirror travels against the axis.
    const double direction = lens.film_distance < 0 ? -1 : 1;
    if (p.image_curvature != 0) lens.film_radius_of_curvature = direction / p.image_curvature;
}

}  // namespace realcam::io
