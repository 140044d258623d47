#pragma once
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "scene_pieces.hpp"

namespace REALCAM_NAMESPACE {

/// Finds what a picture of a scene is of, which is not always the whole scene: an object on a wide floor under a sky
/// is the object.
///
/// Surroundings are taken away, one after the other, as long as what is left is less than a third as large (diagonals
/// of boxes), so that an object of one piece, a room and its furniture, or a table and what stands on it stay whole:
/// - floors and walls: planes across one axis of the scene that reach along at least half of it in both other
/// directions
///   and are at least half covered; and single triangles longer than a third of the scene and than three times what is
///   left, such as the sides of a slab;
/// - what lies beyond a gap: a shell about the middle of the subject that no piece touches, and whose outer radius is
///   eight times the inner. Either it surrounds what lies within, as a sky does (it is seen in 40% or more of the
///   directions), or it is far away and little: at most a tenth of the pieces and of their area.
/// What could be the middle of the subject: the median of all pieces; that of the finest detail; and the pieces nearest
/// to the middle of the scene and of its lower side, whether y or z is up, where a small object under a sky is.
class Surroundings {
public:
    explicit Surroundings(const Assembly& assembly) : pieces_(assembly), kept_(pieces_.count(), true) {
        box_ = box_of(kept_);
        while (take_away()) {
        }
    }

    /// Of what is left.
    const BoundingBox& box() const { return box_; }
    const ScenePieces& pieces() const { return pieces_; }
    bool keeps(std::size_t piece) const { return kept_[piece]; }

private:
    using Chosen = std::vector<bool>;  ///< by the piece's number
    static constexpr double kMuchSmaller = 1.0 / 3, kVast = 0.5, kCovered = 0.5, kLong = 1.0 / 3;
    static constexpr double kSeenAround = 0.4, kLittle = 0.1;
    static constexpr double kLeastSubject = 4;  ///< triangles: a stray one in a hollow object is no subject
    /// Corners of one plane differ by roundings of float32 at most, 6e-8 of a coordinate.
    static constexpr double kFlat = 1e-6;

    template <class F>
    void for_chosen(const Chosen& chosen, F&& f) const {
        pieces_.for_each([&](std::size_t i) { return chosen[i]; }, f);
    }

    BoundingBox box_of(const Chosen& chosen) const {
        BoundingBox box;
        for_chosen(chosen, [&](std::size_t, const Piece& piece) { box.add(piece.box); });
        return box;
    }

    bool keep(Chosen&& chosen, double largest = std::numeric_limits<double>::infinity()) {
        const BoundingBox box = box_of(chosen);
        if (box.empty() || !(box.diagonal() <= kMuchSmaller * std::min(box_.diagonal(), largest))) return false;
        kept_ = std::move(chosen);
        box_ = box;
        return true;
    }

    bool take_away() {
        const WithoutSheets rest = without_sheets();
        if (rest.any_left_out && keep(Chosen(rest.chosen), rest.shortest_left_out)) return true;
        return keep(within_a_gap(kept_)) ||
               (rest.any_left_out && keep(within_a_gap(rest.chosen), rest.shortest_left_out));
    }

    static std::array<double, 3> numbers(Vec3d v) { return {v.x, v.y, v.z}; }

    struct Sheet {
        BoundingBox box;
        double area = 0;
    };
    struct WithoutSheets {
        Chosen chosen;
        bool any_left_out = false;
        double shortest_left_out = std::numeric_limits<double>::infinity();  ///< of single long pieces
    };

    /// Of an instance, which has no area of its own, as much as its box shows.
    static double area_across(const Piece& piece, std::size_t axis) {
        const auto size = numbers(piece.box.size()), area = numbers(piece.area);
        return piece.area == Vec3d{} ? size[(axis + 1) % 3] * size[(axis + 2) % 3] : std::fabs(area[axis]);
    }

    bool is_vast(const Sheet& sheet, std::size_t axis) const {
        const auto size = numbers(sheet.box.size()), whole = numbers(box_.size());
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        return size[u] >= kVast * whole[u] && size[v] >= kVast * whole[v] && sheet.area >= kCovered * size[u] * size[v];
    }

    WithoutSheets without_sheets() const {
        // For each axis the planes across it, by their height in units of what counts as flat.
        std::array<std::map<std::int64_t, Sheet>, 3> sheets;
        const double flat = kFlat * box_.diagonal();
        const auto plane_of = [&](const Piece& piece, std::size_t axis) -> std::optional<std::int64_t> {
            const double low = numbers(piece.box.low)[axis], high = numbers(piece.box.high)[axis];
            if (!(high - low <= flat) || !(flat > 0)) return {};
            return std::llround((0.5 * (low + high) - numbers(box_.low)[axis]) / (4 * flat));
        };
        double longest_squared = 0;
        for_chosen(kept_, [&](std::size_t, const Piece& piece) {
            const Vec3d size = piece.box.size();
            longest_squared = std::max(longest_squared, dot(size, size));
            if (std::min({size.x, size.y, size.z}) > flat) return;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (const auto plane = plane_of(piece, axis)) {
                    Sheet& sheet = sheets[axis][*plane];
                    sheet.box.add(piece.box);
                    sheet.area += area_across(piece, axis);
                }
        });
        WithoutSheets rest{kept_};
        const double longest_kept = kLong * box_.diagonal();
        for (std::size_t axis = 0; axis < 3; ++axis)
            std::erase_if(sheets[axis], [&](const auto& entry) { return !is_vast(entry.second, axis); });
        if (sheets[0].empty() && sheets[1].empty() && sheets[2].empty() &&
            longest_squared <= longest_kept * longest_kept)
            return rest;
        rest.any_left_out = true;
        for_chosen(kept_, [&](std::size_t i, const Piece& piece) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (const auto plane = plane_of(piece, axis); plane && sheets[axis].contains(*plane))
                    rest.chosen[i] = false;
            const double own = piece.box.diagonal();
            if (!rest.chosen[i] || own <= longest_kept) return;
            rest.chosen[i] = false;
            rest.shortest_left_out = std::min(rest.shortest_left_out, own);
        });
        return rest;
    }

    /// Every so many of the chosen pieces.
    std::vector<Piece> some_of(const Chosen& chosen) const {
        constexpr std::size_t kEnough = std::size_t{1} << 16;
        const auto count = static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), true));
        const std::size_t stride = count / kEnough + 1;
        std::vector<Piece> some;
        std::size_t left = 0;
        pieces_.for_each(
            [&](std::size_t i) {
                if (!chosen[i] || left-- > 0) return false;
                left = stride - 1;
                return true;
            },
            [&](std::size_t, const Piece& piece) { some.push_back(piece); });
        return some;
    }

    /// The median of the pieces' middles, each coordinate by itself. A piece counts by its size to minus this power: 0
    /// is all alike; 4 lets even a box of 12 triangles count more than a sky of thousands of large ones.
    Vec3d median(const std::vector<Piece>& among, int power) const {
        const double least = 1e-6 * box_.diagonal();
        std::array<std::vector<std::pair<double, double>>, 3> places;  // coordinate and weight
        for (const Piece& piece : among) {
            const double weight = std::pow(std::max(piece.box.diagonal(), least), -power);
            const auto at = numbers(piece.box.middle());
            for (std::size_t axis = 0; axis < 3; ++axis) places[axis].emplace_back(at[axis], weight);
        }
        const auto median_of = [](std::vector<std::pair<double, double>>& list) {
            std::sort(list.begin(), list.end());
            double all = 0, below = 0;
            for (const auto& [at, weight] : list) all += weight;
            for (const auto& [at, weight] : list)
                if ((below += weight) >= 0.5 * all) return at;
            return 0.0;
        };
        return {median_of(places[0]), median_of(places[1]), median_of(places[2])};
    }

    std::vector<Vec3d> possible_middles(const Chosen& among, const std::vector<Piece>& some) const {
        const Vec3d middle = box_.middle();
        const std::array<Vec3d, 3> seek = {middle, {middle.x, box_.low.y, middle.z}, {middle.x, middle.y, box_.low.z}};
        std::array<double, 3> least;
        least.fill(std::numeric_limits<double>::infinity());
        std::array<Vec3d, 3> nearest = seek;
        for_chosen(among, [&](std::size_t, const Piece& piece) {
            for (std::size_t k = 0; k < seek.size(); ++k) {
                const Vec3d off = piece.box.nearest(seek[k]) - seek[k];
                if (dot(off, off) < least[k]) least[k] = dot(off, off), nearest[k] = piece.box.middle();
            }
        });
        return {median(some, 0), median(some, 4), nearest[0], nearest[1], nearest[2]};
    }

    /// Radii in steps of the fourth root of two: eight times is twelve of them.
    static constexpr int kSteps = 128, kGapSteps = 12;
    static int step_of(double radius, double largest) {
        const double steps = 4 * std::log2(radius / largest) + kSteps - 1;
        return steps > 0 ? std::min(static_cast<int>(steps), kSteps - 1) : 0;
    }
    static double farthest(const BoundingBox& box, Vec3d p) {
        return length(Vec3d{std::max(p.x - box.low.x, box.high.x - p.x), std::max(p.y - box.low.y, box.high.y - p.y),
                            std::max(p.z - box.low.z, box.high.z - p.z)});
    }

    /// Which radii about a centre a piece touches.
    struct Rings {
        Vec3d centre;
        double largest;  ///< radius
        std::array<int, kSteps + 1> change{};

        int first(const Piece& p) const { return step_of(length(p.box.nearest(centre) - centre), largest); }
        int last(const Piece& p) const { return step_of(farthest(p.box, centre), largest); }
        void add(const Piece& p) {
            ++change[static_cast<std::size_t>(first(p))];
            --change[static_cast<std::size_t>(last(p)) + 1];
        }
        /// The last steps that lie within a gap, the outermost gap first.
        std::vector<int> gaps() const {
            std::vector<int> found;
            int last_touched = -1;
            for (int i = 0, count = 0; i < kSteps; ++i) {
                count += change[static_cast<std::size_t>(i)];
                if (count == 0) continue;
                if (last_touched >= 0 && i - last_touched > kGapSteps) found.insert(found.begin(), last_touched);
                last_touched = i;
            }
            return found;
        }
    };

    /// What lies within a gap that parts surroundings off; nothing where there is none.
    Chosen within_a_gap(const Chosen& among) const {
        const std::vector<Piece> some = some_of(among);
        for (const Vec3d& centre : possible_middles(among, some)) {
            // Where some of the pieces leave no gap, all of them leave none.
            Rings few{centre, 2 * box_.diagonal(), {}}, all = few;
            for (const Piece& piece : some) few.add(piece);
            if (few.gaps().empty()) continue;
            for_chosen(among, [&](std::size_t, const Piece& piece) { all.add(piece); });
            for (const int gap : all.gaps()) {
                Chosen within(among.size(), false);
                for_chosen(among, [&](std::size_t i, const Piece& piece) { within[i] = all.last(piece) <= gap; });
                if (is_background(among, within, centre)) return within;
            }
        }
        return Chosen(among.size(), false);
    }

    bool is_background(const Chosen& among, const Chosen& within, Vec3d centre) const {
        double all = 0, beyond = 0, area = 0, area_beyond = 0;
        std::bitset<kDirections> seen;
        for_chosen(among, [&](std::size_t i, const Piece& piece) {
            const Vec3d s = piece.box.size();
            // Of an instance half of its box's surface, as of a solid thing seen from one side.
            const double own = piece.area == Vec3d{} ? s.x * s.y + s.y * s.z + s.z * s.x : length(piece.area);
            const double count = piece.area == Vec3d{} ? kLeastSubject : 1;
            all += count;
            area += own;
            if (within[i]) return;
            beyond += count;
            area_beyond += own;
            seen.set(direction_of(piece.box.middle() - centre));
            for (int corner = 0; corner < 8; ++corner) seen.set(direction_of(piece.box.corner(corner) - centre));
        });
        if (all - beyond < kLeastSubject) return false;
        return static_cast<double>(seen.count()) >= kSeenAround * kDirections ||
               (beyond <= kLittle * all && area_beyond <= kLittle * area);
    }

    /// Cells of a cube about the centre, four by four on each face.
    static constexpr std::size_t kDirections = 96;
    static std::size_t direction_of(Vec3d d) {
        const std::array<double, 3> v = numbers(d);
        std::size_t axis = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if (std::fabs(v[i]) > std::fabs(v[axis])) axis = i;
        if (v[axis] == 0) return 0;
        const auto cell = [&](double other) {
            return std::min<std::size_t>(3, static_cast<std::size_t>(2 * (other / std::fabs(v[axis]) + 1)));
        };
        const std::size_t face = 2 * axis + (v[axis] > 0 ? 1 : 0);
        return 16 * face + 4 * cell(v[(axis + 1) % 3]) + cell(v[(axis + 2) % 3]);
    }

    ScenePieces pieces_;
    Chosen kept_;
    BoundingBox box_;
};

}  // namespace REALCAM_NAMESPACE
