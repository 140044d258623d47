#include "aperture_shape.hpp"

#include <algorithm>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

std::string ApertureShape::asymmetry() const {
    if (!obscurations.empty()) return "has an obscuration";
    switch (kind) {
        case ApertureOutline::circle: break;
        case ApertureOutline::ellipse: return "has an elliptic aperture";
        case ApertureOutline::rectangle: return "has a rectangular aperture";
        case ApertureOutline::polygon: return "has a polygonal aperture";
    }
    return half != Vec2d{0, 0} && offset != Vec2d{0, 0} ? "has a decentred aperture" : "";
}

ApertureShape ApertureShape::scaled(double factor) const {
    const auto scaled_vector = [factor](Vec2d v) { return Vec2d{factor * v.x, factor * v.y}; };
    ApertureShape result = *this;
    result.half = scaled_vector(half);
    result.offset = scaled_vector(offset);
    for (Vec2d& corner : result.corners) corner = scaled_vector(corner);
    for (Obscuration& piece : result.obscurations) {
        piece.half = scaled_vector(piece.half);
        piece.offset = scaled_vector(piece.offset);
    }
    return result;
}

ApertureBox ApertureShape::box(double rim) const {
    ApertureBox box{{-rim, -rim}, {rim, rim}};
    const auto restrict_box = [&](Vec2d low, Vec2d high) {
        box.low = {std::clamp(low.x, -rim, rim), std::clamp(low.y, -rim, rim)};
        box.high = {std::clamp(high.x, -rim, rim), std::clamp(high.y, -rim, rim)};
    };
    if (kind == ApertureOutline::polygon) {
        Vec2d low{rim, rim}, high{-rim, -rim};
        for (const Vec2d& corner : corners) {
            low = {std::min(low.x, offset.x + corner.x), std::min(low.y, offset.y + corner.y)};
            high = {std::max(high.x, offset.x + corner.x), std::max(high.y, offset.y + corner.y)};
        }
        restrict_box(low, high);
    } else if (half.x > 0) {
        restrict_box({offset.x - half.x, offset.y - half.y}, {offset.x + half.x, offset.y + half.y});
    }
    return box;
}

double ApertureShape::reach() const {
    double reach = 0;
    const auto include = [&](double x, double y) { reach = std::max(reach, hypotenuse(x, y)); };
    switch (kind) {
        case ApertureOutline::circle:
            if (half.x > 0) reach = hypotenuse(offset.x, offset.y) + half.x;
            break;
        case ApertureOutline::ellipse:
            // An off-centre ellipse is bounded by the corners of its bounding box.
            if (offset == Vec2d{0, 0}) return std::max(half.x, half.y);
            include(std::fabs(offset.x) + half.x, std::fabs(offset.y) + half.y);
            break;
        case ApertureOutline::rectangle: include(std::fabs(offset.x) + half.x, std::fabs(offset.y) + half.y); break;
        case ApertureOutline::polygon:
            for (const Vec2d& corner : corners) include(offset.x + corner.x, offset.y + corner.y);
            break;
    }
    return reach;
}

std::vector<Obscuration> spider_arms(int count, double width, double length, double angle_deg) {
    std::vector<Obscuration> arms;
    for (int i = 0; i < count; ++i) {
        const double degrees = angle_deg + 360.0 * i / count, angle = degrees * std::numbers::pi / 180;
        arms.push_back(
            {true, {length / 2, width / 2}, {length / 2 * std::cos(angle), length / 2 * std::sin(angle)}, degrees});
    }
    return arms;
}

}  // namespace realcam
