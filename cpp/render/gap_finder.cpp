#include "gap_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rings.hpp"

namespace realcam {

ChosenPieces GapFinder::within(const ChosenPieces& among) const {
    const std::vector<Piece> some = some_of(among);
    for (const Vec3d& centre : possible_middles(among, some)) {
        // Where some of the pieces leave no gap, all of them leave none.
        Rings few(centre, 2 * box_.diagonal()), all = few;
        for (const Piece& piece : some) few.add(piece);
        if (few.gaps().empty()) continue;
        pieces_.for_chosen(among, [&](std::size_t, const Piece& piece) { all.add(piece); });
        for (const int gap : all.gaps()) {
            ChosenPieces inside(among.size(), false);
            pieces_.for_chosen(among, [&](std::size_t i, const Piece& piece) { inside[i] = all.last(piece) <= gap; });
            if (is_background(among, inside, centre)) return inside;
        }
    }
    return ChosenPieces(among.size(), false);
}

std::vector<Piece> GapFinder::some_of(const ChosenPieces& chosen) const {
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

Vec3d GapFinder::median(const std::vector<Piece>& among, int power) const {
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

std::vector<Vec3d> GapFinder::possible_middles(const ChosenPieces& among, const std::vector<Piece>& some) const {
    const Vec3d middle = box_.middle();
    const std::array<Vec3d, 3> seek = {middle, {middle.x, box_.low.y, middle.z}, {middle.x, middle.y, box_.low.z}};
    std::array<double, 3> least;
    least.fill(std::numeric_limits<double>::infinity());
    std::array<Vec3d, 3> nearest = seek;
    pieces_.for_chosen(among, [&](std::size_t, const Piece& piece) {
        for (std::size_t k = 0; k < seek.size(); ++k) {
            const Vec3d off = piece.box.nearest(seek[k]) - seek[k];
            if (dot(off, off) < least[k]) least[k] = dot(off, off), nearest[k] = piece.box.middle();
        }
    });
    return {median(some, 0), median(some, 4), nearest[0], nearest[1], nearest[2]};
}

bool GapFinder::is_background(const ChosenPieces& among, const ChosenPieces& inside, Vec3d centre) const {
    double all = 0, beyond = 0, area = 0, area_beyond = 0;
    std::bitset<kDirections> seen;
    pieces_.for_chosen(among, [&](std::size_t i, const Piece& piece) {
        const Vec3d s = piece.box.size();
        // An instance counts with half of its box's surface, like a solid thing seen from one side.
        const double own = piece.area == Vec3d{} ? s.x * s.y + s.y * s.z + s.z * s.x : length(piece.area);
        const double count = piece.area == Vec3d{} ? kLeastSubject : 1;
        all += count;
        area += own;
        if (inside[i]) return;
        beyond += count;
        area_beyond += own;
        seen.set(direction_of(piece.box.middle() - centre));
        for (int corner = 0; corner < 8; ++corner) seen.set(direction_of(piece.box.corner(corner) - centre));
    });
    if (all - beyond < kLeastSubject) return false;
    return static_cast<double>(seen.count()) >= kSeenAround * kDirections ||
           (beyond <= kLittle * all && area_beyond <= kLittle * area);
}

std::size_t GapFinder::direction_of(Vec3d d) {
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

}  // namespace realcam
