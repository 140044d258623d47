#pragma once
#include <cmath>
#include <numbers>

#include "../prescription/aperture_shape.hpp"
#include "aperture.hpp"

namespace REALCAM_NAMESPACE {

template <class T>
AperturePiece<T> aperture_piece(bool is_rectangle, Vec2d half, Vec2d offset, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const auto to = [](double v) { return static_cast<T>(v); };
    return {to(offset.x),   to(offset.y),   to(std::cos(angle)), to(std::sin(angle)),
            to(1 / half.x), to(1 / half.y), is_rectangle};
}

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

}  // namespace REALCAM_NAMESPACE
