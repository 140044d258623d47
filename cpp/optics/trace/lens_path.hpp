#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "../prescription/aperture_shape.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_system.hpp"
#include "aperture.hpp"
#include "lens_trace.hpp"
#include "lens_view.hpp"
#include "open_iris.hpp"
#include "traced_shape.hpp"

namespace REALCAM_NAMESPACE {

namespace path_frames_detail {

/// True if a surface is tilted or decentred.
inline bool has_placements(const LensSystem& lens) {
    for (const Surface& surface : lens.surfaces)
        if (!surface.placement.is_in_place()) return true;
    return false;
}

/// Returns the transform from the frame of surface `to` to that of its neighbour `from`.
inline Affine<double> neighbour(const LensSystem& lens, int from, int to) {
    return to > from ? frame_of_next(lens, from) : inverse_motion(frame_of_next(lens, to));
}

/// Returns -1 if the z axis of a crossing's surface points backwards in the frame of the surface crossed before, so
/// that light that travels to +z in that frame travels to -z in this one; else 1. A frame at a right angle counts as
/// pointing forwards. `crossing`: index in `crossings`.
inline double axis_sign_before(const LensSystem& lens, const std::vector<Crossing>& crossings, std::size_t crossing) {
    const int to = crossings[crossing].surface;
    const Affine<double> frame = crossing == 0 ? lens.surfaces[static_cast<std::size_t>(to)].placement.frame()
                                               : neighbour(lens, crossings[crossing - 1].surface, to);
    constexpr double kRightAngle = 1e-9;
    return frame.z.z < -kRightAngle ? -1 : 1;
}

/// Returns the change from a frame to the one whose origin and axes are `frame` in it.
template <class T>
FrameChange<T> change_to(const Affine<double>& frame) {
    return {static_cast<Vec3<T>>(frame.origin), static_cast<Vec3<T>>(frame.x), static_cast<Vec3<T>>(frame.y),
            static_cast<Vec3<T>>(frame.z), 1};
}

}  // namespace path_frames_detail

/// Returns an ellipse or rectangle. `half`: half widths; `offset`: centre relative to the vertex, mm; `angle_deg`:
/// rotation from x towards y.
template <class T>
AperturePiece<T> aperture_piece(bool is_rectangle, Vec2d half, Vec2d offset, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const auto number = [](double v) { return static_cast<T>(v); };
    return {number(offset.x),   number(offset.y), number(std::cos(angle)), number(std::sin(angle)), number(1 / half.x),
            number(1 / half.y), is_rectangle};
}

/// Returns an aperture prepared for tracing.
template <class T>
ApertureView<T> aperture_view(const ApertureShape& shape) {
    ApertureView<T> view{};
    if (shape.is_plain()) return view;
    view.is_shaped = 1;
    const bool is_polygon = shape.kind == ApertureOutline::polygon;
    view.has_outer = !is_polygon && shape.half.x > 0;
    if (view.has_outer)
        view.outer = aperture_piece<T>(shape.kind == ApertureOutline::rectangle, shape.half, shape.offset, 0);
    for (const Obscuration& piece : shape.obscurations)
        view.obscuration[view.obscurations++] =
            aperture_piece<T>(piece.is_rectangle, piece.half, piece.offset, piece.angle_deg);
    if (!is_polygon) return view;
    for (const Vec2d& corner : shape.corners) {
        view.corner_x[view.corners] = static_cast<T>(shape.offset.x + corner.x);
        view.corner_y[view.corners++] = static_cast<T>(shape.offset.y + corner.y);
    }
    return view;
}

/// Direction in which rays are traced: from the scene to the film, or from the film to the scene.
enum class LightDirection { to_film, to_scene };

/// Frames in which rays enter and leave a path, as transforms to the lens frame; std::nullopt stands for the lens
/// frame.
struct PathEnds {
    std::optional<Affine<double>> entry, exit;
};

/// Surfaces of a lens in the order of the light, prepared for tracing rays of one wavelength in one direction. Owns the
/// memory of its view. Throws InputError if a glass has no index at the wavelength.
template <class T>
class LensPath {
public:
    /// Direct path through the whole lens.
    LensPath(const LensSystem& lens, LightDirection direction, double wavelength_nm, const PathEnds& ends = {})
        : LensPath(lens, crossings_of(lens), direction, wavelength_nm, ends) {}

    /// Path of light along these crossings, which are in the order of light to the film; for LightDirection::to_scene
    /// it is followed in reverse. Origins of rays are relative to the points `entry_position` and `exit_position` on
    /// the z axis of the lens frame, or to the origins of `ends`.
    LensPath(const LensSystem& lens, const std::vector<Crossing>& crossings, LightDirection direction,
             double wavelength_nm, const PathEnds& ends = {})
        : iris_(iris_of(lens)) {
        const std::vector<double> n = lens.indices(wavelength_nm);
        const std::vector<double> z = lens.vertices();
        const auto vertex = [&](std::size_t crossing) {
            return z[static_cast<std::size_t>(crossings[crossing].surface)];
        };
        const bool to_film = direction == LightDirection::to_film;
        const bool is_centred = !path_frames_detail::has_placements(lens) && !ends.entry && !ends.exit;
        double direction_sign = 1;  // sign of the z direction, in the surface's frame, of light travelling to the film
        for (std::size_t m = 0; m < crossings.size(); ++m) {
            const Surface& surface = lens.surfaces[static_cast<std::size_t>(crossings[m].surface)];
            if (!is_centred) direction_sign *= path_frames_detail::axis_sign_before(lens, crossings, m);
            const bool is_reflected = crossings[m].is_reflected || surface.type == SurfaceType::mirror;
            const double sign_behind = is_reflected ? -direction_sign : direction_sign;
            const double before = crossings[m].index_before(n), behind = crossings[m].index_behind(n);
            SurfaceView<T> view = traced_shape<T>(surface).view;
            view.surface_index = crossings[m].surface;
            if (to_film) {
                set_media(view, before, behind, direction_sign, sign_behind);
                view.shift = static_cast<T>(m == 0 ? 0.0 : vertex(m) - vertex(m - 1));
            } else {
                set_media(view, behind, before, -sign_behind, -direction_sign);
                view.shift = static_cast<T>(m + 1 == crossings.size() ? 0.0 : vertex(m) - vertex(m + 1));
            }
            if (surface.type == SurfaceType::stop) set_stop(view, lens);
            views_.push_back(view);
            direction_sign = sign_behind;
        }
        if (!to_film) std::reverse(views_.begin(), views_.end());
        entry_index = to_film ? n.front() : n.back();
        // A few diameters: squares of these distances keep enough digits in float32 for a surface of this size.
        constexpr double kReachInRadii = 16;
        entry_reach = kReachInRadii * (to_film ? lens.surfaces.front() : lens.surfaces.back()).clear_semi_diameter;
        entry_position = to_film ? z.front() : z.back();
        exit_position = to_film ? z.back() : z.front();
        if (!is_centred) set_frames(lens, ends);
        set_asymmetric_parts(lens);
    }

    LensView<T> view() const {
        const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
        const AsymmetricParts<T> free{data_of(frames_), data_of(freeforms_), data_of(apertures_)};
        return {views_.data(), static_cast<int>(views_.size()), kind(), iris_, free};
    }

    double entry_index = 1;  ///< refractive index of the medium from which rays enter: the length of their directions
    double entry_reach = 0;  ///< origins farther than this from the first vertex, mm, must be moved nearer (enter_lens)
    double entry_position = 0;  ///< z in the lens frame to which origins of entering rays are relative, mm; 0 with
                                ///< PathEnds::entry
    double exit_position = 0;  ///< the same for leaving rays, and PathEnds::exit

private:
    /// Returns the most special kind that includes the path.
    LensKind kind() const {
        if (!frames_.empty() || !freeforms_.empty() || !apertures_.empty()) return LensKind::any;
        const bool plain = std::all_of(views_.begin(), views_.end(), [](const SurfaceView<T>& view) {
            return view.kind == SurfaceShape::sphere && view.hole_squared < T(0) && !view.has_blades;
        });
        return plain ? LensKind::plain : LensKind::rotational;
    }

    /// Sets the frame changes between surfaces. Where consecutive surfaces share an axis, the shift along it suffices.
    void set_frames(const LensSystem& lens, const PathEnds& ends) {
        const SurfaceFrames frames = surface_frames(lens);
        const std::vector<double> z = lens.vertices();
        const auto frame = [&](std::size_t k) {
            return frames.surfaces[static_cast<std::size_t>(views_[k].surface_index)];
        };
        const auto frame_on_axis = [](double position) { return Affine<double>{.origin = {0, 0, position}}; };
        if (ends.entry) entry_position = 0;
        if (ends.exit) exit_position = 0;
        for (std::size_t k = 0; k < views_.size(); ++k) {
            FrameChanges<T>& changes = frames_.emplace_back();
            const Affine<double> before =
                k == 0 ? inverse_motion(ends.entry.value_or(frame_on_axis(entry_position))) * frame(k)
                       : path_frames_detail::neighbour(lens, views_[k - 1].surface_index, views_[k].surface_index);
            if (!(before == frame_on_axis(k == 0 ? 0.0 : before.origin.z))) {
                changes.before = path_frames_detail::change_to<T>(before);
                views_[k].shift = 0;
            } else {
                views_[k].shift = static_cast<T>(before.origin.z);
            }
            const double vertex = z[static_cast<std::size_t>(views_[k].surface_index)];
            const Affine<double> out = inverse_motion(frame(k)) * ends.exit.value_or(frame_on_axis(vertex));
            if (!(out == Affine<double>{})) changes.out = path_frames_detail::change_to<T>(out);
        }
        const auto is_used = [](const FrameChanges<T>& changes) { return changes.before.changes != 0; };
        if (std::none_of(frames_.begin(), frames_.end(), is_used) && !frames_.back().out.changes) frames_.clear();
    }

    /// Sets the freeforms and apertures, if any surface has one.
    void set_asymmetric_parts(const LensSystem& lens) {
        const auto surface = [&](const SurfaceView<T>& view) -> const Surface& {
            return lens.surfaces[static_cast<std::size_t>(view.surface_index)];
        };
        const auto is_shaped = [&](const SurfaceView<T>& view) { return !surface(view).aperture_shape.is_plain(); };
        const auto is_freeform = [](const SurfaceView<T>& view) { return view.kind == SurfaceShape::freeform; };
        if (std::any_of(views_.begin(), views_.end(), is_shaped))
            for (const SurfaceView<T>& view : views_)
                apertures_.push_back(aperture_view<T>(surface(view).aperture_shape));
        if (std::any_of(views_.begin(), views_.end(), is_freeform))
            for (const SurfaceView<T>& view : views_)
                freeforms_.push_back(is_freeform(view) ? traced_shape<T>(surface(view)).freeform : FreeformView<T>{});
    }

    /// Sets refractive indices and direction signs. `before`, `after`: indices in the order of the rays.
    static void set_media(SurfaceView<T>& view, double before, double after, double direction_sign_in,
                          double direction_sign_out) {
        view.index_squared = static_cast<T>(before * before);
        view.squared_index_change = static_cast<T>((after - before) * (after + before) / (before * before));
        view.direction_sign_in = static_cast<T>(direction_sign_in);
        view.direction_sign_out = static_cast<T>(direction_sign_out);
    }

    /// Sets the opening of the stop: blades, or a round rim.
    static void set_stop(SurfaceView<T>& view, const LensSystem& lens) {
        view.has_blades = lens.iris.blades > 0 && !lens.is_wide_open();
        if (!view.has_blades) {
            const double radius = lens.open_stop_radius();
            view.rim_squared = static_cast<T>(radius * radius);
        }
    }

    /// Returns the blades of the stop; none if it is round or wide open.
    static Iris<T> iris_of(const LensSystem& lens) {
        Iris<T> iris{};
        if (lens.iris.blades == 0 || lens.is_wide_open()) return iris;
        const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
        iris.blades = open.blades;
        iris.apothem = static_cast<T>(open.apothem);
        iris.curvature = static_cast<T>(open.curvature);
        std::transform(open.cos, open.cos + open.blades, iris.cos, [](double v) { return static_cast<T>(v); });
        std::transform(open.sin, open.sin + open.blades, iris.sin, [](double v) { return static_cast<T>(v); });
        return iris;
    }

    std::vector<SurfaceView<T>> views_;
    std::vector<FrameChanges<T>> frames_;  ///< empty: centred lens
    std::vector<FreeformView<T>> freeforms_;  ///< empty: no freeforms
    std::vector<ApertureView<T>> apertures_;
    Iris<T> iris_;
};

}  // namespace REALCAM_NAMESPACE
