#pragma once
// Helpers of the pupil tests: a test whether a direction lies in the sampled region, and traces of many rays at once.

#include <cmath>
#include <string>
#include <vector>

#include "optics/lens/paraxial.hpp"
#include "optics/pupil/pupil.hpp"
#include "traced_ray.hpp"

namespace realcam::test {

/// A lens at one aperture and focus setting, and a description of the setting.
struct LensState {
    LensSystem lens;
    bool is_open;
    std::string description;
};

inline double half_diagonal(const LensSystem& lens) {
    return 0.5 * std::hypot(lens.film_width, lens.film_height);
}

/// A bundled lens far and near, wide open; far at f/22, and near at f/5.6 (where it is faster).
inline std::vector<LensState> states_of(const std::string& name) {
    const LensSystem lens = io::read_lens(name);
    const double full = first_order(lens, lens.wavelength_nm).f_number;
    std::vector<LensState> states;
    for (const double distance : {kInfinity, near_focus(lens)})
        for (const double f_number : {full, std::isinf(distance) ? 22.0 : 5.6}) {
            if (f_number < 1.001 * full && f_number != full) continue;
            const std::string focus = std::isinf(distance) ? "infinity" : std::to_string(distance) + " mm";
            states.push_back({focused(stopped_down(lens, f_number), distance), f_number == full,
                              name + " at f/" + std::to_string(f_number) + ", focused at " + focus});
        }
    return states;
}

/// The directions that a PupilView describes for one film radius: its row of triangles (less their holes),
/// between the boxes of the row's two nodes. Film point on the +x axis.
class PupilRegion {
public:
    PupilRegion(const PupilView& pupil, double radius)
        : pupil_(pupil), lit_(radius < static_cast<double>(pupil.image_radius)) {
        const double inside = lit_ ? 1 - radius / static_cast<double>(pupil.image_radius) : 0;
        const double position = pupil.rows * (1 - std::sqrt(inside));
        row_ = std::min(static_cast<int>(position), pupil.rows - 1);
        const double f = position - row_;
        const SymmetricPupilNode &a = pupil.nodes[row_], &b = pupil.nodes[row_ + 1];
        const auto between = [&](float x, float y) {
            return static_cast<double>(x) * (1 - f) + static_cast<double>(y) * f;
        };
        centre = between(a.centre_l, b.centre_l);
        half_width = between(a.half_width, b.half_width);
        half_height = between(a.half_height, b.half_height);
    }

    /// `slack` in units of the box: single precision draws the same edges that much elsewhere.
    bool contains(double l, double m, double slack = 0) const {
        if (!lit_) return false;
        const double x = (l - centre) / half_width, y = std::fabs(m) / half_height;
        for (int s = 0; s < PupilView::kSectors; ++s) {
            const PupilSector& t = pupil_.outline[row_ * PupilView::kSectors + s];
            const double px = static_cast<double>(t.x), py = static_cast<double>(t.y);
            const double dx = static_cast<double>(t.dx), dy = static_cast<double>(t.dy);
            // (x, y) = reach * (p + along * d).
            const double twice_area = px * dy - py * dx;
            const double reach = (x * dy - y * dx) / twice_area, along = (px * y - py * x) / twice_area;
            const double hole = std::sqrt(static_cast<double>(t.hole_squared));
            if (reach <= 1 + slack && reach >= hole - slack && along >= -slack && along <= reach + slack) return true;
        }
        return false;
    }

    double centre, half_width, half_height;

private:
    PupilView pupil_;
    bool lit_;
    int row_;
};

/// Traces rays in single precision, as pictures do, from one film point: position from the last vertex.
class FilmPointTracer {
public:
    explicit FilmPointTracer(const LensSystem& lens)
        : film_distance_(static_cast<float>(lens.film_distance)),
          path_(lens, LightDirection::to_scene, lens.wavelength_nm) {}

    /// direction_of(i) for i < count; result(i, passes).
    template <class DirectionOf, class Result>
    void operator()(float film_x, float film_y, int count, DirectionOf&& direction_of, Result&& result) const {
        constexpr int kBlock = 256;
        LensRays<float, kBlock> rays;
        for (int first = 0; first < count; first += kBlock) {
            for (int i = 0; i < kBlock; ++i) {
                const bool used = first + i < count;
                rays.origin.set(i, {film_x, film_y, film_distance_});
                rays.direction.set(i, used ? direction_of(first + i) : Vec3f{0, 0, -1});
                rays.status[i] = used ? 0 : static_cast<int>(RayStatus::bad_input);
            }
            trace_lens(path_.view(), rays);
            for (int i = 0; i < kBlock && first + i < count; ++i) result(first + i, rays.status[i] == 0);
        }
    }

private:
    float film_distance_;
    LensPath<float> path_;
};

}  // namespace realcam::test
