// Warps of the square to the disc and to directions, against their densities.

#include <cmath>
#include <vector>

#include "chi_square.hpp"
#include "math/sampling.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kDirectionSamples = 1 << 18;

const Vec3f kNormals[] = {{0, 0, 1},
                          {0, 0, -1},
                          {0, 1, 0},
                          {-1, 0, 0},
                          {0.6f, -0.8f, -0.0f},
                          normalized(Vec3f{0.3f, -0.8f, 0.5f}),
                          normalized(Vec3f{1e-4f, 0, -1})};

double euler_rotation(double x, double y) {
    return std::atan2(y, x) / (2 * M_PI) + 0.5;
}

// Rings and sectors of the disc; the density takes the ring's area element.
template <class Sampler>
Bins on_disc(Sampler&& sampler, unsigned seed) {
    Bins bins(Bins::even(0, 1, 16), Bins::even(0, 1, 16));
    const auto density = [](double r, double turn) {
        const double angle = 2 * M_PI * (turn - 0.5);
        const Vec2f p{static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle))};
        return static_cast<double>(disc_pdf(p)) * r * 2 * M_PI;
    };
    bins.expect(density, kDirectionSamples, 1);
    Uniform uniform(seed);
    for (int i = 0; i < kDirectionSamples; ++i) {
        const Vec2f p = sampler(uniform.pair());
        const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
        bins.add(std::min(std::hypot(x, y), 1.0), euler_rotation(x, y));  // 2e-7 past the rim by rounding
    }
    return bins;
}

// Bins of the sphere in height and azimuth about z, whatever the normal: equal areas. `pieces` for the edge of the
// hemisphere, which cuts through bins.
template <class Sampler, class Pdf>
Bins on_sphere(Sampler&& sampler, Pdf&& pdf, unsigned seed) {
    Bins bins(Bins::even(-1, 1, 24), Bins::even(0, 1, 24));
    const auto density = [&](double height, double turn) {
        const double angle = 2 * M_PI * (turn - 0.5), r = std::sqrt(1 - height * height);
        const Vec3d d{r * std::cos(angle), r * std::sin(angle), height};
        return static_cast<double>(pdf(static_cast<Vec3f>(d))) * 2 * M_PI;
    };
    bins.expect(density, kDirectionSamples, 4);
    Uniform uniform(seed);
    for (int i = 0; i < kDirectionSamples; ++i) {
        const Vec3d d = static_cast<Vec3d>(sampler(uniform.pair()));
        bins.add(std::clamp(d.z, -1.0, 1.0), euler_rotation(d.x, d.y));
    }
    return bins;
}

// Rings about an axis, in units of the lobe's width, by angle as the chord gives it: a cosine would round it off.
template <class Sampler>
Bins about_axis(Vec3f axis, float exponent, Sampler&& sampler, unsigned seed) {
    const double width = std::sqrt(2 / (static_cast<double>(exponent) + 2));
    std::vector<double> rings;
    for (int i = 0; i < 16 && 0.25 * i * width < 1.5; ++i) rings.push_back(0.25 * i * width);
    rings.push_back(M_PI / 2 + 1e-6);
    const Vec3d n = normalized(static_cast<Vec3d>(axis));
    const Vec3d s = normalized(cross(n, std::fabs(n.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})), t = cross(n, s);
    Bins bins(rings, Bins::even(0, 1, 12));
    const auto density = [&](double angle, double turn) {
        const double a = 2 * M_PI * (turn - 0.5), r = std::sin(angle);
        const Vec3d d = (r * std::cos(a)) * s + (r * std::sin(a)) * t + std::cos(angle) * n;
        return static_cast<double>(phong_pdf(axis, exponent, static_cast<Vec3f>(d))) * r * 2 * M_PI;
    };
    bins.expect(density, kDirectionSamples, 4);
    Uniform uniform(seed);
    for (int i = 0; i < kDirectionSamples; ++i) {
        const Vec3d d = static_cast<Vec3d>(sampler(uniform.pair()));
        bins.add(2 * std::asin(std::min(0.5 * length(normalized(d) - n), 1.0)), euler_rotation(dot(d, s), dot(d, t)));
    }
    return bins;
}

}  // namespace

TEST_CASE("sample_disc follows disc_pdf") {
    ChiSquareTests tests("sample_disc");
    for (const unsigned seed : {1u, 2u, 3u}) tests.add(on_disc([](Vec2f u) { return sample_disc(u); }, seed));
    tests.hold();

    ChiSquareTests broken("sample_disc without the square root");
    broken.add(on_disc(
        [](Vec2f u) {
            const Vec2f azimuth = cos_sin_of_turn(u.x);
            return Vec2f{u.y * azimuth.x, u.y * azimuth.y};
        },
        1));
    broken.breaks();

    for (const Vec2f u : extreme_inputs()) {
        const Vec2f p = sample_disc(u);
        CHECK(disc_pdf({0.9999995f * p.x, 0.9999995f * p.y}) == 0.3183098862f);
    }
    CHECK(disc_pdf({0.8f, 0.7f}) == 0);
}

TEST_CASE("sample_cosine follows cosine_pdf about every normal") {
    ChiSquareTests tests("sample_cosine");
    unsigned seed = 1;
    for (const Vec3f n : kNormals)
        tests.add(
            on_sphere([&](Vec2f u) { return sample_cosine(n, u); }, [&](Vec3f d) { return cosine_pdf(n, d); }, seed++));
    tests.hold();

    ChiSquareTests broken("sample_cosine with even heights");
    const Vec3f n = kNormals[5];
    broken.add(on_sphere(
        [&](Vec2f u) {
            Vec3f s, t;
            tangent_frame(n, s, t);
            const Vec2f azimuth = cos_sin_of_turn(u.y);
            const float radius = std::sqrt(1 - u.x * u.x);
            return (radius * azimuth.x) * s + (radius * azimuth.y) * t + u.x * n;
        },
        [&](Vec3f d) { return cosine_pdf(n, d); }, 1));
    broken.breaks();

    for (const Vec3f axis : kNormals)
        for (const Vec2f u : extreme_inputs()) {
            const Vec3f d = sample_cosine(axis, u);
            CHECK(std::fabs(length(d) - 1) < 1e-6f);  // a few roundings to 24 bits
            CHECK(dot(d, axis) > 0);                  // sqrt(2^-24) above the horizon at least
            CHECK(cosine_pdf(axis, d) > 0);
        }
}

TEST_CASE("sample_phong follows phong_pdf from a hemisphere to a lobe of 0.1 degrees") {
    ChiSquareTests tests("sample_phong: exponents 0 to 1e6");
    unsigned seed = 1;
    for (const float exponent : {0.0f, 0.5f, 5.0f, 50.0f, 1e4f, 1e6f})
        for (const Vec3f axis : {kNormals[1], kNormals[5]})
            tests.add(about_axis(axis, exponent, [&](Vec2f u) { return sample_phong(axis, exponent, u); }, seed++));
    tests.hold();

    ChiSquareTests broken("sample_phong with an exponent off by one");
    broken.add(about_axis(kNormals[5], 5, [](Vec2f u) { return sample_phong(kNormals[5], 6, u); }, 1));
    broken.breaks();

    // One minus a cosine rounded to 24 bits: at an exponent of 1e6 a lobe has 17 steps of it.
    ChiSquareTests rounded("sample_phong with a sine from a rounded cosine");
    const Vec3f axis = kNormals[5];
    rounded.add(about_axis(
        axis, 1e6f,
        [&](Vec2f u) {
            Vec3f s, t;
            tangent_frame(axis, s, t);
            const float cosine = std::pow(1.0f - u.x, 1.0f / (1e6f + 1.0f));
            const float radius = std::sqrt(1.0f - cosine * cosine);
            const Vec2f azimuth = cos_sin_of_turn(u.y);
            return (radius * azimuth.x) * s + (radius * azimuth.y) * t + cosine * axis;
        },
        1));
    rounded.breaks();

    for (const float exponent : {0.0f, 1.0f, 1e4f, 1e9f})
        for (const Vec2f u : extreme_inputs()) {
            const Vec3f d = sample_phong(axis, exponent, u);
            CHECK(std::fabs(length(d) - 1) < 1e-6f);
            CHECK(std::isfinite(phong_pdf(axis, exponent, d)));
        }
}
