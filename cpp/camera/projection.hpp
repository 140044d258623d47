#pragma once
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "sight_lines.hpp"

namespace REALCAM_NAMESPACE {

/// What became of a point of the scene on its way to the film.
enum class ProjectionStatus {
    ok,
    outside_picture,  ///< its light lands beside the film
    blocked,          ///< it lies in front of the lens, which lets none of its light through to the film's plane
    behind,           ///< it lies behind the lens, or in it
    bad_input,        ///< a coordinate is not finite
};

/// Columns and rows count from the upper left corner of the picture: the middle of the first pixel is (0.5, 0.5).
struct ProjectedPoint {
    Vec2<double> pixel;  ///< NaN where no line is known that goes there
    ProjectionStatus status;
};

/// A line from the lens into the scene, metres.
struct PixelRay {
    Vec3d origin_m, direction;  ///< NaN for a pixel without light
    double light = 0;           ///< the pixel's irradiance for an even field, over that in the middle of the film
};

/// Takes points of the scene to a camera's picture, and pixels to lines in the scene. Of a camera that moves each row
/// of pixels is where the camera is in the middle of the row's exposure.
class Projection {
public:
    Projection(const Camera& camera, std::shared_ptr<const SightLines> lines)
        : film_(camera.film), lines_(std::move(lines)) {
        const TimeInterval exposure = camera.exposure();
        const double row_time = camera.moves() ? camera.shutter.readout_time_s / film_.height : 0;
        const double begin = exposure.begin_s + 0.5 * camera.seen_time();
        const int rows = row_time > 0 ? film_.height : 1;
        for (int row = 0; row < rows; ++row)
            places_.push_back(camera_detail::scene_from_camera(pose_at(camera, begin + row * row_time)));
    }

    ProjectedPoint pixel_of(Vec3d point_m) const {
        if (!std::isfinite(point_m.x) || !std::isfinite(point_m.y) || !std::isfinite(point_m.z))
            return {kNowhere, ProjectionStatus::bad_input};
        if (places_.size() == 1) return seen_from(places_.front(), point_m);
        // The row says when the point is seen, and the time, which row: until they agree.
        int row = static_cast<int>(places_.size()) / 2;
        ProjectedPoint found{};
        for (int i = 0; i < kMostTurns; ++i) {
            found = seen_from(places_[static_cast<std::size_t>(row)], point_m);
            const int next = std::isfinite(found.pixel.y) ? row_of(found.pixel.y) : row;
            if (next == row) break;
            row = next;
        }
        return found;
    }

    PixelRay ray_of(Vec2<double> pixel) const {
        const Affine<double>& place = places_[places_.size() == 1 ? 0 : static_cast<std::size_t>(row_of(pixel.y))];
        // Seen from behind the camera, as the picture shows it.
        const auto [x, y] = film_.place_of(pixel);
        const double radius = std::hypot(x, y);
        if (!(radius <= lines_->reach())) return {kNowhere3, kNowhere3};
        const std::optional<SightLine> line = lines_->at(radius);
        if (!line) return {kNowhere3, kNowhere3};
        const double turn = lines_->sign(), c = radius > 0 ? turn * x / radius : 1,
                     s = radius > 0 ? turn * y / radius : 0;
        const double cosine = std::cos(line->angle), sine = std::sin(line->angle);
        const double away = 0.001 * (line->offset * cosine + line->start * sine);
        const double ahead = 0.001 * (lines_->reference() + line->start * cosine - line->offset * sine);
        return {place.origin + (c * away) * place.x + (s * away) * place.y - ahead * place.z,
                (c * sine) * place.x + (s * sine) * place.y - cosine * place.z, line->light};
    }

private:
    static constexpr int kMostTurns = 20;
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    static constexpr Vec2<double> kNowhere = {kNone, kNone};
    static constexpr Vec3d kNowhere3 = {kNone, kNone, kNone};

    int row_of(double y) const { return static_cast<int>(std::clamp(y, 0.0, static_cast<double>(film_.height - 1))); }

    ProjectedPoint seen_from(const Affine<double>& place, Vec3d point_m) const {
        const Vec3d from = 1000.0 * (point_m - place.origin);
        const double x = dot(from, place.x), y = dot(from, place.y), away = std::hypot(x, y);
        const double ahead = -dot(from, place.z) - lines_->reference();
        const std::optional<double> radius = lines_->radius_towards({away, ahead});
        if (!radius) {
            if (!(ahead > 0)) return {kNowhere, ProjectionStatus::behind};
            return {kNowhere, lines_->ends_in_film() ? ProjectionStatus::blocked : ProjectionStatus::outside_picture};
        }
        const double share = away > 0 ? lines_->sign() * *radius / away : 0;
        const Vec2<double> pixel = film_.pixel_of({share * x, share * y});
        const bool inside = pixel.x >= 0 && pixel.x <= film_.width && pixel.y >= 0 && pixel.y <= film_.height;
        return {pixel, inside ? ProjectionStatus::ok : ProjectionStatus::outside_picture};
    }

    Film film_;
    std::shared_ptr<const SightLines> lines_;
    std::vector<Affine<double>> places_;  ///< of the rows of pixels; one, if it is the same for all
};

}  // namespace REALCAM_NAMESPACE
