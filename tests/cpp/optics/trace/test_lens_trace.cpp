// Real rays: against the printed rays of a lens-design program, back along themselves, and in every block
// size.

#include <cmath>
#include <string>
#include <vector>

#include "code_v_rays.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "optics/trace/lens_trace.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// The lens of the listing with rims so wide that nothing is vignetted (its rays are traced with vignetting factors).
LensSystem code_v_lens() {
    LensSystem lens = io::read_lens("double-gauss-100mm");
    for (Surface& s : lens.surfaces) s.clear_semi_diameter = s.curvature == 0 ? 100 : 0.99 / std::fabs(s.curvature);
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    return lens;
}

struct Batch {
    std::vector<Vec3d> origins, directions;
};

// Rays from all over the film to the paraxial exit pupil and past it, relative to the last vertex.
Batch random_film_rays(const LensSystem& lens, int count, unsigned seed) {
    Random random(seed);
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    Batch batch;
    for (int i = 0; i < count; ++i) {
        const Vec3d film = point_on_film(lens, random) - Vec3d{0, 0, lens.last_vertex()};
        const double r = 0.6 * data.exit_pupil_diameter * std::sqrt(random()), a = random.between(0, 2 * M_PI);
        const Vec3d target{r * std::cos(a), r * std::sin(a), data.exit_pupil_position - lens.last_vertex()};
        const double towards_scene = target.z < film.z ? 1 : -1;
        batch.origins.push_back(film);
        batch.directions.push_back(towards_scene * normalized(target - film));
    }
    return batch;
}

template <class T>
struct Results {
    std::vector<Vec3<T>> origins, directions;
    std::vector<T> optical_paths;
    std::vector<int> statuses, surfaces;
};

template <class T, int N>
Results<T> trace_in_blocks(const LensPath<T>& path, const Batch& batch) {
    Results<T> results;
    LensRays<T, N> rays;
    for (std::size_t first = 0; first < batch.origins.size(); first += N) {
        for (int i = 0; i < N; ++i) {
            const std::size_t k = std::min(first + static_cast<std::size_t>(i), batch.origins.size() - 1);
            rays.origin.set(i, static_cast<Vec3<T>>(batch.origins[k]));
            rays.direction.set(i, static_cast<Vec3<T>>(batch.directions[k]));
            rays.status[i] = 0;
        }
        PathRecord<T, N> record{};
        trace_lens(path.view(), rays, record);
        for (int i = 0; i < N && first + static_cast<std::size_t>(i) < batch.origins.size(); ++i) {
            results.origins.push_back(rays.origin[i]);
            results.directions.push_back(rays.direction[i]);
            results.optical_paths.push_back(record.optical_path[i]);
            results.statuses.push_back(rays.status[i]);
            results.surfaces.push_back(record.surface_index[i]);
        }
    }
    return results;
}

template <class T>
double largest_difference(const Results<T>& a, const Results<T>& b) {
    REQUIRE(a.statuses == b.statuses);
    REQUIRE(a.surfaces == b.surfaces);
    double largest = 0;
    for (std::size_t i = 0; i < a.origins.size(); ++i) {
        largest = std::max(largest, static_cast<double>(length(a.origins[i] - b.origins[i])));
        largest = std::max(largest, static_cast<double>(length(a.directions[i] - b.directions[i])));
        largest = std::max(largest, static_cast<double>(std::fabs(a.optical_paths[i] - b.optical_paths[i])));
    }
    return largest;
}

}  // namespace

TEST_CASE("real rays of the CODE V double Gauss, surface by surface") {
    const LensSystem lens = code_v_lens();
    const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    for (const CodeVRay& ray : code_v_rays()) {
        CAPTURE(ray.name);
        // The listing starts at an object at infinity; here at its point on surface 1, from half a millimetre
        // before.
        const Vec3d direction = normalized(Vec3d{0, std::tan(ray.field_deg * M_PI / 180), 1});
        const CodeVRow& first = ray.rows[0];
        const Vec3d start = Vec3d{first.x, first.y, first.z} - 0.5 * direction;
        double path_before = 0;
        Vec3d direction_before = direction;
        for (int count = 1; count <= 11; ++count) {
            CAPTURE(count);
            LensView<double> view = path.view();
            view.count = count;
            LensRays<double, 1> rays;
            rays.origin.set(0, start);
            rays.direction.set(0, direction);
            rays.status[0] = 0;
            PathRecord<double, 1> record{};
            trace_lens(view, rays, record);
            REQUIRE(rays.status[0] == 0);
            const CodeVRow& row = ray.rows[static_cast<std::size_t>(count) - 1];
            const Vec3d p = rays.origin[0], d = rays.direction[0];
            // Six printed decimals, here and of the start: together 1e-5 mm at most.
            CHECK(std::fabs(p.x - row.x) < 1e-5);
            CHECK(std::fabs(p.y - row.y) < 1e-5);
            CHECK(std::fabs(p.z - row.z) < 1e-5);
            CHECK(std::fabs(d.x / d.z - row.tan_x) < 1e-6);
            CHECK(std::fabs(d.y / d.z - row.tan_y) < 1e-6);
            // Both ends of each length are printed points.
            const double length = (record.optical_path[0] - path_before) / n[static_cast<std::size_t>(count) - 1];
            if (count > 1) CHECK(std::fabs(length - row.length) < 2e-5);
            path_before = record.optical_path[0];
            // Angles to the sphere's normal, with two decimals.
            const double c = lens.surfaces[static_cast<std::size_t>(count) - 1].curvature;
            const auto angle = [&](Vec3d way) {
                const Vec3d normal{-c * p.x, -c * p.y, 1 - c * p.z};
                return std::atan2(realcam::length(cross(way, normal)), dot(way, normal)) * 180 / M_PI;
            };
            CHECK(std::fabs(angle(direction_before) - row.incidence) < 0.51e-2);
            CHECK(std::fabs(angle(d) - row.refraction) < 0.51e-2);
            direction_before = d;
        }
    }
}

TEST_CASE("light retraces itself through every bundled lens") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const RayTracer to_scene(lens, LightDirection::to_scene), to_film(lens, LightDirection::to_film);
        const Batch batch = random_film_rays(lens, 10000, 7);
        int passed = 0;
        double point_error = 0, direction_error = 0, path_error = 0;
        for (std::size_t i = 0; i < batch.origins.size(); ++i) {
            const Vec3d film = batch.origins[i] + Vec3d{0, 0, lens.last_vertex()}, direction = batch.directions[i];
            const TracedRay out = to_scene(film, direction);
            if (!out.passed()) continue;
            // Back from a point in front of the lens, so that the front surface is met afresh.
            const TracedRay back = to_film(out.origin + 20.0 * out.direction, -out.direction);
            if (!back.passed()) {
                // A ray on the very edge of a rim may fall off it by rounding.
                CHECK(back.status == RayStatus::vignetted);
                continue;
            }
            ++passed;
            point_error = std::max(point_error, length(back.at(lens.film_position()) - film));
            direction_error = std::max(direction_error, length(back.direction + direction));
            const double there = out.optical_path + 20;
            const double here = back.optical_path + length(back.origin - film);
            path_error = std::max(path_error, std::fabs(there - here));
        }
        CHECK(passed > 1500);
        // Rounding: 1e-16 of a few hundred mm, amplified by a few tens of refractions.
        CHECK(point_error < 1e-10);
        CHECK(direction_error < 1e-11);
        CHECK(path_error < 1e-10);
    }
}

TEST_CASE("every block size gives the same result") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const Batch batch = random_film_rays(lens, 2000, 3);
        const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
        const auto one = trace_in_blocks<double, 1>(path, batch);
        // The lanes do the same arithmetic; a compiler may fuse a multiplication and an addition in one of
        // the loops and not in the other, which rounding amplified by the lens then shows.
        CHECK(largest_difference(one, trace_in_blocks<double, 8>(path, batch)) < 1e-10);
        CHECK(largest_difference(one, trace_in_blocks<double, 256>(path, batch)) < 1e-10);
    }
}

TEST_CASE("single precision stays close to double precision") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const Batch batch = random_film_rays(lens, 20000, 5);
        const auto d =
            trace_in_blocks<double, 256>(LensPath<double>(lens, LightDirection::to_scene, lens.wavelength_nm), batch);
        const auto f =
            trace_in_blocks<float, 256>(LensPath<float>(lens, LightDirection::to_scene, lens.wavelength_nm), batch);
        const double focal = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
        double direction_error = 0, point_error = 0;
        int passed = 0, differing = 0;
        for (std::size_t i = 0; i < batch.origins.size(); ++i) {
            differing += (d.statuses[i] == 0) != (f.statuses[i] == 0);
            if (d.statuses[i] != 0 || f.statuses[i] != 0) continue;
            ++passed;
            direction_error = std::max(direction_error, length(static_cast<Vec3d>(f.directions[i]) - d.directions[i]));
            point_error = std::max(point_error, length(static_cast<Vec3d>(f.origins[i]) - d.origins[i]));
        }
        REQUIRE(passed > 3000);
        CAPTURE(direction_error * focal);
        CAPTURE(point_error);
        // 4e-6 is 64 roundings of 24 bits: the lenses have up to 22 surfaces, and amplify the error of the
        // first ones. Times the focal length it is the blur on the film: 0.2 um for a 50 mm lens.
        CHECK(direction_error * focal < 4e-6 * std::max(25.0, focal));
        CHECK(point_error < 4e-6 * (lens.film_position() + lens.surfaces[0].clear_semi_diameter));
        // Only rays within that error of a rim may end differently.
        CHECK(differing <= passed / 500);
    }
}
