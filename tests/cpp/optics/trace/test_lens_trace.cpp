// Real rays in every block size and in single precision. tests/truth compares them with a listing of CODE V.

#include <cmath>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "optics/trace/lens_trace.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

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
