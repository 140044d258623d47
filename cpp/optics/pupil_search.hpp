#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "lens_path.hpp"
#include "pupil_box.hpp"

namespace REALCAM_NAMESPACE {

/// Traces float rays from the film of one lens; marks in `passes` those that leave the lens. The backend may bring a
/// faster one than the build's baseline.
using PupilTracer = std::function<void(const LensView<float>&, LensRays<float, 256>&)>;

/// Finds, with real rays, where the directions lie that pass a lens from a film point on the +x axis.
class PupilSearch {
public:
    static constexpr int kBlock = 256;
    /// Of one look: two searches of six levels, 17 blocks each, and of 17 growths.
    static constexpr int kMostBlocks = 2 * (6 * 17 + 17 * 6);

    PupilSearch(const LensSystem& lens, PupilTracer tracer)
        : lens_(round_iris(lens)),
          path_(lens_, LightDirection::to_scene, lens.wavelength_nm),
          tracer_(tracer ? std::move(tracer)
                         : [](const LensView<float>& v, LensRays<float, kBlock>& r) { trace_lens(v, r); }) {}

    double index_squared() const { return path_.entry_index * path_.entry_index; }

    /// Which of these directions, from a film point at (radius, 0), pass the lens.
    template <class DirectionAt, class Result>
    void trace(double radius, int count, DirectionAt&& direction_at, Result&& result) const {
        trace(path_.view(), radius, count, direction_at,
              [&](int i, const LensRays<float, kBlock>& rays, int lane) { result(i, rays.status[lane] == 0); });
    }

    /// The box at a film radius further out than those on the track; adds it there.
    std::optional<PupilBox> look(double radius, PupilTrack& track) const {
        const PupilBox widest = box_of_last_surface(radius);
        std::optional<PupilBox> box;
        if (track.last) box = find_box(radius, track.search_at(radius), widest);
        if (!box) box = find_box(radius, widest, widest);
        if (box) track.add(radius, *box);
        return box;
    }

private:
    static constexpr int kGrid = 48;  ///< points of the search grid along l; half of them along m >= 0

    /// Blades are ignored here and reject rays later; the circle around their opening holds all that pass.
    static LensSystem round_iris(LensSystem lens) {
        const double rim = lens.stop().clear_semi_diameter;
        if (lens.iris.blades > 0 && !lens.is_wide_open()) {
            const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
            const double h = open.apothem, q = open.curvature;
            const double linear = (1 - q * h) * std::cos(std::numbers::pi / open.blades), constant = 2 * h - q * h * h;
            lens.stop_semi_diameter = std::min(rim, constant / (linear + std::sqrt(linear * linear + q * constant)));
        }
        lens.iris.blades = 0;
        return lens;
    }

    template <class DirectionAt, class Result>
    void trace(const LensView<float>& view, double radius, int count, DirectionAt&& direction_at,
               Result&& result) const {
        LensRays<float, kBlock> rays;
        for (int first = 0; first < count; first += kBlock) {
            const int used = std::min(kBlock, count - first);
            for (int i = 0; i < kBlock; ++i) {
                const PupilDirection d = direction_at(first + std::min(i, used - 1));
                const double n2 = path_.entry_index * path_.entry_index - d.l * d.l - d.m * d.m;
                rays.origin.set(i, {static_cast<float>(radius), 0, static_cast<float>(lens_.film_distance)});
                rays.direction.set(i, {static_cast<float>(d.l), static_cast<float>(d.m),
                                       static_cast<float>(-std::sqrt(std::max(n2, 0.0)))});
                rays.status[i] = n2 > 0 ? 0 : static_cast<int>(RayStatus::missed);
            }
            tracer_(view, rays);
            for (int i = 0; i < used; ++i) result(first + i, rays, i);
        }
    }

    /// Box of the directions from a film point to the last surface's clear aperture.
    PupilBox box_of_last_surface(double radius) const {
        const Surface& last = lens_.surfaces.back();
        PupilBox box = PupilBox::none();
        for (int ring = 0; ring <= 8; ++ring)
            for (int spoke = 0; spoke <= 16; ++spoke) {
                const double r = last.clear_semi_diameter * ring / 8, angle = std::numbers::pi * spoke / 16;
                const Vec3d d = path_.entry_index * normalized(Vec3d{r * std::cos(angle) - radius, r * std::sin(angle),
                                                                     last.sag(r) - lens_.film_distance});
                box = box.with({d.x, d.y});
            }
        return box.grown(0.02);
    }

    static PupilDirection grid_point(const PupilBox& box, int i) {
        const double a = (i % kGrid + 0.5) / kGrid, b = (i / kGrid + 0.5) / (kGrid / 2);
        return {box.l_min + a * (box.l_max - box.l_min), b * box.m_max};
    }

    /// Bounding box of the passing directions inside `search`; nothing where fewer than
    /// `wanted` points of the grid pass.
    std::optional<PupilBox> passing_box(double radius, const PupilBox& search, int wanted) const {
        PupilBox box = PupilBox::none();
        PupilDirection highest{0, 0};  // the middle of the top row's passing points
        double leftmost = 0;
        int passed = 0;
        trace(
            radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
            [&](int i, bool passes) {
                if (!passes) return;
                const PupilDirection d = grid_point(search, i);
                if (d.m > highest.m) leftmost = d.l;
                highest = {0.5 * (leftmost + d.l), d.m};
                box = box.with(d);
                ++passed;
            });
        if (passed < wanted) return std::nullopt;
        const double cell_l = (search.l_max - search.l_min) / kGrid, cell_m = search.m_max / (kGrid / 2);
        return refined(radius, box, highest, cell_l, cell_m);
    }

    /// Moves the box's three edges out to where the light ends, which is less than a cell away from the outermost
    /// grid point that passes. The region is symmetric in m, so it is widest along l where m is 0.
    PupilBox refined(double radius, PupilBox box, PupilDirection highest, double cell_l, double cell_m) const {
        constexpr int kSteps = kBlock / 3;
        const PupilBox from = box;
        const auto direction = [&](int i) {
            const double step = (i % kSteps + 1.0) / kSteps;
            switch (i / kSteps) {
                case 0: return PupilDirection{from.l_min - step * cell_l, 0};
                case 1: return PupilDirection{from.l_max + step * cell_l, 0};
                default: return PupilDirection{highest.l, from.m_max + step * cell_m};
            }
        };
        trace(radius, 3 * kSteps, direction, [&](int i, bool passes) {
            if (!passes) return;
            const PupilDirection d = direction(i);
            box = box.with(d);
        });
        box.l_min -= cell_l / kSteps;
        box.l_max += cell_l / kSteps;
        box.m_max += cell_m / kSteps;
        return box;
    }

    /// A small aperture falls through any grid: where too few rays pass, goes to the ray that comes nearest to the
    /// middle of the stop, in a smaller box.
    std::optional<PupilBox> find_box(double radius, PupilBox search, const PupilBox& widest) const {
        constexpr int kLevels = 6;
        for (int level = 0; level < kLevels; ++level) {
            if (const auto box = passing_box(radius, search, 48)) return whole(radius, *box, search, widest);
            const auto nearest = nearest_to_stop(radius, search);
            if (!nearest) break;
            const double w = search.half_width() / 6, h = search.m_max / 6;
            const auto few = passing_box(radius, search, 1);
            search = few ? few->grown(0.2) : PupilBox{nearest->l - w, nearest->l + w, nearest->m + h};
        }
        const auto few = passing_box(radius, search, 1);
        return few ? whole(radius, *few, search, widest) : few;
    }

    /// The searched box may have held a part of the region only: follows it as far as it goes. A region that has moved
    /// by more than its size begins as a sliver, and one that is found by its nearest ray as its middle.
    PupilBox whole(double radius, PupilBox box, PupilBox search, const PupilBox& widest) const {
        constexpr int kMostGrowths = 16;
        for (int i = 0; i < kMostGrowths && !box.lies_in(search, widest); ++i) {
            search = box.grown(1);
            const auto more = passing_box(radius, search, 1);
            if (!more) break;
            box = *more;
        }
        return box;
    }

    std::optional<PupilDirection> nearest_to_stop(double radius, const PupilBox& search) const {
        LensView<float> to_stop = path_.view();
        std::vector<LensStep<float>> steps(to_stop.steps, to_stop.steps + to_stop.count);
        const int stop = lens_.stop_index();
        const auto count = lens_.surfaces.size() - static_cast<std::size_t>(stop);
        steps[count - 1].rim_squared = std::numeric_limits<float>::max();
        to_stop.steps = steps.data();
        to_stop.count = static_cast<int>(count);
        std::optional<PupilDirection> nearest;
        float least = std::numeric_limits<float>::max();
        trace(
            to_stop, radius, kGrid * kGrid / 2, [&](int i) { return grid_point(search, i); },
            [&](int i, const LensRays<float, kBlock>& rays, int lane) {
                const float x = rays.origin.x[lane], y = rays.origin.y[lane];
                if (rays.status[lane] != 0 || !(x * x + y * y < least)) return;
                least = x * x + y * y;
                nearest = grid_point(search, i);
            });
        return nearest;
    }

    LensSystem lens_;
    LensPath<float> path_;
    PupilTracer tracer_;
};

}  // namespace REALCAM_NAMESPACE
