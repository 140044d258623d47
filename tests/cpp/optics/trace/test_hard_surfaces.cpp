// One surface at a time, from a plane of curvature 1e-12 to a hemisphere, conics of -1e3 to 1e3 and aspheres with a
// reversed or vertical slope: the hits and directions of traced rays against the surface's equation in 50 digits.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "backward_error.hpp"
#include "measurement.hpp"
#include "optics/trace_backends.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

struct HardCase {
    const char* what;
    std::function<Surface(Random&)> make;
    /// Units in the last place of the scale by which a point may be off. The quadratic is rounded about sixteen times,
    /// each time by half a unit; the search on an asphere ends within 4 units of each of three lengths. Without fused
    /// multiply-adds the products are rounded too: half as many roundings again.
    double limit;
    double limit_of(const TraceBackend& backend) const { return backend.fuses() ? limit : 1.5 * limit; }
};

double log_uniform(Random& random, double low, double high) {
    return std::exp(random.between(std::log(low), std::log(high)));
}
double sign(Random& random) {
    return random() < 0.5 ? -1 : 1;
}

Surface sphere(double radius, double semi_diameter) {
    return refracting(radius, 0, Glass::constant(1.7), semi_diameter);
}

Surface conic(Random& random) {
    const double k = sign(random) * log_uniform(random, 1e-3, 1e3), radius = sign(random) * log_uniform(random, 5, 500);
    const double edge = 1 + k > 0 ? std::fabs(radius) / std::sqrt(1 + k) : 2 * std::fabs(radius);
    Surface surface = sphere(radius, edge * random.between(0.1, 0.99));
    surface.conic = k;
    return surface;
}

/// Each coefficient alone would lift the rim by up to `lift` of the semi-diameter.
Surface asphere(Random& random, double lift, double share_of_edge) {
    const double radius = sign(random) * log_uniform(random, 5, 50), k = random.between(-5, 5);
    const double edge = 1 + k > 0 ? std::fabs(radius) / std::sqrt(1 + k) : 2 * std::fabs(radius);
    Surface surface = sphere(radius, edge * share_of_edge);
    surface.conic = k;
    for (int i = 0; i < kMaxAsphericTerms; ++i)
        surface.aspheric.push_back(random.between(-lift, lift) * std::pow(surface.clear_semi_diameter, -3 - 2 * i));
    return surface;
}

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> cases = {
        {"plane", [](Random& r) { return sphere(0, r.between(1, 50)); }, 4},
        {"sphere of curvature 1e-12 to 1e-6 per mm",
         [](Random& r) { return sphere(sign(r) / log_uniform(r, 1e-12, 1e-6), r.between(1, 50)); }, 4},
        {"sphere, radius 5 to 500 mm",
         [](Random& r) {
             const double radius = log_uniform(r, 5, 500);
             return sphere(sign(r) * radius, radius * r.between(0.05, 0.9));
         },
         12},
        {"hemisphere, whole or all but 1e-9 of it",
         [](Random& r) {
             const double radius = log_uniform(r, 1, 100);
             return sphere(sign(r) * radius, radius * (1 - log_uniform(r, 1e-15, 1e-9)));
         },
         12},
        {"conic, k from -1000 to 1000", conic, 16},
        {"even asphere, 8 terms", [](Random& r) { return asphere(r, 0.02, r.between(0.2, 0.8)); }, 16},
        {"even asphere whose sag turns back", [](Random& r) { return asphere(r, 0.5, r.between(0.2, 0.8)); }, 16},
        {"even asphere with a vertical slope at its rim",
         [](Random& r) { return asphere(r, 0.02, 1 - log_uniform(r, 1e-12, 1e-6)); }, 16},
    };
    return cases;
}

Vec3d representable(Vec3d v) {
    return static_cast<Vec3d>(static_cast<Vec3f>(v));
}

/// Rays that start around the surface and aim at a point of it, inside the rim and a little beyond, from all sides;
/// their numbers are float32's.
void add_rays(const Surface& surface, Random& random, int count, RayBatch& rays) {
    const double rim = surface.clear_semi_diameter;
    for (int i = 0; i < count; ++i) {
        const double r = std::min(1.05 * rim * std::sqrt(random()), surface.is_asphere() ? rim : 2 * rim),
                     azimuth = random.between(0, 2 * M_PI), height = surface.sag(std::min(r, rim));
        const Vec3d target{r * std::cos(azimuth), r * std::sin(azimuth), height};
        const double cosine = random.between(-0.2, 1), sine = std::sqrt(1 - cosine * cosine),
                     turn = random.between(0, 2 * M_PI);
        const Vec3d way{sine * std::cos(turn), sine * std::sin(turn), cosine};
        rays.add(representable(target - rim * random.between(0.5, 4) * way), representable(way));
    }
}

struct WorstRay {
    BackwardError error;
    double decision = 0;  ///< largest distance from an edge of a ray on which backend and oracle disagree
    long compared = 0;
};

/// The oracle's decision on a ray at one surface, and its relative distance from an edge, where it would change.
struct Verdict {
    bool passes;
    double clearance;
};

Verdict verdict(const Surface& surface, const OracleSurface& shape, const RealVector& o, const RealVector& d) {
    const double rim = surface.clear_semi_diameter;
    if (shape.is_polynomial()) {
        // A wavy surface can be crossed more than once; a ray that first meets it beyond the rim is blocked there.
        const auto crossings = shape.crossings_inside(o, d, 1, 1.02 * rim);
        if (crossings.size() != 1) return {!crossings.empty(), 0};
        const RealVector at = o + crossings.front() * d;
        const double cosine = static_cast<double>(dot(shape.normal(at), d));
        const double r = static_cast<double>(sqrt(at.x * at.x + at.y * at.y));
        return {r <= rim, std::min(cosine * cosine, std::fabs(1 - r / rim))};
    }
    Real discriminant;
    const auto t = shape.crossing(o, d, 1, &discriminant);
    double clearance = std::fabs(static_cast<double>(discriminant));
    if (!t) return {false, clearance};
    const RealVector at = o + *t * d, gradient{-surface.curvature * at.x, -surface.curvature * at.y,
                                               1 - surface.curvature * (1 + Real(surface.conic)) * at.z};
    clearance /= static_cast<double>(dot(gradient, gradient));
    const Real r = sqrt(at.x * at.x + at.y * at.y);
    clearance = std::min(clearance, std::fabs(static_cast<double>(r / rim - 1)));
    // The near cap ends where the gradient has no part along the axis.
    clearance = std::min(clearance, std::fabs(static_cast<double>(gradient.z / length(gradient))));
    return {r <= rim, clearance};
}

}  // namespace

TEST_CASE("hard surfaces: points lie on the ray and on the surface, and rays leave by Snell's law") {
    constexpr int kSurfaces = 60, kRays = 40;
    for (const HardCase& hard : hard_cases()) {
        Random random(17);
        const auto backends = trace_backends();
        std::vector<WorstRay> worst(backends.size());
        for (int s = 0; s < kSurfaces; ++s) {
            const Surface surface = hard.make(random);
            const LensSystem lens = lens_of({surface});
            const OracleSurface shape(surface);
            const double n = surface.material.index(lens.wavelength_nm);
            RayBatch rays;
            add_rays(surface, random, kRays, rays);
            std::vector<Verdict> verdicts;
            for (std::size_t i = 0; i < rays.size(); ++i)
                verdicts.push_back(
                    verdict(surface, shape, exact(rays.origins[i]), normalized(exact(rays.directions[i]))));
            for (std::size_t b = 0; b < backends.size(); ++b) {
                const BatchResult out = backends[b](lens, LightDirection::to_film, rays);
                WorstRay& w = worst[b];
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    CAPTURE(hard.what);
                    CAPTURE(s);
                    CAPTURE(i);
                    if (out.passed(i) != verdicts[i].passes) w.decision = std::max(w.decision, verdicts[i].clearance);
                    if (!out.passed(i)) continue;
                    ++w.compared;
                    w.error.include(backward_error(surface, rays.origins[i], rays.directions[i], out.origins[i],
                                                   out.directions[i], 1, n, backends[b].epsilon()));
                }
            }
        }
        for (std::size_t b = 0; b < backends.size(); ++b) {
            const WorstRay& w = worst[b];
            CHECK(w.compared > kSurfaces * kRays / 3);
            const std::string tried = std::to_string(w.compared) + " rays";
            const auto line = [&](const std::string& what, double value, double most, const char* unit) {
                hold({"Surfaces", std::string(hard.what) + ": " + what, tried, backends[b].name,
                      backends[b].number_type(), value, most, unit});
            };
            const double limit = hard.limit_of(backends[b]);
            line("off the ray", w.error.off_line, limit, "ulp of scale");
            line("off the surface", w.error.off_surface, limit, "ulp of scale");
            line("Snell's law", w.error.snell, 3 * limit, "ulp");
            line("decided otherwise, distance from the edge", w.decision,
                 backends[b].precision == Precision::float64 ? 1e-12 : 1e-4, "relative");
        }
    }
}
