// Properties common to all camera models: orientation, position, unused lanes, and rejected cameras.

#include <cmath>
#include <string>

#include "camera/camera_setup.hpp"
#include "doctest/doctest.h"
#include "pixel_rays.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("a pinhole camera has the perspective of its focal length") {
    Camera camera = camera_with(io::read_lens("double-gauss-50mm"), CameraModel::pinhole);
    camera.film = {36, 24, 360, 240};
    camera.pose = {{3, -2, 5}, {4, -2, 5}, {0, 1, 0}};  // looks along +x: right is +z
    const CameraSetup setup(camera);
    const CameraView view = setup.view({0, 0, 0});
    for (const int column : {0, 100, 180, 359})
        for (const int row : {0, 77, 239}) {
            const CameraRays<kLanes> rays = rays_of_pixel(view, column, row);
            for (int i = 0; i < kLanes; ++i) {
                const Vec3d d = static_cast<Vec3d>(rays.direction[i]);
                // Offset from the middle in mm over 50.3582 mm, within a pixel of 0.1 mm.
                const double right = 50.3582 * d.z / d.x, up = 50.3582 * d.y / d.x;
                CHECK(std::fabs(right - 0.1 * (column + 0.5 - 180)) < 0.0501);
                CHECK(std::fabs(up + 0.1 * (row + 0.5 - 120)) < 0.0501);
                CHECK(rays.passed[i] == 1);
                // All from the middle of the entrance pupil, on the camera's axis.
                CHECK(length(rays.origin[i] - rays.origin[0]) < 1e-6f);
                CHECK(std::fabs(static_cast<double>(rays.origin[i].y) + 2) < 1e-6);
            }
        }
}

TEST_CASE("what is up and left in the scene is up and left in the picture, for every model") {
    for (const char* name : {"double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm", "zoom-70-210mm"})
        for (const CameraModel model : kModels) {
            CAPTURE(std::string(name));
            CAPTURE(static_cast<int>(model));
            const Camera camera = camera_with(io::read_lens(name), model);  // looks along -z, y up
            const CameraSetup setup(camera);
            const CameraView view = setup.view({0, 0, 0});
            const auto mean_direction = [&](int column, int row) {
                Vec3d sum{0, 0, 0};
                const CameraRays<kLanes> rays = rays_of_pixel(view, column, row);
                for (int i = 0; i < kLanes; ++i)
                    if (rays.passed[i]) sum += static_cast<Vec3d>(rays.direction[i]);
                return normalized(sum);
            };
            const Vec3d left_top = mean_direction(15, 10), right_bottom = mean_direction(80, 53);
            CHECK(left_top.x < 0);
            CHECK(left_top.y > 0);
            CHECK(left_top.z < 0);
            CHECK(right_bottom.x > 0);
            CHECK(right_bottom.y < 0);
        }
}

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

TEST_CASE("a camera that cannot take a picture is refused with the reason") {
    const auto complaint = [](auto&& change) -> std::string {
        Camera camera = camera_with(io::read_lens("double-gauss-50mm"), CameraModel::pinhole);
        change(camera);
        try {
            const CameraSetup setup(camera);
        } catch (const InputError& error) {
            return error.what();
        }
        return "(no error)";
    };
    const double nan = std::nan("");
    CHECK(complaint([](Camera&) {}) == "(no error)");
    CHECK(complaint([](Camera& c) { c = Camera{}; }).find("the camera has no lens") != std::string::npos);
    CHECK(complaint([](Camera& c) { c = Camera{}, c.model = CameraModel::pinhole; }).find("no lens") !=
          std::string::npos);
    CHECK(complaint([](Camera& c) { c.film.width = 0; }).find("resolution is 0 x 64") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.film.height = 1 << 20; }).find("1 to 32768") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.film.width_mm = -1; }).find("film's width") != std::string::npos);
    CHECK(complaint([&](Camera& c) { c.film.height_mm = nan; }).find("film's width") != std::string::npos);
    CHECK(complaint([&](Camera& c) { c.exposure_time_s = nan; }).find("exposure time") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.iso = 0; }).find("ISO") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.lens.film_distance = -1; }).find("behind the last surface") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.lens.film_distance = 1e200; }).find("at most 1e9 mm") != std::string::npos);
    CHECK(complaint([](Camera& c) { c.pose.look_at_m = c.pose.position_m; }).find("other than its position") !=
          std::string::npos);
    CHECK(complaint([](Camera& c) { c.pose.up = {0, 0, 5}; }).find("not along its up") != std::string::npos);
    CHECK(complaint([&](Camera& c) { c.pose.up.x = nan; }).find("finite") != std::string::npos);
}
