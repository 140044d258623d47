#pragma once
#include <cstddef>

#include "../math/key_interval.hpp"
#include "../optics/pupil/film_surface.hpp"
#include "../optics/pupil/pupil_grid_view.hpp"
#include "../optics/trace/lens_polynomial_view.hpp"
#include "../optics/trace/lens_view.hpp"
#include "circle_of_confusion.hpp"
#include "effect_views.hpp"
#include "lens_map_view.hpp"
#include "pixel_pupil.hpp"
#include "traced_lights_view.hpp"

namespace REALCAM_NAMESPACE {

/// How the film is lit, from the crudest to the real. All have the same film, focus and exposure on the axis.
enum class CameraModel : int {
    pinhole,     ///< the entrance pupil's middle: everything sharp
    thin_lens,   ///< an ideal lens in the entrance pupil: defocus only, light falls off with cos^4
    mapped_lens,  ///< the same with the real lens's distortion and vignetting laid on
    thick_lens,  ///< the paraxial matrix of the real lens, with its two pupils and its real film distance
    polynomial_lens,   ///< polynomials fitted to the rays of the real lens
    full_lens,         ///< every surface of the prescription
    full_lens_double,  ///< the same in double precision: for comparison, on a CPU
};

/// Whether rays are sent where the real lens lets light pass.
REALCAM_INLINE bool has_real_pupil(CameraModel model) {
    return model == CameraModel::polynomial_lens || model == CameraModel::full_lens ||
           model == CameraModel::full_lens_double;
}

/// An ideal lens in its entrance pupil. mm.
struct ThinLens {
    float image_distance;           ///< film to pupil that gives the real lens's magnification
    float inverse_object_distance;  ///< pupil to the plane in focus; 0 at infinity
    float pupil_radius;
};

/// The paraxial lens as a matrix from the last vertex back to the front one: h = D h' - B u', u = -C h' + A u'.
struct ThickLens {
    float A, B, C, D;
    float exit_pupil_distance;  ///< film to exit pupil, positive towards the scene, mm
    float exit_pupil_radius;
};

/// Where the camera is in the placed scene.
struct CameraPlacement {
    Vec3f position;             ///< of the film's middle, metres
    Vec3f right, up, backward;  ///< unit: x, y, z of the lens frame
};

/// Its own placement is that at the begin of the exposure.
struct CameraView : CameraPlacement, EffectViews {
    CameraModel model;
    int width, height;                    ///< pixels
    float film_half_width, film_half_height;  ///< mm
    Vec2f film_middle;                        ///< from the axis, mm
    float film_distance;                  ///< last vertex to film, mm
    float film_curvature;  ///< see FilmSurface; 0 where the lens and its film are of revolution
    float axis_irradiance;  ///< of the real lens on the axis for unit radiance; the ideal models take it over
    float front_vertex_m;   ///< film to front vertex, metres
    float pupil_m;          ///< film to entrance pupil, metres
    ThinLens thin;
    ThickLens thick;
    LensMapView map;  ///< of a mapped lens; else without nodes
    CircleOfConfusion circle;
    PupilView pupil;  ///< of a centred lens of revolution
    PupilGridView pupil_grid;  ///< of any other; else without nodes
    TracedLightsView traced_lights;
    PixelPupils pixel_pupils;
    LensView<float> lens;
    const LensView<double>* lens_in_double;  ///< of the model full_lens_double; else null
    LensPolynomialView polynomial;           ///< of the model polynomial_lens; else without coefficients
    // For an exposure during which something moves; else 0. Times are shares of the exposure:
    float row_time;      ///< by which each row of pixels begins later than the one above
    float exposed_time;  ///< for which each is exposed
    const CameraPlacement* keys;  ///< of a camera that moves, at even times; positions relative to its own
    int key_count;
};

/// Whether only the code for lenses of any kind serves it.
REALCAM_INLINE bool has_any_lens(const CameraView& camera) {
    return camera.pupil_grid.nodes || camera.lens.kind == LensKind::any;
}

/// The camera at a time of the exposure. Between two keys its axes are interpolated, and made unit and right-angled
/// again.
REALCAM_INLINE CameraPlacement camera_at(const CameraView& camera, float time) {
    if (camera.key_count == 0) return camera;
    const KeyInterval at = key_interval(time, camera.key_count);
    const CameraPlacement &a = camera.keys[at.first], &b = camera.keys[at.first + 1];
    const Vec3f backward = normalized(mix(a.backward, b.backward, at.share)), right = mix(a.right, b.right, at.share);
    const Vec3f across = normalized(right - dot(right, backward) * backward);
    return {camera.position + mix(a.position, b.position, at.share), across, cross(backward, across), backward};
}

/// Depth of a point: its distance from the film along the camera's axis, metres.
REALCAM_INLINE float depth_from(const CameraPlacement& camera, Vec3f point) {
    return dot(camera.position - point, camera.backward);
}

/// Where the lens's front vertex is in the placed scene, metres.
REALCAM_INLINE Vec3f front_vertex(const CameraPlacement& camera, float front_vertex_m) {
    return camera.position - front_vertex_m * camera.backward;
}

/// A camera's view with every array replaced by a copy elsewhere: `copy(pointer, count)` returns where to.
template <class Copy>
CameraView with_copied_arrays(CameraView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.lens.surfaces, view.lens.count);
    view.lens.free.move_arrays(view.lens.count, move);
    move(view.keys, view.key_count);
    move(view.map.nodes, view.map.count);
    move(view.polynomial.coefficients, 2 * LensPolynomialView::kVectors * view.polynomial.terms);
    view.move_arrays(view.lens.count, move);
    view.traced_lights.move_arrays(move);
    move(view.pupil.nodes, view.pupil.rows + 1);
    move(view.pupil.outline, view.pupil.rows * view.pupil.sectors);
    const PupilGridView& grid = view.pupil_grid;
    move(view.pupil_grid.nodes, (grid.columns / kCellsPerPupilNode + 1) * (grid.rows / kCellsPerPupilNode + 1));
    move(view.pupil_grid.cells, grid.columns * grid.rows);
    move(view.pupil_grid.sectors, grid.columns * grid.rows * 2 * kPupilGridSectors);
    return view;
}

}  // namespace REALCAM_NAMESPACE
