// Diffraction tables: the light of apertures against closed forms, and samples drawn from the tables.

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "camera/effects/diffraction/diffraction_tables.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "math/random.hpp"
#include "measurement.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kPi = std::numbers::pi;

/// A regular polygon or, with 0 corners, a circle, of radius 0.1, as the search for edges finds it: along scan lines,
/// which rarely hit a corner.
std::vector<Vec2<double>> outline(int corners, double radius = 0.1) {
    std::vector<Vec2<double>> points;
    for (int scan_line = 0; scan_line < kPupilEdgeCorners; ++scan_line) {
        const double angle = 2 * kPi * scan_line / kPupilEdgeCorners, side = 2 * kPi / std::max(corners, 1);
        const double r =
            corners == 0 ? radius : radius * std::cos(kPi / corners) / std::cos(std::remainder(angle, side));
        points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return points;
}

PupilEdges ring(double inner) {
    const std::vector<Vec2<double>> hole = outline(0, 0.1 * inner);
    return {outline(0), {hole.rbegin(), hole.rend()}};
}

/// Share of a circular aperture's light within a frequency in periods over its diameter (Born and Wolf, 8.5.2).
double airy_share(double f) {
    return 1 - std::pow(std::cyl_bessel_j(0, kPi * f), 2) - std::pow(std::cyl_bessel_j(1, kPi * f), 2);
}

/// Share of the light in the cells within the first `rings` rings.
double share_within(const ApertureDiffraction& of, int rings) {
    double sum = 0;
    for (int cell = 0; cell < rings * kDiffractionAzimuths; ++cell) sum += of.cells[static_cast<std::size_t>(cell)];
    return sum;
}

/// Plane in front and a hyperboloid behind: it brings light along the axis to one point.
LensSystem perfect_lens(double focal_length, double f_number) {
    const double n = 1.6, radius = 0.5 * focal_length / f_number;
    Surface back = refracting(-(n - 1) * focal_length, 0, Glass::air(), 1.2 * radius);
    back.conic = -n * n;
    LensSystem lens =
        lens_of({stop_plane(0, radius), refracting(0, 0.2 * focal_length, Glass::constant(n), 1.2 * radius), back});
    lens.film_distance = focal_length;
    return lens;
}

/// On the axis of a lens.
struct Kicks {
    explicit Kicks(const LensSystem& lens) : tables(lens, 1.0, PupilTracer{}) {}

    Vec2f frequency(std::uint32_t i) const {
        const DiffractionView view = tables.view(1);
        const Vec2f kick = draw_kick(view, {0, 0}, sample_2d(7, i, 0), sample_2d(7, i, 1)).mm_per_nm;
        const float scale = 1 / view.nodes[0].mm_per_nm;
        return {scale * kick.x, scale * kick.y};
    }

    DiffractionTables tables;
};

}  // namespace

TEST_CASE("a circle's light within each ring is Airy's") {
    const ApertureDiffraction found = diffraction_of({outline(0)});
    double worst = 0;
    int darkest = 0;
    for (int rings = 1; rings <= kDiffractionUnmergedRings; ++rings) {
        worst = std::max(worst, std::fabs(share_within(found, rings) - airy_share(rings / 24.0)));
        const auto light = [&](int k) { return share_within(found, k + 1) - share_within(found, k); };
        if (rings < 40 && light(rings) < light(darkest)) darkest = rings;
    }
    // Light beyond the cells follows from stationary phase, which omits the oscillation of the rings: at the sixth
    // period, 2 / (pi^2 6) times 1 / (12 pi).
    hold({"Effects", "light of a circle within a ring, against Airy's", "60 rings", "core", "float64", worst, 1e-3,
          "of all"});
    CHECK(std::fabs((darkest + 0.5) / 24.0 - 1.2197) <= 0.5 / 24);
}

TEST_CASE("cells and edges together have all light") {
    // Parseval's theorem, except for the oscillation of the light beyond the cells, which stationary phase omits; it is
    // larger where two edges near each other interfere.
    double simple = std::fabs(diffraction_of({outline(0)}).found_share - 1), obstructed = 0;
    for (int corners = 5; corners <= 9; ++corners)
        simple = std::max(simple, std::fabs(diffraction_of({outline(corners)}).found_share - 1));
    for (const double inner : {0.3, 0.5, 0.6})
        obstructed = std::max(obstructed, std::fabs(diffraction_of(ring(inner)).found_share - 1));
    hold({"Effects", "light in the cells and beyond, before it is scaled", "a circle and 5 polygons", "core", "float64",
          simple, 0.002, "of all"});
    hold({"Effects", "the same, obstructed apertures", "3 rings", "core", "float64", obstructed, 0.01, "of all"});
}

TEST_CASE("draws have Airy's share in the first dark ring, and a perfect lens's contrast") {
    const Kicks kicks(perfect_lens(100, 8));
    constexpr std::uint32_t kCount = 1 << 20;
    constexpr int kFrequencies = 9;
    double inside = 0, contrast[kFrequencies] = {};
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vec2f f = kicks.frequency(i);
        inside += std::hypot(static_cast<double>(f.x), static_cast<double>(f.y)) < 1.21967;
        for (int k = 0; k < kFrequencies; ++k)
            contrast[k] += std::cos(2 * kPi * (k + 1) / 10.0 * static_cast<double>(f.y));
    }
    hold({"Effects", "light drawn within Airy's first dark ring, 83.78%", "1048576 draws", "core", "float32",
          std::fabs(inside / kCount - 0.83778), 0.003, "of all"});
    double worst = 0;
    for (int k = 0; k < kFrequencies; ++k) {
        const double nu = (k + 1) / 10.0;
        const double perfect = 2 / kPi * (std::acos(nu) - nu * std::sqrt(1 - nu * nu));
        worst = std::max(worst, std::fabs(contrast[k] / kCount - perfect));
    }
    // Noise is 0.0007; a cell of a 24th of a period takes sinc(nu / 24), and one of an 8th, further out, sinc(nu / 8).
    hold({"Effects", "contrast of a perfect lens from draws", "9 frequencies up to 0.9 of the limit", "core", "float32",
          worst, 0.006, "contrast"});
}

TEST_CASE("blades make as many spikes as they have normals") {
    const LensSystem round = io::read_lens("double-gauss-50mm");
    for (int blades = 5; blades <= 9; ++blades) {
        LensSystem lens = round;
        lens.iris = {blades, 0, 0.1};
        lens.stop_semi_diameter = 0.25 * lens.stop().clear_semi_diameter;
        const Kicks kicks(lens);
        const int spikes = blades % 2 == 0 ? blades : 2 * blades;
        int count = 0, on_spike = 0;
        for (std::uint32_t i = 0; i < 1 << 18; ++i) {
            const Vec2f f = kicks.frequency(i);
            const double length = std::hypot(static_cast<double>(f.x), static_cast<double>(f.y));
            if (length < 60) continue;
            ++count;
            const double angle = std::atan2(static_cast<double>(f.y), static_cast<double>(f.x)) - 0.1;
            // Half the light of a spike lies within 0.27 / L of its middle; here L is half the width or so.
            on_spike += std::fabs(std::remainder(angle, 2 * kPi / spikes)) * length < 3;
        }
        CAPTURE(blades);
        REQUIRE(count > 500);
        CHECK(on_spike > 0.85 * count);
    }
}

TEST_CASE("an obstructed aperture's first dark ring is narrower") {
    for (const double inner : {0.3, 0.5}) {
        const ApertureDiffraction found = diffraction_of(ring(inner));
        // At the dark ring the amplitudes of the circle and of its obstruction cancel.
        double low = 0.8, high = 1.2;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            const double left = std::cyl_bessel_j(1, kPi * middle) - inner * std::cyl_bessel_j(1, kPi * middle * inner);
            (left > 0 ? low : high) = middle;
        }
        int darkest = 12;
        const auto light = [&](int k) { return share_within(found, k + 1) - share_within(found, k); };
        for (int k = 12; k < 32; ++k)
            if (light(k) < light(darkest)) darkest = k;
        CAPTURE(inner);
        CHECK(std::fabs((darkest + 0.5) / 24.0 - low) <= 0.5 / 24 + 1e-3);
    }
}

TEST_CASE("edge draws have the light that all draws have beyond the cells") {
    const Kicks kicks(perfect_lens(100, 8));
    const DiffractionView view = kicks.tables.view(1);
    constexpr std::uint32_t kCount = 1 << 18;
    double all = 0, weighted = 0, beyond_all = 0, beyond_weighted = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vec2f u = sample_2d(7, i, 0), v = sample_2d(7, i, 1);
        const auto periods = [&](Vec2f mm_per_nm) {
            return std::hypot(static_cast<double>(mm_per_nm.x), static_cast<double>(mm_per_nm.y)) /
                   static_cast<double>(view.nodes[0].mm_per_nm);
        };
        const DiffractionKick kick = draw_kick(view, {0, 0}, u, v);
        all += kick.from_edge;
        beyond_all += kick.from_edge && periods(kick.mm_per_nm) > 20;
        const EdgeKick edge = draw_edge_kick(view, {0, 0}, 550, u, v);
        weighted += static_cast<double>(edge.weight);
        beyond_weighted += periods(edge.mm_per_nm) > 20 ? static_cast<double>(edge.weight) : 0.0;
    }
    // Noise of the two kinds of draws: sqrt(0.034 / 2^18) and sqrt(0.01 / 2^18). The remainder of the limit is for the
    // end of the film at 2 mm, 460 periods.
    hold({"Effects", "light beyond the cells, by two ways of drawing", "262144 draws of each", "core", "float32",
          std::max(std::fabs(all - weighted), std::fabs(beyond_all - beyond_weighted)) / kCount, 0.0012, "of all"});
}

TEST_CASE("draws from straight edges thin out to the margins of a film") {
    // One aperture of one straight edge across x, as long as the aperture is wide, which has all light.
    const std::vector<DiffractionEdge> edges(kDiffractionEdges, {0, 0, 1});
    const std::vector<AliasEntry> entries(kDiffractionEntries, {1, 0});
    const DiffractionNode node{1, 1};
    const DiffractionView view{&node, entries.data(), edges.data(), 1, 1, 0, 1e6f, 1};
    constexpr std::uint32_t kCount = 1 << 20;
    for (const double far : {10.0, 100.0, 1000.0}) {
        int kicks = 0;
        double edge_kicks = 0, largest = 0, largest_far = 0;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const Vec2f u = sample_2d(7, i, 0), v = sample_2d(7, i, 1);
            kicks += std::fabs(static_cast<double>(draw_kick(view, {0, 0}, u, v).mm_per_nm.y)) > far;
            const EdgeKick edge = draw_edge_kick(view, {0, 0}, 550, u, v);
            const auto weight = static_cast<double>(edge.weight);
            largest = std::max(largest, weight);
            if (std::fabs(static_cast<double>(edge.mm_per_nm.y)) < far) continue;
            edge_kicks += weight;
            largest_far = std::max(largest_far, weight);
        }
        // Integral of sinc^2 beyond `far`, with sin^2 replaced by its mean of 1/2. The tolerance is 3% for the fit, and
        // five times the noise of the count.
        const double wanted = kCount / (kPi * kPi * far), tolerance = 0.03 * wanted + 5 * std::sqrt(wanted);
        CAPTURE(far);
        CHECK(std::fabs(kicks - wanted) < tolerance);
        CHECK(std::fabs(edge_kicks - wanted) < tolerance);
        // No bright specks: where 1 / (pi^2 far) of the light goes, a draw carries at most the square root of that
        // share.
        CHECK(largest_far < 1.2 * largest / std::sqrt(kPi * kPi * far));
    }
}
