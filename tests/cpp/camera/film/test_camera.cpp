// Properties common to all camera models: orientation, position, unused lanes, and rejected cameras.

#include <cmath>
#include <string>

#include "camera/camera_setup.hpp"
#include "doctest/doctest.h"
#include "pixel_rays.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("rays leave from the front of the lens, and a far-away camera makes the same rays") {
    for (const CameraModel model : kModels) {
        CAPTURE(static_cast<int>(model));
        Camera camera = camera_with(focused(io::read_lens("double-gauss-50mm"), 2000), model);
        const CameraSetup near(camera);
        const Vec3d far{1e6, -3e5, 2e6};
        camera.pose.position_m = far;
        camera.pose.look_at_m = far + Vec3d{0, 0, -1};
        const CameraSetup moved(camera);
        const CameraRays<kLanes> a = rays_of_pixel(near.view({0, 0, 0}), 20, 9),
                                 b = rays_of_pixel(moved.view(far), 20, 9);
        for (int i = 0; i < kLanes; ++i) {
            CHECK(length(a.origin[i] - b.origin[i]) == 0);
            CHECK(length(a.direction[i] - b.direction[i]) == 0);
            if (!a.passed[i] || model != CameraModel::full_lens) continue;
            // On the first surface: between its vertex and its rim's height, sag(12.6) = 2.83 mm.
            const double depth = -1000 * static_cast<double>(a.origin[i].z) - camera.lens.film_position();
            CHECK(depth < 1e-3);
            CHECK(depth > -2.9);
        }
    }
}

TEST_CASE("lanes that are not used make no light and no NaN") {
    for (const CameraModel model : kModels) {
        const CameraSetup setup(camera_with(io::read_lens("fisheye-6mm-220deg"), model));
        const CameraView view = setup.view({0, 0, 0});
        SampleBlock<kLanes> block{};
        for (int i = 0; i < kLanes; ++i) block.used[i] = i % 2;
        CameraRays<kLanes> rays;
        generate_rays<LensKind::rotational>(view, block, rays);  // the film's corner: out of the fisheye's image
        for (int i = 0; i < kLanes; ++i) {
            CHECK(std::isfinite(length(rays.direction[i])));
            CHECK(std::isfinite(length(rays.origin[i])));
            CHECK(std::isfinite(rays.weight[i]));
            if (i % 2 == 0 || model == CameraModel::full_lens) CHECK(rays.weight[i] == 0);
            if (i % 2 == 0) CHECK(rays.passed[i] + rays.sampled[i] == 0);
        }
    }
}

TEST_CASE("rays from film points far beside the lens are sent in directions that exist, and leave as unit vectors") {
    Camera camera = camera_with(io::read_lens("achromat-75mm"), CameraModel::full_lens);
    camera.film = {6000, 2000, 96, 64};
    const CameraSetup setup(camera);
    const CameraView view = setup.view({0, 0, 0});
    float longest = 0, worst = 0;
    int passed = 0;
    for (int row = 0; row < 64; row += 3)
        for (int column = 0; column < 96; column += 3) {
            const CameraRays<kLanes> rays = rays_of_pixel(view, column, row);
            for (int i = 0; i < kLanes; ++i) {
                const Vec2f at = film_point(view, column, row, {0.5f, 0.5f}), u = sample_2d(pixel_stream(i, 0), 0, 1);
                const PupilSample sample = sample_pupil(view.pupil, at.x, at.y, u.x, u.y);
                const Vec3f d = sample.direction;
                if (sample.weight > 0) longest = std::max(longest, dot(d, d));
                if (!rays.passed[i]) continue;
                worst = std::max(worst, std::fabs(length(rays.direction[i]) - 1));
                ++passed;
            }
        }
    CHECK(passed > 10000);
    CHECK(longest < 1 + 1e-6f);
    CHECK(worst < 1e-6f);
    CHECK(pupil_pdf(view.pupil, 2900, 0, -1.001f, 0) == 0);
}
