#include "pupil_outline_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>

namespace realcam {

PupilDirection OutlineLook::unit(int azimuth) const {
    const PupilDirection d = PupilOutline::direction(azimuth);
    const double l = half_width * d.l, m = half_height * d.m;
    return {l * cos - m * sin, l * sin + m * cos};
}

PupilDirection OutlineLook::direction(int azimuth, double reach) const {
    const OutlineLook scaled = {film, centre, reach * half_width, reach * half_height, cos, sin};
    const PupilDirection d = scaled.unit(azimuth);
    return {centre.l + d.l, centre.m + d.m};
}

std::vector<PupilOutline> OutlineSearch::find(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                              OutlineScan scan) {
    std::vector<PupilOutline> outlines(looks.size());
    scan_all(lens, looks, scan_lines_of(looks), scan, outlines);
    return outlines;
}

std::vector<PupilOutline> OutlineSearch::find_near(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                                   const std::vector<PupilOutline>& expected, double tolerance) {
    std::vector<PupilOutline> outlines(looks.size());
    ScanLines left = scan_lines_of(looks);
    constexpr double kWidest = 0.2;  // for larger tolerances a scan takes fewer rays
    for (const double reach : {tolerance, 8 * tolerance}) {
        if (reach > kWidest) break;
        const auto found = std::make_unique<bool[]>(left.size());
        for_each_group(lens, looks, left, [&](OutlineSearch& group, std::size_t first) {
            group.narrow(lens, expected, reach, found.get() + first);
            group.write(found.get() + first, outlines);
        });
        ScanLines lost;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (!found[i]) lost.push_back(left[i]);
        left = std::move(lost);
    }
    scan_all(lens, looks, left, {}, outlines);
    return outlines;
}

OutlineSearch::ScanLines OutlineSearch::scan_lines_of(const std::vector<OutlineLook>& looks) {
    ScanLines scan_lines(looks.size() * kScanLines);
    std::iota(scan_lines.begin(), scan_lines.end(), 0);
    return scan_lines;
}

void OutlineSearch::scan_all(const PupilLens& lens, const std::vector<OutlineLook>& looks, const ScanLines& scan_lines,
                             OutlineScan scan, std::vector<PupilOutline>& outlines) {
    for_each_group(lens, looks, scan_lines, [&](OutlineSearch& group, std::size_t) {
        group.scan(lens, scan);
        group.write(nullptr, outlines);
    });
}

template <class Task>
void OutlineSearch::for_each_group(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                   const ScanLines& scan_lines, Task&& task) {
    const std::size_t size = scan_lines.size() > kBlock ? kBlock : kSmallGroup,
                      count = (scan_lines.size() + size - 1) / size;
    lens.for_each(static_cast<int>(count), [&](int i) {
        const std::size_t first = static_cast<std::size_t>(i) * size;
        OutlineSearch group(looks, scan_lines.data() + first,
                            static_cast<int>(std::min(size, scan_lines.size() - first)));
        task(group, first);
    });
}

OutlineSearch::OutlineSearch(const std::vector<OutlineLook>& looks, const int* scan_lines, int count)
    : scan_lines_(scan_lines), count_(count) {
    for (int i = 0; i < count; ++i) {
        const OutlineLook& look = looks[static_cast<std::size_t>(scan_lines[i] / kScanLines)];
        film_[i] = look.film;
        centre_[i] = look.centre;
        unit_[i] = look.unit(scan_lines[i] % kScanLines);
    }
}

template <class Reach>
void OutlineSearch::trace(const PupilLens& lens, int reaches, Reach&& reach) {
    const int at_once = kBlock / count_;
    lens.for_each((reaches + at_once - 1) / at_once, [&](int block) {
        const int first = block * at_once, last = std::min(first + at_once, reaches);
        PupilRays rays;
        int lane = 0;
        for (int k = first; k < last; ++k)
            for (int i = 0; i < count_; ++i) {
                const double r = reach(i, k);
                rays.set(lane++, film_[i], {centre_[i].l + r * unit_[i].l, centre_[i].m + r * unit_[i].m});
            }
        for (int i = lane; i < kBlock; ++i) rays.set(i, film_[0], centre_[0]);
        bool passes[kBlock];
        lens.trace(rays, passes);
        std::copy(passes, passes + lane, passes_ + first * count_);
    });
}

void OutlineSearch::scan(const PupilLens& lens, OutlineScan scan) {
    const auto at = [&](int step) { return kReach * step / scan.steps; };
    trace(lens, scan.steps, [&](int, int step) { return at(step); });
    int first[kBlock], last[kBlock];
    std::fill(first, first + kBlock, -1);
    std::fill(last, last + kBlock, -1);
    for (int step = 0; step < scan.steps; ++step)
        for (int i = 0; i < count_; ++i) {
            if (!passes(i, step)) continue;
            if (first[i] < 0) first[i] = step;
            last[i] = step;
        }
    double open[kBlock];
    for (int i = 0; i < count_; ++i) {
        open[i] = at(std::max(last[i], 0));
        outer_[i] = at(last[i] + 1);
    }
    halve(lens, scan.halvings, open, outer_);
    std::fill(inner_, inner_ + count_, 0.0);
    if (std::none_of(first, first + count_, [](int step) { return step > 0; })) return;
    for (int i = 0; i < count_; ++i) {
        open[i] = at(std::max(first[i], 0));
        inner_[i] = at(std::max(first[i] - 1, 0));
    }
    halve(lens, scan.halvings, open, inner_);
}

void OutlineSearch::narrow(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance,
                           bool* found) {
    double open[kBlock], hole_open[kBlock], hole_shut[kBlock];
    for (int i = 0; i < count_; ++i) {
        const PupilOutline& near = expected[static_cast<std::size_t>(scan_lines_[i] / kScanLines)];
        const double outer = near.outer[scan_lines_[i] % kScanLines], inner = near.inner[scan_lines_[i] % kScanLines];
        open[i] = std::max(0.0, outer - tolerance);
        outer_[i] = outer + tolerance;
        hole_open[i] = inner > 0 ? inner + tolerance : 0;
        hole_shut[i] = inner > 0 ? std::max(0.0, inner - tolerance) : 0;
        found[i] = outer > 0;
    }
    const int halvings = static_cast<int>(std::lround(std::log2(2 * tolerance / kPrecision)));
    test(lens, open, outer_, found);
    halve(lens, halvings, open, outer_);
    std::copy(hole_shut, hole_shut + count_, inner_);
    if (std::all_of(hole_open, hole_open + count_, [](double reach) { return reach == 0; })) return;
    test(lens, hole_open, hole_shut, found);
    halve(lens, halvings, hole_open, inner_);
}

void OutlineSearch::test(const PupilLens& lens, const double (&open)[kBlock], const double (&shut)[kBlock],
                         bool* found) {
    trace(lens, 2, [&](int i, int end) { return end == 0 ? open[i] : shut[i]; });
    for (int i = 0; i < count_; ++i) found[i] &= (passes(i, 0) && !passes(i, 1)) || open[i] == shut[i];
}

void OutlineSearch::halve(const PupilLens& lens, int halvings, double (&open)[kBlock], double (&shut)[kBlock]) {
    // If a block has room for several rays of each scan line, it traces all points that the next bisections may need.
    const int most_at_once = std::bit_width(static_cast<unsigned>(kBlock / count_ + 1)) - 1;
    while (halvings > 0) {
        const int at_once = std::min(halvings, most_at_once), parts = 1 << at_once;
        const auto at = [&](int i, int part) { return open[i] + (shut[i] - open[i]) * part / parts; };
        trace(lens, parts - 1, [&](int i, int ray) { return at(i, ray + 1); });
        for (int i = 0; i < count_; ++i) {
            int lit = 0;
            for (int step = parts / 2; step > 0; step /= 2)
                if (passes(i, lit + step - 1)) lit += step;
            const double new_open = at(i, lit);
            shut[i] = at(i, lit + 1);
            open[i] = new_open;
        }
        halvings -= at_once;
    }
}

void OutlineSearch::write(const bool* found, std::vector<PupilOutline>& outlines) const {
    for (int i = 0; i < count_; ++i) {
        if (found && !found[i]) continue;
        PupilOutline& outline = outlines[static_cast<std::size_t>(scan_lines_[i] / kScanLines)];
        outline.outer[scan_lines_[i] % kScanLines] = outer_[i];
        outline.inner[scan_lines_[i] % kScanLines] = inner_[i];
    }
}

}  // namespace realcam
