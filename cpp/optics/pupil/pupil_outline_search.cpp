#include "pupil_outline_search.hpp"

#include <algorithm>

namespace realcam {

std::vector<PupilOutline> OutlineSearch::find(const PupilLens& lens, const std::vector<OutlineLook>& looks) {
    std::vector<PupilOutline> outlines(looks.size());
    const int spokes = static_cast<int>(looks.size()) * kSpokes;
    lens.for_each((spokes + kBlock - 1) / kBlock, [&](int block) {
        OutlineSearch part(looks, block * kBlock, std::min(kBlock, spokes - block * kBlock));
        part.scan(lens);
        part.write(outlines);
    });
    return outlines;
}

OutlineSearch::OutlineSearch(const std::vector<OutlineLook>& looks, int first, int count)
    : first_(first), count_(count) {
    for (int i = 0; i < kBlock; ++i) {
        const int spoke = first + std::min(i, count - 1);
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
    halve(lens, open, outer_);
    std::fill(inner_, inner_ + kBlock, 0.0);
    if (std::none_of(first, first + kBlock, [](int step) { return step > 0; })) return;
    for (int i = 0; i < kBlock; ++i) {
        open[i] = at(std::max(first[i], 0));
        inner_[i] = at(std::max(first[i] - 1, 0));
    }
    halve(lens, open, inner_);
}

void OutlineSearch::halve(const PupilLens& lens, double (&open)[kBlock], double (&shut)[kBlock]) {
    for (int halving = 0; halving < kHalvings; ++halving) {
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

void OutlineSearch::write(std::vector<PupilOutline>& outlines) const {
    for (int i = 0; i < count_; ++i) {
        PupilOutline& outline = outlines[static_cast<std::size_t>((first_ + i) / kSpokes)];
        outline.outer[(first_ + i) % kSpokes] = outer_[i];
        outline.inner[(first_ + i) % kSpokes] = inner_[i];
    }
}

}  // namespace realcam
