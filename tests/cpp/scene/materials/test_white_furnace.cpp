// White surfaces under a constant sky: what they scatter is what they get.

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "../surfaces.hpp"
#include "chi_square.hpp"
#include "estimator_mean.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

// Some of them between the rows of the tables.
constexpr float kRoughnesses[] = {0, 0.03f, 0.05f, 0.08f, 0.1f, 0.2f, 0.25f, 0.3f, 0.42f, 0.5f, 0.7f, 0.85f, 0.97f, 1};
constexpr double kCosines[] = {1, 0.9, 0.7, 0.5, 0.3, 0.15, 0.05, 0.01};

/// The mean weight of scattered paths, without the index squared by which radiance changes in a medium. Of 2^12 paths,
/// or of as many, up to 2^15, as it takes until five standard errors are below 4e-3: of most surfaces the weights
/// scatter little.
Mean albedo(const NamedSurface& surface, double cosine, unsigned seed) {
    constexpr int kFewest = 1 << 12, kMost = 1 << 15;
    const Bsdf bsdf = bsdf_of(surface, eye_at(cosine));
    const double eta = static_cast<double>(bsdf.interface.eta);
    Mean mean;
    Uniform uniform(seed);
    for (int i = 0; i < kMost; ++i) {
        if (i % kFewest == 0 && i > 0 && kErrors * mean.standard_error() < 4e-3) break;
        const Vec2f u = uniform.pair();
        const BsdfSample s = bsdf.sample(u, uniform());
        mean.add(static_cast<double>(s.weight.g) * (s.refracted ? eta * eta : 1.0));
    }
    return mean;
}

struct Furnace {
    double least = 2, most = 0;
    int cases = 0;
};

/// Mean weights of surfaces, each seen at every third cosine, the next one at others: less
/// (least) and plus (most) five standard errors, so that noise alone passes neither limit. What loses light does so
/// over more than one roughness and cosine.
Furnace furnace(const std::vector<NamedSurface>& surfaces) {
    constexpr std::size_t kStep = 3;
    Furnace result;
    unsigned seed = 1;
    for (std::size_t s = 0; s < surfaces.size(); ++s)
        for (std::size_t c = s % kStep; c < std::size(kCosines); c += kStep) {
            const NamedSurface& surface = surfaces[s];
            const double cosine = kCosines[c];
            const Mean mean = albedo(surface, cosine, seed++);
            const double noise = kErrors * mean.standard_error();
            result.least = std::min(result.least, mean.value() + noise);
            result.most = std::max(result.most, mean.value() - noise);
            ++result.cases;
        }
    return result;
}

void hold_furnace(const std::string& what, const Furnace& found, double missing) {
    hold({"Samplers", "white furnace: " + what + ", light lost", std::to_string(found.cases) + " surfaces and views",
          "core", "float32", 1 - found.least, missing, "of the sky"});
    // 1e-3: the tables' interpolation, which tools/make_ggx_tables.py leaves at cosines of about alpha.
    hold({"Samplers", "white furnace: " + what + ", light gained", std::to_string(found.cases) + " surfaces and views",
          "core", "float32", found.most - 1, 1e-3, "of the sky"});
}

template <class Change>
std::vector<NamedSurface> of_all_roughness(const std::string& name, Change&& change) {
    std::vector<NamedSurface> all;
    for (const float roughness : kRoughnesses)
        all.push_back(metallic_roughness(numbered(name, roughness), [&](Material& m) {
            m.roughness = roughness;
            change(m);
        }));
    return all;
}

}  // namespace

TEST_CASE("white metals and white dielectrics give back all light, at any roughness and angle") {
    std::vector<NamedSurface> surfaces = of_all_roughness("metal", [](Material& m) { m.metallic = 1; });
    for (const float metallic : {0.0f, 0.3f, 0.7f})
        for (const NamedSurface& s : of_all_roughness("mixed", [&](Material& m) { m.metallic = metallic; }))
            surfaces.push_back(s);
    for (const float ior : {1.0f, 1.33f, 2.4f})
        for (const NamedSurface& s : of_all_roughness("dielectric", [&](Material& m) { m.ior = ior; }))
            surfaces.push_back(s);
    hold_furnace("metal and dielectric", furnace(surfaces), 0.01);
}

TEST_CASE("smooth glass, films and mirrors lose nothing") {
    std::vector<NamedSurface> surfaces;
    for (const float ior : {1.0f, 1.1f, 1.5f, 2.4f})
        for (const bool thin : {false, true})
            for (const bool fresnel : {false, true}) {
                surfaces.push_back(phong("glass", [&](Material& m) {
                    m.transmission = 1;
                    m.ior = ior;
                    m.is_thin = thin;
                    m.fresnel = fresnel ? FresnelTerm::physical : FresnelTerm::none;
                    m.mirror = {0.3f, 0.3f, 0.3f};
                }));
                surfaces.push_back(from_behind(surfaces.back()));
            }
    for (const bool fresnel : {false, true})
        surfaces.push_back(phong("mirror", [&](Material& m) {
            m.mirror = {0.4f, 0.4f, 0.4f};
            m.diffuse = {0.6f, 0.6f, 0.6f};
            m.fresnel = fresnel ? FresnelTerm::physical : FresnelTerm::none;
        }));
    hold_furnace("smooth glass, films and mirrors", furnace(surfaces), 1e-3);
}

// A coat's reflection weakens both ways of the light. What a rough metal loses by that comes back, as its table says.
TEST_CASE("clear coats lose nothing" * doctest::test_suite("slow")) {
    struct Coated {
        float weight, metallic;
    };
    std::vector<NamedSurface> surfaces;
    for (const float coat : {0.0f, 0.2f, 0.5f, 1.0f})
        for (const Coated& coated : {Coated{0.5f, 1}, {1, 0}, {1, 0.5f}, {1, 1}})
            for (const NamedSurface& s : of_all_roughness("coated", [&](Material& m) {
                     m.metallic = coated.metallic;
                     m.clearcoat = coated.weight;
                     m.clearcoat_roughness = coat;
                 }))
                surfaces.push_back(s);
    hold_furnace("clear coats", furnace(surfaces), 0.01);
}

TEST_CASE("rough films give back all light") {
    std::vector<NamedSurface> surfaces =
        of_all_roughness("film", [](Material& m) { m.transmission = 1, m.is_thin = 1; });
    hold_furnace("rough films", furnace(surfaces), 0.01);
}

TEST_CASE("rough glass gives back all light, on both sides") {
    std::vector<NamedSurface> all;
    for (const float ior : {1.0f, 1.02f, 1.1f, 1.33f, 1.75f, 2.5f})
        for (const NamedSurface& s : of_all_roughness("glass", [&](Material& m) { m.transmission = 1, m.ior = ior; })) {
            all.push_back(s);
            all.push_back(from_behind(s));
        }
    // Less than air inside: what is seen from outside is the glass.
    for (const NamedSurface& s :
         of_all_roughness("bubble", [](Material& m) { m.transmission = 1, m.ior = 1 / 1.5f; })) {
        all.push_back(s);
        all.push_back(from_behind(s));
    }
    hold_furnace("rough glass", furnace(all), 0.01);
}

TEST_CASE("rough glass in part, over or under what is opaque, gives back all light") {
    std::vector<NamedSurface> all;
    for (const float coat : {0.0f, 1.0f})
        for (const NamedSurface& s : of_all_roughness("partly glass", [&](Material& m) {
                 m.transmission = 0.6f;
                 m.metallic = 0.3f;
                 m.clearcoat = coat;
                 m.clearcoat_roughness = 0.4f;
             })) {
            all.push_back(s);
            all.push_back(from_behind(s));
        }
    hold_furnace("partly glass, coated or not", furnace(all), 0.01);
}
