#include "pupil_outline_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace realcam {

std::vector<PupilOutline> OutlineSearch::find(const PupilLens& lens, const std::vector<OutlineLook>& looks) {
    std::vector<PupilOutline> outlines(looks.size());
    Spokes all(looks.size() * kSpokes);
    std::iota(all.begin(), all.end(), 0);
    scan_all(lens, looks, all, outlines);
    return outlines;
}

std::vector<PupilOutline> OutlineSearch::find_near(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                                   const std::vector<PupilOutline>& expected, double tolerance) {
    std::vector<PupilOutline> outlines(looks.size());
    Spokes left(looks.size() * kSpokes);
    std::iota(left.begin(), left.end(), 0);
    constexpr double kWidest = 0.2;  // beyond, a scan takes fewer rays
    for (const double reach : {tolerance, 8 * tolerance}) {
        if (reach > kWidest) break;
        const int count = static_cast<int>(left.size()), blocks = (count + kBlock - 1) / kBlock;
        const auto found = std::make_unique<bool[]>(static_cast<std::size_t>(blocks * kBlock));
        lens.for_each(blocks, [&](int block) {
            const int first = block * kBlock;
            OutlineSearch part(looks, left.data() + first, std::min(kBlock, count - first));
            part.narrow(lens, expected, reach, found.get() + first);
            part.write(found.get() + first, outlines);
        });
        Spokes lost;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (!found[i]) lost.push_back(left[i]);
        left = std::move(lost);
    }
    scan_all(lens, looks, left, outlines);
    return outlines;
}

void OutlineSearch::scan_all(const PupilLens& lens, const std::vector<OutlineLook>& looks, const Spokes& spokes,
                             std::vector<PupilOutline>& outlines) {
    const int count = static_cast<int>(spokes.size());
    lens.for_each((count + kBlock - 1) / kBlock, [&](int block) {
        const int first = block * kBlock;
        OutlineSearch part(looks, spokes.data() + first, std::min(kBlock, count - first));
        part.scan(lens);
        part.write(nullptr, outlines);
    });
}

OutlineSearch::OutlineSearch(const std::vector<OutlineLook>& looks, const int* spokes, int count)
    : spokes_(spokes), count_(count) {
    for (int i = 0; i < kBlock; ++i) {
        const int spoke = spokes[std::min(i, count - 1)];
        const OutlineLook& look = looks[static_cast<std::size_t>(spoke / kSpokes)];
        const PupilDirection unit = PupilOutline::direction(spoke % kSpokes);
        rays_.set(i, look.film, look.centre);
        centre_[i] = look.centre;
        unit_[i] = {look.half_width * unit.l, look.half_height * unit.m};
    }
}

void OutlineSearch::scan(const PupilLens& lens) {
    int first[kBlock], last[kBlock];
    std::fill(first, first + kBlock, -1);
    std::fill(last, last + kBlock, -1);
    for (int step = 0; step < kSteps; ++step) {
        std::fill(reach_, reach_ + kBlock, kReach * step / kSteps);
        trace(lens);
        for (int i = 0; i < kBlock; ++i) {
            if (!passes_[i]) continue;
            if (first[i] < 0) first[i] = step;
            last[i] = step;
        }
    }
    const auto at = [](int step) { return kReach * step / kSteps; };
    double open[kBlock];
    for (int i = 0; i < kBlock; ++i) {
        open[i] = at(std::max(last[i], 0));
        outer_[i] = at(last[i] + 1);
    }
    halve(lens, kHalvings, open, outer_);
    std::fill(inner_, inner_ + kBlock, 0.0);
    if (std::none_of(first, first + kBlock, [](int step) { return step > 0; })) return;
    for (int i = 0; i < kBlock; ++i) {
        open[i] = at(std::max(first[i], 0));
        inner_[i] = at(std::max(first[i] - 1, 0));
    }
    halve(lens, kHalvings, open, inner_);
}

void OutlineSearch::narrow(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance,
                           bool* found) {
    double open[kBlock], hole_open[kBlock], hole_shut[kBlock];
    for (int i = 0; i < kBlock; ++i) {
        const int spoke = spokes_[std::min(i, count_ - 1)];
        const PupilOutline& near = expected[static_cast<std::size_t>(spoke / kSpokes)];
        const double outer = near.outer[spoke % kSpokes], inner = near.inner[spoke % kSpokes];
        open[i] = std::max(0.0, outer - tolerance);
        outer_[i] = outer + tolerance;
        hole_open[i] = inner > 0 ? inner + tolerance : 0;
        hole_shut[i] = inner > 0 ? std::max(0.0, inner - tolerance) : 0;
        found[i] = outer > 0;
    }
    const int halvings = static_cast<int>(std::lround(std::log2(2 * tolerance / kPrecision)));
    test(lens, open, outer_, found);
    halve(lens, halvings, open, outer_);
    std::copy(hole_shut, hole_shut + kBlock, inner_);
    if (std::all_of(hole_open, hole_open + kBlock, [](double reach) { return reach == 0; })) return;
    test(lens, hole_open, hole_shut, found);
    halve(lens, halvings, hole_open, inner_);
}

void OutlineSearch::test(const PupilLens& lens, const double (&open)[kBlock], const double (&shut)[kBlock],
                         bool* found) {
    for (int i = 0; i < kBlock; ++i) reach_[i] = open[i];
    trace(lens);
    for (int i = 0; i < kBlock; ++i) found[i] &= passes_[i] || open[i] == shut[i];
    for (int i = 0; i < kBlock; ++i) reach_[i] = shut[i];
    trace(lens);
    for (int i = 0; i < kBlock; ++i) found[i] &= !passes_[i] || open[i] == shut[i];
}

void OutlineSearch::halve(const PupilLens& lens, int halvings, double (&open)[kBlock], double (&shut)[kBlock]) {
    for (int halving = 0; halving < halvings; ++halving) {
        for (int i = 0; i < kBlock; ++i) reach_[i] = 0.5 * (open[i] + shut[i]);
        trace(lens);
        for (int i = 0; i < kBlock; ++i) (passes_[i] ? open : shut)[i] = reach_[i];
    }
}

void OutlineSearch::trace(const PupilLens& lens) {
    REALCAM_LANES
    for (int i = 0; i < kBlock; ++i) {
        rays_.l[i] = centre_[i].l + reach_[i] * unit_[i].l;
        rays_.m[i] = centre_[i].m + reach_[i] * unit_[i].m;
    }
    lens.trace(rays_, passes_);
}

void OutlineSearch::write(const bool* found, std::vector<PupilOutline>& outlines) const {
    for (int i = 0; i < count_; ++i) {
        if (found && !found[i]) continue;
        PupilOutline& outline = outlines[static_cast<std::size_t>(spokes_[i] / kSpokes)];
        outline.outer[spokes_[i] % kSpokes] = outer_[i];
        outline.inner[spokes_[i] % kSpokes] = inner_[i];
    }
}

}  // namespace realcam
