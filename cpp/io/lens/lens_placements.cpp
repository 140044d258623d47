#include "lens_placements.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"

namespace realcam::io {

namespace {

/// Returns the placement of a frame. Rounding errors that remain where coordinate breaks cancel are set to 0.
SurfacePlacement placement_of(const Affine<double>& frame) {
    SurfacePlacement placement = SurfacePlacement::from_frame(frame);
    constexpr double kRounding = 1e-12;
    for (Vec3d* vector : {&placement.decentre, &placement.tilt_deg})
        for (double* value : {&vector->x, &vector->y, &vector->z})
            if (std::fabs(*value) < kRounding) *value = 0;
    return placement;
}

/// Adds an auxiliary plane that blocks no light after the last surface. `thickness`: from the last surface to it, mm.
void add_plane_before_film(LensSystem& lens, const SurfacePlacement& placement, double thickness) {
    Surface plane;
    plane.type = SurfaceType::aperture;
    double reach = hypotenuse(lens.film_width, lens.film_height);
    for (const Surface& surface : lens.surfaces) reach = std::max(reach, surface.clear_semi_diameter);
    constexpr double kUnlimited = 100;  // times the size of the lens
    plane.clear_semi_diameter = kUnlimited * (reach + std::fabs(lens.film_distance));
    plane.placement = placement;
    lens.surfaces.back().thickness = thickness;
    lens.surfaces.push_back(plane);
}

/// True if no other surface was made from the same row as surface `index`.
bool has_own_row(const std::vector<SurfaceRow>& surface_rows, std::size_t index) {
    return (index == 0 || surface_rows[index - 1].row != surface_rows[index].row) &&
           (index + 1 == surface_rows.size() || surface_rows[index + 1].row != surface_rows[index].row);
}

}  // namespace

bool is_displaced(const PrescriptionSurface& row) {
    return !(row.before == Affine<double>{}) || !(row.behind == Affine<double>{});
}

void set_placements(const Prescription& p, const std::vector<SurfaceRow>& surface_rows, LensSystem& lens) {
    Affine<double> from_last;      // from the frame of the current row to the axis behind the last surface
    double thickness = 0;         // sum of the thicknesses since then
    bool is_straight = true;      // true if no tilt or decentre has followed since then
    std::size_t next = 0;         // index of the next surface
    for (std::size_t row = 0; row < p.surfaces.size(); ++row) {
        const PrescriptionSurface& current = p.surfaces[row];
        const bool returns = current.behind == inverse_motion(current.before) && !(current.before == Affine<double>{});
        const bool moves_alone = returns && is_straight && next < surface_rows.size() &&
                                 surface_rows[next].row == row && has_own_row(surface_rows, next);
        from_last = from_last * current.before;
        is_straight &= current.before == Affine<double>{};
        for (; next < surface_rows.size() && surface_rows[next].row == row; ++next) {
            if (!is_straight) lens.surfaces[next].placement = placement_of(along_axis(-thickness) * from_last);
            from_last = {};
            thickness = 0;
            is_straight = true;
        }
        if (moves_alone) {
            lens.surfaces[next - 1].placement.returns = true;
        } else {
            from_last = from_last * current.behind;
            is_straight &= current.behind == Affine<double>{};
        }
        from_last = from_last * along_axis(current.thickness);
        thickness += current.thickness;
    }
    from_last = from_last * p.image_placement.frame();
    constexpr double kMinCosine = 0.5;  // cosine of 60 degrees
    if (from_last.z.z > kMinCosine)
        lens.film_placement = placement_of(along_axis(-thickness) * from_last);
    else
        add_plane_before_film(lens, placement_of(from_last * along_axis(-thickness)), 0);
}

void set_film(const Prescription& p, LensSystem& lens) {
    // The sag of the film is measured along the light, which after a mirror travels against the axis.
    const double direction = lens.film_distance < 0 ? -1 : 1;
    if (p.image_curvature != 0) lens.film_radius_of_curvature = direction / p.image_curvature;
}

}  // namespace realcam::io
