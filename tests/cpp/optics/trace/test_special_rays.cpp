// Rays at which formulas divide by zero, cancel or have to decide: along the axis, through the vertex and the centre of
// curvature, from a point on the surface, tangent, grazing, at the critical angle, and input that is no ray at all.

#include <cmath>
#include <limits>
#include <vector>

#include "backward_error.hpp"
#include "measurement.hpp"
#include "optics/trace_backends.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kGlassIndex = 1.7;

Vec3d in_float32(Vec3d v) {
    return static_cast<Vec3d>(static_cast<Vec3f>(v));
}
Vec3d direction(double angle, double azimuth) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
}

std::vector<Surface> shapes() {
    const Glass glass = Glass::constant(kGlassIndex);
    std::vector<Surface> list = {refracting(0, 0, glass, 15), refracting(1e9, 0, glass, 15),
                                 refracting(20, 0, glass, 15), refracting(-20, 0, glass, 15),
                                 refracting(20, 0, glass, 20)};
    for (const double k : {-1.0, -30.0, 1.5}) {
        list.push_back(refracting(-25, 0, glass, 14));
        list.back().conic = k;
    }
    list.push_back(refracting(30, 0, glass, 12));
    list.back().aspheric = {1e-5, -3e-8, 1e-10};
    return list;
}

/// Worst backward error of rays that all must pass one surface.
BackwardError worst_of(const TraceBackend& trace, const Surface& surface, const RayBatch& rays) {
    const BatchResult out = trace(lens_of({surface}), LightDirection::to_film, rays);
    BackwardError worst;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        CAPTURE(i);
        CAPTURE(surface.curvature);
        CAPTURE(surface.conic);
        CAPTURE(out.status[i]);
        REQUIRE(out.passed(i));
        worst.include(backward_error(surface, rays.origins[i], rays.directions[i], out.origins[i], out.directions[i], 1,
                                     kGlassIndex, trace.epsilon()));
    }
    return worst;
}

void hold_errors(const TraceBackend& trace, const char* what, std::size_t count, const BackwardError& worst) {
    const double largest = std::max({worst.off_line, worst.off_surface, worst.snell / 3});
    // See test_hard_surfaces.cpp: what one surface's arithmetic rounds.
    hold({"Rays", what, std::to_string(count) + " rays at 9 surfaces", trace.name, trace.number_type(), largest, 16,
          "ulp of scale"});
}

}  // namespace

TEST_CASE("rays through special points of a surface") {
    struct Family {
        const char* what;
        void (*add)(const Surface&, RayBatch&);
    };
    const std::vector<Family> families = {
        {"along the axis",
         [](const Surface&, RayBatch& rays) {
             for (const double z : {-100.0, -1.0, -1e-30, 0.0, 3.0}) rays.add({0, 0, z}, {0, 0, 1});
         }},
        {"through the vertex",
         [](const Surface&, RayBatch& rays) {
             for (int i = 0; i < 40; ++i) {
                 const Vec3d way = in_float32(direction(1.5 * i / 40, 0.7 * i));
                 rays.add({0, 0, 0}, way);
                 rays.add(-64.0 * way, way);
             }
         }},
        {"through the centre of curvature",
         [](const Surface& surface, RayBatch& rays) {
             if (surface.curvature == 0) return;
             const double radius = 1 / surface.curvature;
             // To points at up to half the semi-diameter, where the ray is radial; begun where float32 is exact.
             for (int i = 0; i < 40; ++i) {
                 const double r = surface.clear_semi_diameter * i / 80, height = surface.sag(r);
                 const Vec3d point{r * std::cos(0.7 * i), r * std::sin(0.7 * i), height};
                 Vec3d way = radius > 0 ? Vec3d{0, 0, radius} - point : point - Vec3d{0, 0, radius};
                 way = in_float32((1 / length(way)) * way);
                 rays.add(in_float32(point - 32.0 * way), way);
             }
         }},
        {"from a point on the surface",
         [](const Surface& surface, RayBatch& rays) {
             for (int i = 0; i < 40; ++i) {
                 const double r = 0.9 * surface.clear_semi_diameter * i / 40;
                 const Vec3d point{r * std::cos(0.7 * i), r * std::sin(0.7 * i), surface.sag(r)};
                 rays.add(in_float32(point), in_float32(direction(0.3, 1.1 * i)));
             }
         }},
        {"from behind the surface, where elements overlap",
         [](const Surface& surface, RayBatch& rays) {
             for (int i = 0; i < 40; ++i) {
                 const double r = 0.8 * surface.clear_semi_diameter * i / 40;
                 const Vec3d way = in_float32(direction(0.2, 1.3 * i));
                 rays.add(in_float32(Vec3d{r, 0, surface.sag(r)} + 0.125 * way), way);
             }
         }},
    };
    for (const TraceBackend& trace : trace_backends())
        for (const Family& family : families) {
            INFO(family.what);
            BackwardError worst;
            std::size_t count = 0;
            for (const Surface& surface : shapes()) {
                RayBatch rays;
                family.add(surface, rays);
                worst.include(worst_of(trace, surface, rays));
                count += rays.size();
            }
            hold_errors(trace, family.what, count, worst);
        }
}

TEST_CASE("rays that run backwards do not pass") {
    // Within 0.2 rad of the axis: the flank of a hemisphere can be crossed backwards, as a fisheye's rays do.
    for (const TraceBackend& trace : trace_backends())
        for (const Surface& surface : shapes()) {
            RayBatch rays;
            for (int i = 0; i < 20; ++i) rays.add({0.1 * i, 0, -10}, -direction(0.01 * i, i));
            const BatchResult out = trace(lens_of({surface}), LightDirection::to_film, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) CHECK(!out.passed(i));
        }
}

TEST_CASE("tangents of a sphere: hit or missed as in 50 digits, but for the last roundings") {
    const Surface surface = refracting(20, 0, Glass::constant(kGlassIndex), 20);
    RayBatch rays;
    // At heights around the hemisphere's 20 mm: by one part in 10^0.25 ... 10^17, on both sides.
    for (int i = 1; i <= 68; ++i)
        for (const double side : {-1.0, 1.0})
            for (const double turn : {0.0, 0.4})
                rays.add(in_float32({20 * (1 + side * std::pow(10, -i / 4.0)), 0, 20 - 64 * std::cos(turn)}),
                         in_float32({0, std::sin(turn), std::cos(turn)}));
    const OracleSurface shape(surface);
    for (const TraceBackend& trace : trace_backends()) {
        const BatchResult out = trace(lens_of({surface}), LightDirection::to_film, rays);
        BackwardError worst;
        double amiss = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Real discriminant;
            const bool meets =
                shape.crossing(exact(rays.origins[i]), normalized(exact(rays.directions[i])), 1, &discriminant)
                    .has_value();
            if (out.passed(i))
                worst.include(backward_error(surface, rays.origins[i], rays.directions[i], out.origins[i],
                                             out.directions[i], 1, kGlassIndex, trace.epsilon()));
            if (meets != out.passed(i)) amiss = std::max(amiss, std::fabs(static_cast<double>(discriminant)));
        }
        hold_errors(trace, "tangent to a sphere", rays.size(), worst);
        // The discriminant is a difference of numbers of the order of (64 / 20)^2, rounded some ten times.
        hold({"Rays", "tangent to a sphere: decided otherwise, distance from the edge",
              std::to_string(rays.size()) + " rays, on both sides", trace.name, trace.number_type(), amiss,
              trace.precision == Precision::float64 ? 100 * trace.epsilon() : 1e-4, "relative"});
    }
}

TEST_CASE("grazing rays, to 89.9999 degrees and beyond, obey Snell's law") {
    RayBatch rays;
    for (const double degrees : {85.0, 89.0, 89.9, 89.99, 89.999, 89.9999, 89.999999}) {
        const double off = (90 - degrees) * M_PI / 180;
        rays.add(in_float32({-5, 0, -5 * std::tan(off)}), in_float32({std::cos(off), 0, std::sin(off)}));
    }
    for (const TraceBackend& trace : trace_backends()) {
        BackwardError worst;
        for (const double radius : {0.0, 1e6, -1e6})
            worst.include(worst_of(trace, refracting(radius, 0, Glass::constant(kGlassIndex), 30), rays));
        hold_errors(trace, "grazing at 85 to 89.999999 degrees", 3 * rays.size(), worst);
    }
}

TEST_CASE("the critical angle: reflected or refracted as in 50 digits, but for the last roundings") {
    // Light to the scene starts in glass.
    const LensSystem lens = lens_of({refracting(0, 0, Glass::constant(kGlassIndex), 1000)});
    RayBatch rays;
    for (int i = 0; i <= 68; ++i)
        for (const double side : {-1.0, 1.0}) {
            const double sine = (1 + side * std::pow(10, -i / 4.0) * 0.5) / kGlassIndex;
            if (sine < 1) rays.add({0, 0, 1}, in_float32({sine, 0, -std::sqrt(1 - sine * sine)}));
        }
    for (const TraceBackend& trace : trace_backends()) {
        const BatchResult out = trace(lens, LightDirection::to_scene, rays);
        double amiss = 0, snell = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const RealVector d = normalized(exact(rays.directions[i]));
            const Real sine = Real(kGlassIndex) * d.x;
            const bool reflected = out.status[i] == static_cast<int>(RayStatus::total_internal_reflection);
            REQUIRE((reflected || out.passed(i)));
            if (reflected != (sine > 1)) amiss = std::max(amiss, std::fabs(static_cast<double>(sine - 1)));
            if (!reflected) snell = std::max(snell, std::fabs(static_cast<double>(out.directions[i].x - sine)));
        }
        const std::string tried = std::to_string(rays.size()) + " rays, on both sides";
        hold({"Rays", "at the critical angle: Snell's law", tried, trace.name, trace.number_type(),
              snell / trace.epsilon(), 4, "ulp"});
        hold({"Rays", "at the critical angle: decided otherwise, distance from the edge", tried, trace.name,
              trace.number_type(), amiss, trace.precision == Precision::float64 ? 8 * trace.epsilon() : 1e-4,
              "relative"});
    }
}

TEST_CASE("directions of any length are the same direction") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    for (const TraceBackend& trace : trace_backends()) {
        RayBatch rays;
        const Vec3d origin{1, -2, lens.film_position()}, way{0.125, 0.0625, -1};
        for (const double size : {1.0, 0x1p-1000, 0x1p-1060, 0x1p-30, 0x1p30, 0x1p1000, 0x1p1023})
            rays.add(origin, size * way);
        const BatchResult out = trace(lens, LightDirection::to_scene, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            CAPTURE(rays.directions[i].z);
            REQUIRE(out.passed(i));
            // Powers of two: not a bit differs.
            CHECK(length(out.directions[i] - out.directions[0]) == 0);
            CHECK(length(out.origins[i] - out.origins[0]) == 0);
            CHECK(out.optical_path[i] == out.optical_path[0]);
        }
    }
}

TEST_CASE("what is no ray is bad input, and nothing but numbers comes back") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const double denormal = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    RayBatch bad, good;
    for (const double v : {kNaN, kInf, -kInf})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d origin{0, 0, 100}, way{0, 0, -1};
            (axis == 0 ? origin.x : axis == 1 ? origin.y : origin.z) = v;
            bad.add(origin, {0, 0, -1});
            (axis == 0 ? way.x : axis == 1 ? way.y : way.z) = v;
            bad.add({0, 0, 100}, way);
        }
    bad.add({0, 0, 100}, {0, 0, 0});
    bad.add({0, 0, 100}, {-0.0, 0, -0.0});
    bad.add({most, 0, 0}, {0, 0, -1});
    bad.add({0, 0, 1.01e18}, {0, 0, -1});
    for (const double size : {denormal, 1e-300, most})
        for (const Vec3d& d : {Vec3d{0, 0, -1}, Vec3d{1, 0, 0}, Vec3d{1, 1, -1}, Vec3d{0, 0, 1}})
            good.add({0, 0, 60}, size * d);
    for (const double far : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18})
        for (const Vec3d& o : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0.3, 0.2, 0.6}, Vec3d{0, 0, -1}})
            for (const Vec3d& d : {-o, Vec3d{0, 0, -1}, Vec3d{1, 0, 0}}) good.add(far * o, d);
    for (const TraceBackend& trace : trace_backends())
        for (const LightDirection way : {LightDirection::to_film, LightDirection::to_scene}) {
            const BatchResult refused = trace(lens, way, bad);
            for (std::size_t i = 0; i < bad.size(); ++i) {
                CAPTURE(i);
                CHECK(refused.status[i] == static_cast<int>(RayStatus::bad_input));
                CHECK(refused.surface_index[i] == -1);
                CHECK(length(refused.origins[i]) + length(refused.directions[i]) + refused.optical_path[i] == 0);
            }
            const BatchResult out = trace(lens, way, good);
            for (std::size_t i = 0; i < good.size(); ++i) {
                CAPTURE(i);
                CHECK(out.status[i] != static_cast<int>(RayStatus::bad_input));
                CHECK(std::isfinite(length(out.origins[i])));
                CHECK(length(out.directions[i]) == doctest::Approx(1).epsilon(1e-12));
                CHECK(std::isfinite(out.optical_path[i]));
            }
        }
}

TEST_CASE("rays from as far away as a star reach the film where they do in 50 digits") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    // The caller's numbers are exact, and the line through them is the ray: 100 km to a tenth of a light year.
    for (const TraceBackend& trace : trace_backends()) {
        RayBatch rays;
        Random random(7);
        for (int i = 0; i < 200; ++i) {
            const double far = std::pow(10, random.between(3.1, 17.9));
            const Vec3d way = direction(random.between(0, 0.3), random.between(0, 6.28));
            rays.add(Vec3d{random.between(-5, 5), random.between(-5, 5), 0} - far * way, way);
        }
        const BatchResult out = trace(lens, LightDirection::to_film, rays);
        double worst = 0;
        int compared = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const OracleRay truth = oracle_trace(lens, LightDirection::to_film, rays.origins[i], rays.directions[i]);
            if (truth.status != RayStatus::ok || truth.clearance < 1e-3) continue;
            REQUIRE(out.passed(i));
            ++compared;
            worst = std::max(worst, length(out.origins[i] - rounded(truth.origin)) / lens.film_position());
        }
        CHECK(compared > 40);
        hold({"Rays", "from 1 m to a tenth of a light year away", std::to_string(compared) + " rays", trace.name,
              trace.number_type(), worst, trace.precision == Precision::float64 ? 1e-12 : 1e-6,
              "of the lens's length"});
    }
}

namespace {

/// For each ray: true if it passes, traced without a path record in N lanes, as for a picture (8) or on a GPU thread
/// (1).
template <int N>
std::vector<bool> passes_without_record(const LensPath<float>& path, const RayBatch& rays) {
    std::vector<bool> passes;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        LensRays<float, N> block;
        for (int k = 0; k < N; ++k) {
            Vec3d o = rays.origins[i];
            o.z -= path.entry_position;
            block.origin.set(k, static_cast<Vec3f>(o));
            block.direction.set(k, static_cast<Vec3f>(path.entry_index * rays.directions[i]));
            block.status[k] = 0;
        }
        trace_lens(path.view(), block);
        passes.push_back(block.status[0] == 0);
    }
    return passes;
}

}  // namespace

TEST_CASE("a backward ray on the axis does not meet the far end of a nearly flat conic, with a record or without") {
    RayBatch rays;
    for (const double z : {-1e4, -10.0, 0.0, 3e-3, 35.0, 4e6})
        for (const Vec3d direction : {Vec3d{0, 0, 1}, Vec3d{1e-12, 0, 1}}) rays.add({0, 0, z}, direction);
    int compared = 0;
    for (const double radius : {1e3, 1e7, 1e9, -1e9})
        for (const double bend : {0.0, 1e-16, -1e-16, 1e-9, -1e-9, 1e-7}) {
            Surface surface = refracting(radius, 1, Glass::constant(kGlassIndex), 15);
            surface.conic = -1 + bend;
            const LensSystem lens = lens_of({surface, surface, stop_plane(0, 10)});
            const LensPath<float> path(lens, LightDirection::to_scene, lens.wavelength_nm);
            const auto one = passes_without_record<1>(path, rays), eight = passes_without_record<8>(path, rays);
            for (const TraceBackend& trace : trace_backends()) {
                const BatchResult out = trace(lens, LightDirection::to_scene, rays);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    CAPTURE(surface.curvature);
                    CAPTURE(bend);
                    CAPTURE(i);
                    // An intersection in the wrong direction does not count, however far away the conic closes again.
                    CHECK(!out.passed(i));
                    CHECK(!one[i]);
                    CHECK(!eight[i]);
                    ++compared;
                }
            }
        }
    CHECK(compared >= 288);
}
