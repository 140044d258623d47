// Rays aimed at points of the real stop: they hit these points, every ray that the lens passes is found, and points
// that cannot be reached are reported.

#include "optics/analysis/ray_aiming.hpp"
#include "optics/centred_lenses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "doctest/doctest.h"
#include "embree/kernels.hpp"
#include "measurement.hpp"
#include "optics/analysis/field_rays.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

/// Half the angle that the lens is made for, rad.
double half_field(const LensSystem& lens) {
    if (lens.name == "fisheye-6mm-220deg") return 110 * M_PI / 180;
    if (lens.name == "fisheye-10mm") return 75 * M_PI / 180;
    const double f = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
    return std::atan(0.5 * std::hypot(lens.film_width, lens.film_height) / f);
}

/// End point and status of a ray that is traced through the first `count` surfaces only.
struct TracedEnd {
    Vec3d at;
    RayStatus status;
};

TracedEnd trace_to(const LensPath<double>& path, int count, const ObjectPoint& object, ObjectPoint::Entry entry) {
    LensView<double> view = path.view();
    view.count = count;
    LensRays<double, 1> ray;
    ray.origin.set(0, object.at(entry));
    ray.direction.set(0, object.direction(entry));
    ray.status[0] = 0;
    PathRecord<double, 1> record{};
    trace_lens(view, ray, record);
    return {ray.origin[0], static_cast<RayStatus>(ray.status[0])};
}

}  // namespace

TEST_CASE("every ray that a lens lets pass is the one that is aimed at its place on the stop") {
    for (const double object_distance : {kInfinity, 20.0}) {  // focal lengths
        double worst = 0;
        long tried = 0;
        for (const std::string& name : centred_lens_names()) {
            const LensSystem lens = io::read_lens(name);
            const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
            const FirstOrder data = first_order(lens, lens.wavelength_nm);
            const int count = static_cast<int>(lens.surfaces.size());
            for (const double share : {0.0, 0.35, 0.7, -0.9, 1.0}) {
                CAPTURE(name);
                CAPTURE(share);
                FieldPoint field{share * half_field(lens), object_distance * std::fabs(data.effective_focal_length)};
                if (std::isfinite(object_distance) && std::fabs(field.angle_rad) > 1.4) continue;
                const RayAimer aim(lens, lens.wavelength_nm, field);
                const double middle = aim.chief_ray().entry.y, reach = 0.8 * data.entrance_pupil_diameter;
                for (int i = 0; i < 30; ++i)
                    for (int k = 0; k < 30; ++k) {
                        const ObjectPoint::Entry entry{reach * (2 * i - 29) / 29, middle + reach * (2 * k - 29) / 29};
                        if (trace_to(path, count, aim.object, entry).status != RayStatus::ok) continue;
                        const TracedEnd stop = trace_to(path, lens.stop_index() + 1, aim.object, entry);
                        const AimedRay found = aim({stop.at.x, stop.at.y});
                        REQUIRE(found.status == RayStatus::ok);
                        worst = std::max(worst, std::hypot(found.entry.x - entry.x, found.entry.y - entry.y) / reach);
                        ++tried;
                    }
            }
        }
        CHECK(tried > 12500);
        // The ray hits the stop within 1e-10 of the stop's radius; relative to the pupil's radius, the error of the
        // entry is that times the distortion of the pupil, below 10 here.
        hold({"Truth", "rays aimed at the real stop against those that pass, entry over pupil radius",
              std::to_string(tried) + " rays of every bundled lens, object " +
                  (std::isfinite(object_distance) ? "near" : "at infinity"),
              "core", "float64", worst, 1e-9, "of the pupil"});
    }
}

TEST_CASE("an aimed ray meets its place") {
    double worst = 0;
    for (const std::string& name : centred_lens_names()) {
        const LensSystem lens = io::read_lens(name);
        const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
        const double radius = stop_bounding_radius(lens);
        for (const double share : {0.0, 0.5, 1.0}) {
            const RayAimer aim(lens, lens.wavelength_nm, {share * half_field(lens)});
            for (const PupilPoint& p : hexapolar(12)) {
                const AimedRay ray = aim({radius * p.x, radius * p.y});
                if (ray.status == RayStatus::no_convergence) continue;
                const TracedEnd stop = trace_to(path, lens.stop_index() + 1, aim.object, ray.entry);
                if (ray.status != RayStatus::ok || stop.status != RayStatus::ok) continue;
                worst = std::max(worst, std::hypot(stop.at.x - radius * p.x, stop.at.y - radius * p.y) / radius);
            }
        }
    }
    hold({"Truth", "aimed rays on the stop", "every bundled lens, 3 fields x 469 places", "core", "float64", worst,
          1e-10, "of its radius"});
}

namespace {

/// How many of n rays to the stop at this share of its reach pass, of a lens without other rims.
int passing(int blades, double field, double share) {
    LensSystem lens = io::read_lens("wide-22mm");
    for (Surface& s : lens.surfaces)
        if (s.type != SurfaceType::stop && s.curvature != 0) s.clear_semi_diameter = 0.99 / std::fabs(s.curvature);
    lens.iris.blades = blades;
    if (blades > 0) lens.stop_semi_diameter *= 0.5;
    const double reach = share * stop_bounding_radius(lens);
    const RayAimer aim(lens, lens.wavelength_nm, {field});
    int count = 0;
    for (int i = 0; i < 210; ++i) {
        // The corners of seven blades lie half a blade beside the first one's middle.
        const double angle = 2 * M_PI * (blades > 0 ? (i + 0.5) / 7 : i / 210.0);
        count += static_cast<int>(aim({reach * std::cos(angle), reach * std::sin(angle)}).status == RayStatus::ok);
    }
    return count;
}

}  // namespace

TEST_CASE("the reach of the stop is that of its opening, and its very edge is open") {
    for (const double field : {0.0, 0.1}) {
        CHECK(passing(0, field, 1) == 210);
        CHECK(passing(0, field, 1 + 1e-8) == 0);
        CHECK(passing(7, field, 1 - 1e-8) == 210);
        CHECK(passing(7, field, 1 + 1e-8) == 0);
    }
}

TEST_CASE("a place that no ray reaches is no good ray") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const RayAimer aim(lens, lens.wavelength_nm, {0.2});
    for (const double far : {40.0, 1e3, 1e12}) CHECK(aim({0, far}).status == RayStatus::no_convergence);
    CHECK(aim({std::nan(""), 0}).status == RayStatus::no_convergence);
    CHECK_THROWS_AS(RayAimer(lens, lens.wavelength_nm, {1.2}), InputError);
    CHECK_THROWS_AS(field_rays(lens, lens.wavelength_nm, {0.6}, hexapolar(6)), InputError);
}

TEST_CASE("rays that are aimed together are those that are aimed one by one" * doctest::test_suite("slow")) {
    std::vector<std::pair<std::string, RayLoop>> loops{{"core", RayLoop{}}};
    for (const realcam_kernels* kernels : available_kernels()) {
        RayLoop loop;
        loop.aim_rays = [kernels](const AimRequest& request) { kernels->aim_rays(&request); };
        loops.emplace_back(std::string("Embree ") + kernels->instruction_set, std::move(loop));
    }
    std::vector<double> worst(loops.size()), led(loops.size());
    std::size_t tried = 0;
    const std::vector<PupilPoint> pattern = hexapolar(18);
    const auto compare = [&](const LensSystem& lens, double angle) {
        CAPTURE(lens.name);
        CAPTURE(angle);
        const RayAimer aim(lens, lens.wavelength_nm, {angle});
        const double reach = stop_bounding_radius(lens),
                     pupil = first_order(lens, lens.wavelength_nm).entrance_pupil_diameter;
        std::vector<AimedRay> alone;
        for (const PupilPoint& p : pattern) alone.push_back(aim({reach * p.x, reach * p.y}));
        tried += alone.size();
        for (std::size_t k = 0; k < loops.size(); ++k) {
            RayLoop counting = loops[k].second;
            counting.aim_rays = [&](const AimRequest& request) {
                loops[k].second.aim_rays ? loops[k].second.aim_rays(request) : aim_rays<16>(request);
                for (std::int64_t i = 0; i < request.count; ++i) led[k] += std::isfinite(request.rays[i].path);
            };
            const std::vector<AimedRay> together = aim_all(aim, pattern, reach, counting);
            REQUIRE(together.size() == alone.size());
            for (std::size_t i = 0; i < alone.size(); ++i) {
                const AimedRay &a = alone[i], &b = together[i];
                REQUIRE(a.status == b.status);
                if (a.status == RayStatus::no_convergence) continue;
                const double turned = length(a.direction - b.direction),
                             off = std::hypot(a.entry.x - b.entry.x, a.entry.y - b.entry.y) / pupil;
                worst[k] = std::max({worst[k], off, a.status == RayStatus::ok ? turned : 0.0});
                if (a.status != RayStatus::ok) continue;
                // A ray beside another differs in its path by its slope: less than the shift itself.
                worst[k] = std::max(worst[k], std::fabs(a.path - b.path) / pupil);
            }
        }
    };
    for (const std::string& name : centred_lens_names())
        for (const double share : {0.0, 1.0}) {
            const LensSystem lens = io::read_lens(name);
            compare(lens, share * half_field(lens));
        }
    LensSystem bladed = stopped_down(io::read_lens("double-gauss-50mm"), 4);
    bladed.iris.blades = 5;
    compare(bladed, 0.2);
    for (std::size_t k = 0; k < loops.size(); ++k) {
        CHECK(led[k] > 0.9 * static_cast<double>(tried));
        // Both rays hit the stop within 2.5e-11 of its radius; the pupil's distortion magnifies this, as above.
        hold({"Truth", "rays aimed together against those aimed one by one: entry, path, direction",
              "every bundled lens, 2 fields x 1027 places", loops[k].first, "float64", worst[k], 1e-9, "of the pupil"});
    }
}
