#pragma once
#include <cstddef>

#include "../../math/key_interval.hpp"
#include "../../math/lanes.hpp"
#include "../../optics/pupil/film_surface.hpp"
#include "../../optics/pupil/pupil_view.hpp"
#include "../../optics/trace/lens_polynomial_view.hpp"
#include "../../optics/trace/lens_view.hpp"
#include "../effects/effect_views.hpp"
#include "../effects/traced_lights_view.hpp"
#include "../film/pixel_filter.hpp"
#include "bundle_motion_view.hpp"
#include "lens_map_view.hpp"
#include "pixel_pupil.hpp"

namespace REALCAM_NAMESPACE {

/// Circle of confusion (defocus disc) of a paraxial lens, from two rays whose heights are linear in the distance t in
/// front of the front vertex, mm. The marginal ray from the axial film point through the pupil's rim has the height rim
/// + t * rim_slope. The chief ray from a film height of 1 mm has the height middle + t * middle_slope, the inverse of
/// the magnification at t. So the diameter of the disc on the film is 2 |rim| / |middle|.
struct CircleOfConfusion {
    float rim, rim_slope;  ///< height at t = 0 and slope of the marginal ray; mm and mm per mm
    float middle, middle_slope;  ///< height at t = 0 and slope of the chief ray, per mm of film height
    float least_middle;  ///< least height of the chief ray: that at one pupil radius from the pupil
};

/// Diameter of the defocus disc on the film, mm, of an object point. `distance_mm`: its distance from the front vertex
/// along the axis towards the scene; may be infinite.
REALCAM_INLINE float circle_diameter(const CircleOfConfusion& circle, float distance_mm) {
    if (!(distance_mm < 1e30f)) return 2.0f * std::fabs(circle.rim_slope / circle.middle_slope);
    const float rim = circle.rim + distance_mm * circle.rim_slope;
    const float height = std::fabs(circle.middle + distance_mm * circle.middle_slope);
    return 2.0f * std::fabs(rim) / (height > circle.least_middle ? height : circle.least_middle);
}

/// Camera models in order of increasing accuracy. All have the same film, focus and exposure on the axis.
enum class CameraModel : int {
    pinhole,  ///< centre of the entrance pupil: everything is sharp
    thin_lens,  ///< ideal lens in the entrance pupil: defocus and cos^4 falloff only
    mapped_lens,  ///< thin_lens with the real lens's distortion and vignetting
    thick_lens,  ///< paraxial matrix of the real lens, with its two pupils and its real film distance
    polynomial_lens,  ///< polynomials fitted to the rays of the real lens
    full_lens,  ///< every surface of the prescription
    full_lens_double,  ///< full_lens in double precision, for comparison; CPU only
};

/// True if rays are sampled over the real lens's pupil.
REALCAM_INLINE bool has_real_pupil(CameraModel model) {
    return model == CameraModel::polynomial_lens || model == CameraModel::full_lens ||
           model == CameraModel::full_lens_double;
}

/// Ideal lens in the entrance pupil. Lengths in mm.
struct ThinLens {
    float image_distance;  ///< from film to pupil; gives the real lens's magnification
    float inverse_object_distance;  ///< from pupil to the plane in focus; 0 at infinity
    float pupil_radius;
};

/// Paraxial lens as a matrix from the last vertex back to the front one: h = D h' - B u', u = -C h' + A u'.
struct ThickLens {
    float A, B, C, D;  ///< elements of the matrix from front to last vertex, scaled by the film's refractive index
    float exit_pupil_distance;  ///< film to exit pupil, positive towards the scene, mm
    float exit_pupil_radius;  ///< mm
};

/// Pose of the camera in render space.
struct CameraFrame {
    Vec3f position;  ///< centre of the unshifted film, metres
    Vec3f right, up, backward;  ///< unit: x, y, z of the lens frame
};

/// Parameters of a camera for the render kernels. The base CameraFrame is the pose at the start of the exposure;
/// the base EffectViews holds the tables of the effects.
struct CameraView : CameraFrame, EffectViews {
    CameraModel model;
    int width, height;  ///< size of the picture, pixels
    PixelFilter filter;
    float film_half_width, film_half_height;  ///< mm
    Vec2f film_centre;  ///< film centre, from the axis, mm
    float film_distance;  ///< last vertex to film, mm
    float film_curvature;  ///< see FilmSurface; 0 for a rotationally symmetric lens, whose film is flat
    float axis_irradiance;  ///< irradiance on the axis behind the real lens for unit radiance; used by the ideal models
    float front_vertex_m;  ///< film to front vertex, metres
    float pupil_m;  ///< film to entrance pupil, metres
    ThinLens thin;
    ThickLens thick;
    LensMapView map;  ///< model mapped_lens; else without nodes
    CircleOfConfusion circle;
    PupilView pupil;  ///< centred, rotationally symmetric lenses
    PupilGridView pupil_grid;  ///< all other lenses; else without nodes
    TracedLightsView traced_lights;  ///< set by the session; empty if no light is traced
    PixelPupils pixel_pupils;  ///< PupilSampling::pixel; else null
    LensView<float> lens;  ///< for light from the film to the scene
    const LensView<double>* lens_in_double;  ///< model full_lens_double; else null
    LensPolynomialView polynomial;  ///< model polynomial_lens; else without coefficients
    BundleMotionsView bundles;  ///< calibrated cameras; else without nodes
    // Times as fractions of the exposure; 0 if nothing moves during it:
    float row_time;  ///< delay of each row of pixels after the row above
    float exposed_time;  ///< exposure time of each row
    const CameraFrame* keys;  ///< keyframes of a moving camera at uniformly spaced times; positions relative to the
                              ///< base placement
    int key_count;
};

/// True if the camera needs the code for LensKind::any, the kind of lenses of any shape.
REALCAM_INLINE bool needs_general_lens_code(const CameraView& camera) {
    return camera.pupil_grid.nodes || camera.lens.kind == LensKind::any;
}

/// Pose of the camera at a time, as a fraction of the exposure. The axes are interpolated linearly between two keys and
/// re-orthonormalised.
REALCAM_INLINE CameraFrame camera_at(const CameraView& camera, float time) {
    if (camera.key_count == 0) return camera;
    const KeyInterval interval = key_interval(time, camera.key_count);
    const CameraFrame &a = camera.keys[interval.first], &b = camera.keys[interval.first + 1];
    const Vec3f backward = normalized(mix(a.backward, b.backward, interval.share)),
                right = mix(a.right, b.right, interval.share);
    const Vec3f unit_right = normalized(right - dot(right, backward) * backward);
    return {camera.position + mix(a.position, b.position, interval.share), unit_right, cross(backward, unit_right),
            backward};
}

/// Converts a vector from render space to the axes of a camera, and back.
REALCAM_INLINE Vec3f to_camera_axes(const CameraFrame& camera, Vec3f v) {
    return {dot(v, camera.right), dot(v, camera.up), dot(v, camera.backward)};
}
REALCAM_INLINE Vec3f from_camera_axes(const CameraFrame& camera, Vec3f v) {
    return v.x * camera.right + v.y * camera.up + v.z * camera.backward;
}

/// Moves a frame by the motion of a bundle: the lens that is placed so images the bundle's part of the scene as the
/// calibrated camera does.
REALCAM_INLINE CameraFrame moved_frame(const BundleMotionsView& view, const BundleMotion& motion,
                                       const CameraFrame& camera) {
    const auto axis = [&](Vec3f unit) { return from_camera_axes(camera, rotated(motion.rotation(), unit)); };
    return {camera.position + from_camera_axes(camera, moved_point(view, motion, Vec3f{0, 0, 0})), axis({1, 0, 0}),
            axis({0, 1, 0}), axis({0, 0, 1})};
}

/// Centre of projection of a calibrated camera in render space.
REALCAM_INLINE Vec3f centre_of_projection(const CameraView& camera, const CameraFrame& frame) {
    return frame.position + from_camera_axes(frame, camera.bundles.centre);
}

/// Frame of a camera's lens as light from one point of the scene finds it, and the film point of the chief ray of that
/// point, mm. Without a calibration: the camera's frame for all points; the film point is unused.
struct LensPlacement : CameraFrame {
    Vec2f film;
};

/// `camera`: view, and `frame`, its frame at one time; `towards`: vector of any length, in render space, from the
/// centre of projection towards the light.
REALCAM_INLINE LensPlacement placement_towards(const CameraView& camera, const CameraFrame& frame, Vec3f towards) {
    if (!camera.bundles.nodes) return {frame, {0.0f, 0.0f}};
    const Vec2f film = film_point_seeing(camera.bundles, normalized(to_camera_axes(frame, towards)));
    return {moved_frame(camera.bundles, bundle_motion(camera.bundles, film), frame), film};
}

/// placement_towards for light from a point of render space.
REALCAM_INLINE LensPlacement placement_for(const CameraView& camera, const CameraFrame& frame, Vec3f point) {
    return placement_towards(camera, frame, point - centre_of_projection(camera, frame));
}

/// Depth of a point of render space: its distance from the film along the camera's axis, metres.
REALCAM_INLINE float depth_from(const CameraFrame& camera, Vec3f point) {
    return dot(camera.position - point, camera.backward);
}

/// Position of the lens's front vertex in render space, metres.
REALCAM_INLINE Vec3f front_vertex(const CameraFrame& camera, float front_vertex_m) {
    return camera.position - front_vertex_m * camera.backward;
}

/// Returns the view with every array replaced by a copy, for example in the memory of a GPU; `copy(pointer, count)`
/// copies `count` elements and returns the address of the copy.
template <class Copy>
CameraView with_copied_arrays(CameraView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.lens.surfaces, view.lens.count);
    view.lens.free.move_arrays(view.lens.count, move);
    move(view.keys, view.key_count);
    move(view.map.nodes, view.map.count);
    move(view.bundles.nodes, (view.bundles.columns + 1) * (view.bundles.rows + 1));
    move(view.bundles.derivatives, (view.bundles.columns + 1) * (view.bundles.rows + 1));
    move(view.bundles.defined, view.bundles.mask_columns * view.bundles.mask_rows);
    move(view.bundles.positions, view.bundles.side * view.bundles.side);
    move(view.polynomial.coefficients, 2 * LensPolynomialView::kVectors * view.polynomial.terms);
    move(view.polynomial.heights, 2 * view.polynomial.terms);
    move(view.polynomial.discs, 2 * LensPolynomialView::kDiscTerms * view.polynomial.disc_count);
    view.move_arrays(view.lens.count, move);
    view.traced_lights.move_arrays(move);
    view.pupil.move_arrays(move);
    view.pupil_grid.move_arrays(move);
    return view;
}

}  // namespace REALCAM_NAMESPACE
