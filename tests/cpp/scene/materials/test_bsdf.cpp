// Samplers of BSDFs against their densities, and their values against reciprocity.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../surfaces.hpp"
#include "chi_square.hpp"
#include "estimator_mean.hpp"
#include "scene/materials/plain_bsdf.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kBsdfSamples = 1 << 17;

std::vector<NamedSurface> rough_surfaces() {
    std::vector<NamedSurface> all;
    for (const float roughness : {0.15f, 0.4f, 1.0f}) {
        const auto rough = [&](const std::string& name, auto&& change) {
            all.push_back(metallic_roughness(numbered(name, roughness), [&](Material& m) {
                m.roughness = roughness;
                change(m);
            }));
        };
        rough("metal", [](Material& m) { m.metallic = 1; });
        rough("dielectric", [](Material& m) { m.diffuse = {0.2f, 0.5f, 0.9f}; });
        rough("film", [](Material& m) { m.transmission = 1, m.is_thin = 1; });
        rough("coated metal", [](Material& m) { m.metallic = 1, m.clearcoat = 0.7f, m.clearcoat_roughness = 0.3f; });
    }
    for (const float shininess : {0.0f, 5.0f, 300.0f})
        all.push_back(phong(numbered("phong", shininess), [&](Material& m) {
            m.diffuse = {0.4f, 0.3f, 0.1f};
            m.specular = {0.3f, 0.5f, 0.6f};
            m.shininess = shininess;
        }));
    return all;
}

/// Glass, which for tests of reciprocity has another factor.
std::vector<NamedSurface> rough_glass() {
    std::vector<NamedSurface> all;
    for (const float roughness : {0.35f, 0.6f, 1.0f}) {
        all.push_back(metallic_roughness(numbered("glass", roughness), [&](Material& m) {
            m.roughness = roughness;
            m.transmission = 1;
        }));
        all.push_back(from_behind(all.back()));
        all.push_back(metallic_roughness(numbered("partly glass", roughness), [&](Material& m) {
            m.roughness = roughness;
            m.transmission = 0.4f;
            m.metallic = 0.3f;
        }));
    }
    return all;
}

bool has_narrow_lobe(const NamedSurface& surface) {
    const Material& m = surface.material;
    return m.model == MaterialModel::phong ? m.shininess > 100 : m.roughness < 0.4f;
}

/// Bins are equal areas of the sphere: rings about the normal and sectors. Samples that end have a bin of their own.
template <class BsdfT>
void add_test(ChiSquareTests& tests, const BsdfT& bsdf, bool is_narrow, unsigned seed) {
    constexpr int kRings = 24, kSectors = 24;
    Bins bins(Bins::even(-1, 1, kRings), Bins::even(-M_PI, M_PI, kSectors));
    bins.expect(
        [&](double z, double turn) {
            const double r = std::sqrt(std::max(0.0, 1 - z * z));
            return static_cast<double>(bsdf.pdf(static_cast<Vec3f>(Vec3d{r * std::cos(turn), r * std::sin(turn), z})));
        },
        kBsdfSamples, is_narrow ? 6 : 2);  // 42 points across a bin, which holds the narrowest lobe six times, or 14
    double ended = 0, total = 0;
    for (const double e : bins.expected) total += e;
    Uniform uniform(seed);
    for (int i = 0; i < kBsdfSamples; ++i) {
        const Vec2f u = uniform.pair();
        const BsdfSample s = bsdf.sample(u, uniform());
        if (s.pdf > 0)
            bins.add(static_cast<double>(s.direction.z),
                     std::atan2(static_cast<double>(s.direction.y), static_cast<double>(s.direction.x)));
        else
            ++ended;
    }
    // Directions below the horizon of a lobe have no density; samples that end there have one bin.
    std::vector<double> expected = bins.expected, counts = bins.counts;
    expected.push_back(std::max(0.0, kBsdfSamples - total));
    counts.push_back(ended);
    tests.add(expected, counts, bins.outliers);
}

}  // namespace

TEST_CASE("directions follow the density of the whole BSDF") {
    ChiSquareTests tests("BSDFs: metal, dielectric, film, coat, glass, Phong");
    unsigned seed = 1;
    std::vector<NamedSurface> all = rough_surfaces();
    for (const NamedSurface& glass : rough_glass()) all.push_back(glass);
    for (const NamedSurface& surface : all)
        for (const double cosine : {0.95, 0.5}) {
            CAPTURE(surface.name);
            add_test(tests, bsdf_of(surface, eye_at(cosine)), has_narrow_lobe(surface), seed++);
        }
    for (const NamedSurface& surface : rough_surfaces()) {
        if (!surface.material.is_plain()) continue;
        const Material& m = surface.material;
        add_test(tests, make_bsdf<SceneKind::plain>(point_on(surface), eye_at(0.6)), has_narrow_lobe(surface), seed++);
        CHECK(m.model == MaterialModel::phong);
    }
    tests.hold(2e-2);
}

TEST_CASE("the weight of a direction is the BSDF times the cosine over the density") {
    double worst = 0;
    std::vector<NamedSurface> all = rough_surfaces();
    for (const NamedSurface& glass : rough_glass()) all.push_back(glass);
    for (const NamedSurface& surface : all)
        for (const double cosine : {1.0, 0.4, 0.02}) {
            CAPTURE(surface.name);
            const Bsdf bsdf = bsdf_of(surface, eye_at(cosine));
            Uniform uniform(5);
            for (int i = 0; i < 2000; ++i) {
                const Vec2f u = uniform.pair();
                const BsdfSample s = bsdf.sample(u, uniform());
                REQUIRE((s.weight.r >= 0 && std::isfinite(s.weight.r) && std::isfinite(s.pdf)));
                if (!(s.pdf > 0)) continue;
                const Color expected = (1.0f / s.pdf) * bsdf.eval(s.direction);
                worst = std::max(worst, static_cast<double>(std::fabs(s.weight.g - expected.g)));
            }
        }
    hold({"Samplers", "BSDF samples: weight against value over density", "all surfaces, 3 views", "core", "float32",
          worst, 1e-5, "absolute"});
}

TEST_CASE("light takes the same way in both directions") {
    double worst = 0;
    int compared = 0;
    for (const NamedSurface& surface : rough_surfaces()) {
        CAPTURE(surface.name);
        Uniform uniform(7);
        for (int i = 0; i < 4000; ++i) {
            const Vec3f a = sample_cosine({0, 0, 1}, uniform.pair());
            Vec3f b = sample_cosine({0, 0, 1}, uniform.pair());
            if (a.z < 0.02f || b.z < 0.02f) continue;
            if (surface.material.is_thin && i % 2) b.z = -b.z;
            // Seen from below, a film's other side is the same surface.
            const auto value = [&](Vec3f eye, Vec3f light) {
                const float side = eye.z < 0 ? -1.0f : 1.0f;
                eye.z *= side;
                light.z *= side;
                return static_cast<double>(bsdf_of(surface, eye).eval(light).g / std::fabs(light.z));
            };
            const double one = value(a, b), other = value(b, a);
            if (one + other < 1e-3) continue;
            worst = std::max(worst, std::fabs(one - other) / (one + other));
            ++compared;
        }
    }
    // Some twenty roundings; the narrowest lobe (alpha = 0.0225) multiplies the one of its half vector by 1 / alpha^2.
    hold({"Samplers", "BSDFs: reciprocity", std::to_string(compared) + " pairs of directions", "core", "float32", worst,
          2e-3, "relative"});
}

TEST_CASE("radiance through rough glass is reciprocal by the square of the index") {
    double worst = 0;
    for (const float roughness : {0.4f, 0.7f, 1.0f}) {
        const NamedSurface front = metallic_roughness("glass", [&](Material& m) {
            m.roughness = roughness;
            m.transmission = 1;
        });
        const NamedSurface back = from_behind(front);
        Uniform uniform(3);
        for (int i = 0; i < 4000; ++i) {
            const Vec3f above = sample_cosine({0, 0, 1}, uniform.pair()),
                        below = sample_cosine({0, 0, 1}, uniform.pair());
            if (above.z < 0.05f || below.z < 0.05f) continue;
            const auto turned = [](Vec3f v) { return Vec3f{v.x, v.y, -v.z}; };
            const double in = static_cast<double>(bsdf_of(front, above).eval(turned(below)).g / below.z);
            const double out = static_cast<double>(bsdf_of(back, below).eval(turned(above)).g / above.z);
            if (in + out < 1e-3) continue;
            // f(in) n_out^2 = f(out) n_in^2 for radiance, whose square of the index is in the value already.
            worst = std::max(worst, std::fabs(in * 2.25 - out) / (in * 2.25 + out));
        }
    }
    hold({"Samplers", "rough glass: reciprocity by the squares of the indices", "3 surfaces", "core", "float32", worst,
          2e-3, "relative"});
}

TEST_CASE("the ends of the square, and surfaces that reflect nothing") {
    std::vector<NamedSurface> all = rough_surfaces();
    for (const NamedSurface& glass : rough_glass()) all.push_back(glass);
    all.push_back(phong("black", [](Material&) {}));
    all.push_back(metallic_roughness("smooth glass", [](Material& m) { m.transmission = 1, m.roughness = 0; }));
    for (const NamedSurface& surface : all)
        for (const double cosine : {1.0, 0.3, 1e-4})
            for (const Vec2f u : extreme_inputs())
                for (const float choice : {0.0f, 0.5f, 0x1.fffffep-1f}) {
                    CAPTURE(surface.name);
                    const Bsdf bsdf = bsdf_of(surface, eye_at(cosine));
                    const BsdfSample s = bsdf.sample(u, choice);
                    CHECK(std::isfinite(s.weight.r + s.weight.g + s.weight.b));
                    CHECK((s.weight.r >= 0 && s.weight.g >= 0 && s.weight.b >= 0));
                    if (!is_black(s.weight)) CHECK(std::fabs(length(s.direction) - 1) < 1e-5f);
                    CHECK(s.pdf >= 0);
                }
}
