#include "pupil_outline_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>

namespace realcam {

PupilDirection OutlineRequest::unit(int azimuth) const {
    const PupilDirection d = PupilOutline::direction(azimuth);
    const double l = half_width * d.l, m = half_height * d.m;
    return {l * cos - m * sin, l * sin + m * cos};
}

PupilDirection OutlineRequest::direction(int azimuth, double radius) const {
    const OutlineRequest scaled = {film, centre, radius * half_width, radius * half_height, cos, sin};
    const PupilDirection d = scaled.unit(azimuth);
    return {centre.l + d.l, centre.m + d.m};
}

std::vector<PupilOutline> OutlineSearch::find(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                                              OutlineScan scan) {
    std::vector<PupilOutline> outlines(requests.size());
    scan_all(lens, requests, scan_lines_of(requests), scan, outlines);
    return outlines;
}

std::vector<PupilOutline> OutlineSearch::find_near(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                                                   const std::vector<PupilOutline>& expected, double tolerance) {
    std::vector<PupilOutline> outlines(requests.size());
    ScanLines remaining = scan_lines_of(requests);
    constexpr double kMaxTolerance = 0.2;  // beyond it, a scan takes fewer rays
    for (const double distance : {tolerance, 8 * tolerance}) {
        if (distance > kMaxTolerance) break;
        const auto found = std::make_unique<bool[]>(remaining.size());
        for_each_group(lens, requests, remaining, [&](OutlineSearch& group, std::size_t first) {
            group.bisect_near(lens, expected, distance, found.get() + first);
            group.store(found.get() + first, outlines);
        });
        ScanLines not_found;
        for (std::size_t i = 0; i < remaining.size(); ++i)
            if (!found[i]) not_found.push_back(remaining[i]);
        remaining = std::move(not_found);
    }
    scan_all(lens, requests, remaining, {}, outlines);
    return outlines;
}

OutlineSearch::ScanLines OutlineSearch::scan_lines_of(const std::vector<OutlineRequest>& requests) {
    ScanLines scan_lines(requests.size() * kScanLines);
    std::iota(scan_lines.begin(), scan_lines.end(), 0);
    return scan_lines;
}

void OutlineSearch::scan_all(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                             const ScanLines& scan_lines, OutlineScan scan, std::vector<PupilOutline>& outlines) {
    for_each_group(lens, requests, scan_lines, [&](OutlineSearch& group, std::size_t) {
        group.scan(lens, scan);
        group.store(nullptr, outlines);
    });
}

template <class Task>
void OutlineSearch::for_each_group(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                                   const ScanLines& scan_lines, Task&& task) {
    const std::size_t size = scan_lines.size() > kBlock ? kBlock : kSmallGroup,
                      count = (scan_lines.size() + size - 1) / size;
    lens.for_each(static_cast<int>(count), [&](int i) {
        const std::size_t first = static_cast<std::size_t>(i) * size;
        OutlineSearch group(requests, scan_lines.data() + first,
                            static_cast<int>(std::min(size, scan_lines.size() - first)));
        task(group, first);
    });
}

OutlineSearch::OutlineSearch(const std::vector<OutlineRequest>& requests, const int* scan_lines, int count)
    : scan_lines_(scan_lines), count_(count) {
    for (int i = 0; i < count; ++i) {
        const OutlineRequest& request = requests[static_cast<std::size_t>(scan_lines[i] / kScanLines)];
        film_[i] = request.film;
        centre_[i] = request.centre;
        unit_[i] = request.unit(scan_lines[i] % kScanLines);
    }
}

template <class Radius>
void OutlineSearch::trace(const PupilLens& lens, int radii, Radius&& radius) {
    const int per_block = kBlock / count_;
    lens.for_each((radii + per_block - 1) / per_block, [&](int block) {
        const int first = block * per_block, last = std::min(first + per_block, radii);
        PupilRays rays;
        int lane = 0;
        for (int k = first; k < last; ++k)
            for (int i = 0; i < count_; ++i) {
                const double r = radius(i, k);
                rays.set(lane++, film_[i], {centre_[i].l + r * unit_[i].l, centre_[i].m + r * unit_[i].m});
            }
        for (int i = lane; i < kBlock; ++i) rays.set(i, film_[0], centre_[0]);
        bool passes[kBlock];
        lens.trace(rays, passes);
        std::copy(passes, passes + lane, passes_ + first * count_);
    });
}

void OutlineSearch::scan(const PupilLens& lens, OutlineScan scan) {
    const auto at = [&](int step) { return kMaxRadius * step / scan.steps; };
    trace(lens, scan.steps, [&](int, int step) { return at(step); });
    int first[kBlock], last[kBlock];
    std::fill(first, first + kBlock, -1);  // -1: no light on the scan line, whose radii then become 0
    std::fill(last, last + kBlock, -1);
    for (int step = 0; step < scan.steps; ++step)
        for (int i = 0; i < count_; ++i) {
            if (!passes(i, step)) continue;
            if (first[i] < 0) first[i] = step;
            last[i] = step;
        }
    double lit[kBlock];
    for (int i = 0; i < count_; ++i) {
        lit[i] = at(std::max(last[i], 0));
        outer_[i] = at(last[i] + 1);
    }
    bisect(lens, scan.bisections, lit, outer_);
    std::fill(inner_, inner_ + count_, 0.0);
    if (std::none_of(first, first + count_, [](int step) { return step > 0; })) return;
    for (int i = 0; i < count_; ++i) {
        lit[i] = at(std::max(first[i], 0));
        inner_[i] = at(std::max(first[i] - 1, 0));
    }
    bisect(lens, scan.bisections, lit, inner_);
}

void OutlineSearch::bisect_near(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance,
                                bool* found) {
    double lit[kBlock], hole_lit[kBlock], hole_dark[kBlock];
    for (int i = 0; i < count_; ++i) {
        const PupilOutline& near = expected[static_cast<std::size_t>(scan_lines_[i] / kScanLines)];
        const double outer = near.outer[scan_lines_[i] % kScanLines], inner = near.inner[scan_lines_[i] % kScanLines];
        lit[i] = std::max(0.0, outer - tolerance);
        outer_[i] = outer + tolerance;
        hole_lit[i] = inner > 0 ? inner + tolerance : 0;
        hole_dark[i] = inner > 0 ? std::max(0.0, inner - tolerance) : 0;
        found[i] = outer > 0;
    }
    const int bisections = static_cast<int>(std::lround(std::log2(2 * tolerance / kPrecision)));
    check_intervals(lens, lit, outer_, found);
    bisect(lens, bisections, lit, outer_);
    std::copy(hole_dark, hole_dark + count_, inner_);
    if (std::all_of(hole_lit, hole_lit + count_, [](double radius) { return radius == 0; })) return;
    check_intervals(lens, hole_lit, hole_dark, found);
    bisect(lens, bisections, hole_lit, inner_);
}

void OutlineSearch::check_intervals(const PupilLens& lens, const double (&lit)[kBlock], const double (&dark)[kBlock],
                                    bool* found) {
    trace(lens, 2, [&](int i, int end) { return end == 0 ? lit[i] : dark[i]; });
    for (int i = 0; i < count_; ++i) found[i] &= (passes(i, 0) && !passes(i, 1)) || lit[i] == dark[i];
}

void OutlineSearch::bisect(const PupilLens& lens, int bisections, double (&lit)[kBlock], double (&dark)[kBlock]) {
    // If a block has room for several rays of each scan line, it traces all points that the next bisections may need.
    const int max_at_once = std::bit_width(static_cast<unsigned>(kBlock / count_ + 1)) - 1;
    while (bisections > 0) {
        const int at_once = std::min(bisections, max_at_once), parts = 1 << at_once;
        const auto at = [&](int i, int part) { return lit[i] + (dark[i] - lit[i]) * part / parts; };
        trace(lens, parts - 1, [&](int i, int ray) { return at(i, ray + 1); });
        for (int i = 0; i < count_; ++i) {
            int lit_parts = 0;
            for (int step = parts / 2; step > 0; step /= 2)
                if (passes(i, lit_parts + step - 1)) lit_parts += step;
            const double new_lit = at(i, lit_parts);
            dark[i] = at(i, lit_parts + 1);
            lit[i] = new_lit;
        }
        bisections -= at_once;
    }
}

void OutlineSearch::store(const bool* found, std::vector<PupilOutline>& outlines) const {
    for (int i = 0; i < count_; ++i) {
        if (found && !found[i]) continue;
        PupilOutline& outline = outlines[static_cast<std::size_t>(scan_lines_[i] / kScanLines)];
        outline.outer[scan_lines_[i] % kScanLines] = outer_[i];
        outline.inner[scan_lines_[i] % kScanLines] = inner_[i];
    }
}

}  // namespace realcam
