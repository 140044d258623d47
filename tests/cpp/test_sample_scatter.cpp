// The choice between the diffuse and the Phong lobe, and the directions and factors that come of it.

#include <cmath>
#include <vector>

#include "../../cpp/scene/shade.hpp"
#include "chi_square.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kSamples = 1 << 18;

struct Surface {
    float diffuse, specular, shininess, view_degrees;
};

const Surface kSurfaces[] = {{0.7f, 0, 0, 30},       {0, 0.9f, 0, 0},          {0, 0.9f, 0, 60},
                             {0, 0.9f, 20, 45},      {0, 0.5f, 1e4f, 70},      {0.3f, 0.5f, 5, 45},
                             {0.3f, 0.5f, 1e4f, 20}, {0.999f, 1e-3f, 100, 10}, {1e-6f, 0.9f, 50, 80},
                             {0.45f, 0.45f, 0, 85}};

// On the plane y = 0, seen from x < 0 above it; the shading normal leans a little.
SurfacePoint point_of(const Surface& s) {
    SurfacePoint point{};
    point.geometric_normal = {0, 1, 0};
    point.normal = normalized(Vec3f{0.1f, 1, -0.05f});
    point.diffuse = {s.diffuse, 0.5f * s.diffuse, 0.25f * s.diffuse};
    point.specular = {0.5f * s.specular, s.specular, s.specular};
    point.shininess = s.shininess;
    return point;
}

Vec3f eye_of(const Surface& s) {
    const double t = static_cast<double>(s.view_degrees) * M_PI / 180;
    return static_cast<Vec3f>(Vec3d{-std::sin(t), std::cos(t), 0});
}

// Rings about the mirrored direction, fine within the lobe, and spokes.
template <class Sampler>
Bins about_mirror(const SurfacePoint& point, Vec3f eye, Sampler&& sampler, unsigned seed) {
    const Vec3d axis = normalized(static_cast<Vec3d>(mirrored_at(point.normal, eye)));
    const Vec3d s = normalized(cross(axis, Vec3d{0.3, 0.2, 0.9})), t = cross(axis, s);
    const double width = std::sqrt(2 / (static_cast<double>(point.shininess) + 2));
    std::vector<double> rings;
    for (int i = 0; i < 12 && 0.3 * i * width < 0.1; ++i) rings.push_back(0.3 * i * width);
    for (double a = rings.empty() ? 0 : rings.back() + 0.1; a < M_PI; a += M_PI / 16) rings.push_back(a);
    rings.push_back(M_PI + 1e-6);
    Bins bins(rings, Bins::even(0, 1, 16));
    const auto density = [&](double angle, double turn) {
        const double a = 2 * M_PI * (turn - 0.5), r = std::sin(angle);
        const Vec3d d = (r * std::cos(a)) * s + (r * std::sin(a)) * t + std::cos(angle) * axis;
        return static_cast<double>(scatter_pdf(point, eye, static_cast<Vec3f>(d))) * r * 2 * M_PI;
    };
    bins.expect(density, kSamples, 6);
    Uniform uniform(seed);
    for (int i = 0; i < kSamples; ++i) {
        const Vec3d d = normalized(static_cast<Vec3d>(sampler(uniform.pair())));
        bins.add(2 * std::asin(std::min(0.5 * length(d - axis), 1.0)),
                 std::atan2(dot(d, t), dot(d, s)) / (2 * M_PI) + 0.5);
    }
    return bins;
}

}  // namespace

TEST_CASE("scatter follows scatter_pdf") {
    ChiSquareTests tests("scatter: diffuse and Phong lobes, exponents 0 to 1e4");
    unsigned seed = 1;
    for (const Surface& surface : kSurfaces) {
        CAPTURE(surface.shininess);
        const SurfacePoint point = point_of(surface);
        const Vec3f eye = eye_of(surface);
        tests.add(about_mirror(point, eye, [&](Vec2f u) { return scatter(point, eye, u).direction; }, seed++));
    }
    tests.hold();

    // The lobe drawn anew with the same number by which it was chosen.
    ChiSquareTests broken("scatter with one number used twice");
    const SurfacePoint point = point_of(kSurfaces[5]);
    const Vec3f eye = eye_of(kSurfaces[5]);
    broken.add(about_mirror(
        point, eye,
        [&](Vec2f u) {
            return u.x < diffuse_share(point) ? sample_cosine(point.normal, u)
                                              : sample_phong(mirrored_at(point.normal, eye), point.shininess, u);
        },
        1));
    broken.breaks();
}

TEST_CASE("the diffuse lobe is chosen with the probability diffuse_share") {
    ChiSquareTests tests("scatter: the choice of the lobe");
    for (const Surface& surface : kSurfaces) {
        const SurfacePoint point = point_of(surface);
        const float share = diffuse_share(point);
        std::vector<double> counts(2);
        Uniform uniform(4);
        for (int i = 0; i < kSamples; ++i) {
            const Vec2f u = uniform.pair();
            const Vec3f d = scatter(point, {0, 1, 0}, u).direction;
            const bool diffuse = share > 0 && length(d - sample_cosine(point.normal, {u.x / share, u.y})) < 1e-6f;
            ++counts[diffuse ? 0 : 1];
        }
        const double expected = static_cast<double>(share) * kSamples;
        tests.add({expected, kSamples - expected}, counts);
    }
    tests.hold();
}

TEST_CASE("the factor is the lobe's reflectance times the cosine over its density") {
    double worst = 0;
    for (const Surface& surface : kSurfaces) {
        CAPTURE(surface.shininess);
        const SurfacePoint point = point_of(surface);
        const Vec3f eye = eye_of(surface);
        SurfacePoint lambert = point, phong = point;
        lambert.specular = phong.diffuse = {0, 0, 0};
        const float share = diffuse_share(point);
        Uniform uniform(9);
        for (int i = 0; i < 20000; ++i) {
            const Vec2f u = uniform.pair();
            const Scatter s = scatter(point, eye, u);
            const bool diffuse = u.x < share;
            const float pdf = diffuse ? share * cosine_pdf(point.normal, s.direction)
                                      : (1 - share) * scatter_pdf(phong, eye, s.direction);
            const float cosine = dot(point.normal, s.direction);
            const Vec3f expected = (cosine > 0 && s.direction.y > 0 ? cosine / pdf : 0.0f) *
                                   reflectance(diffuse ? lambert : phong, eye, s.direction);
            // Far out in a narrow lobe nothing of the density is left to compare.
            if (!(pdf > 1e-3f * (point.shininess + 1))) continue;
            worst = std::max(worst,
                             static_cast<double>(length(s.factor - expected) / length(expected + Vec3f{1e-6f, 0, 0})));
            REQUIRE((s.factor.x >= 0 && s.factor.y >= 0 && s.factor.z >= 0));
        }
    }
    // Both sides start from the same rounded direction: some twenty roundings to 24 bits.
    hold({"Samplers", "scatter: factor against reflectance, cosine and density", "10 surfaces, 20000 directions each",
          "core", "float32", worst, 2e-6, "relative"});
}

TEST_CASE("the ends of the square, and surfaces that reflect nothing") {
    for (const Surface& surface : kSurfaces) {
        const SurfacePoint point = point_of(surface);
        for (const Vec2f u : extreme_inputs()) {
            const Scatter s = scatter(point, eye_of(surface), u);
            CHECK(std::fabs(length(s.direction) - 1) < 2e-6f);
            CHECK(std::isfinite(s.factor.x + s.factor.y + s.factor.z));
            CHECK((s.factor.x >= 0 && s.factor.y >= 0 && s.factor.z >= 0));
            CHECK(std::isfinite(scatter_pdf(point, eye_of(surface), s.direction)));
        }
    }
    const SurfacePoint black = point_of({0, 0, 0, 0});
    const Scatter none = scatter(black, {0, 1, 0}, {0.3f, 0.4f});
    CHECK(length(none.factor) == 0);
}
