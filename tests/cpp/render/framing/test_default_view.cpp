#include <numbers>

#include "camera/film/camera.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "render/framing/default_view.hpp"
#include "render/session/metering.hpp"

namespace {

using namespace realcam;

// An upright rectangle at a depth z, facing +z.
void add_rectangle(Scene& scene, double half_width, double half_height, double z) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    for (const double y : {-half_height, half_height})
        for (const double x : {-half_width, half_width}) scene.positions_m.push_back({x, y, z});
    scene.triangles.push_back({{first, first + 1, first + 3}, 0});
    scene.triangles.push_back({{first, first + 3, first + 2}, 0});
}

Camera camera_with(const std::string& lens) {
    Camera camera;
    camera.lens = io::read_lens(lens);
    camera.film = default_film(camera.lens, {}, {});
    return camera;
}

Image grey_image(int count, float exposure) {
    Image image;
    image.exposure = PictureFloats(std::vector<float>(3 * static_cast<std::size_t>(count), exposure));
    return image;
}

}  // namespace

TEST_CASE("A scene without a camera fills nine tenths of the film") {
    Scene scene;
    add_rectangle(scene, 1.5, 0.2, 3);
    for (const std::string lens : {"double-gauss-50mm", "telephoto-200mm-inner-focus"}) {
        Camera camera = camera_with(lens);
        set_view(camera, scene, {});
        CHECK(camera.pose.position_m.x == 0.0);
        CHECK(camera.pose.position_m.y == 0.0);
        const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
        const double pupil = (camera.lens.film_position() - data.entrance_pupil_position) / 1000;
        const double distance = camera.pose.position_m.z - 3 - pupil;
        CHECK(1.5 / distance == doctest::Approx(0.9 * std::tan(field_angle(camera.lens, 18))).epsilon(1e-3));
        CHECK(camera.lens.focus_distance / 1000 == doctest::Approx(camera.pose.position_m.z - 3).epsilon(1e-3));
    }
}

TEST_CASE("The camera focuses on the first surface of its axis") {
    Scene scene;
    add_rectangle(scene, 1, 1, 0);
    add_rectangle(scene, 0.1, 0.1, 1);
    Camera camera = camera_with("double-gauss-50mm");
    ViewRequest request;
    request.position_m = Vec3d{0, 0, 3};
    request.look_at_m = Vec3d{0, 0, 0};
    set_view(camera, scene, request);
    CHECK(camera.lens.focus_distance == doctest::Approx(2000));
    request.look_at_m = Vec3d{0.5, 0, 0};  // past the small one
    set_view(camera, scene, request);
    CHECK(camera.lens.focus_distance == doctest::Approx(1000 * std::hypot(3, 0.5)));
    request.focus_distance_m = 1.25;
    set_view(camera, scene, request);
    CHECK(camera.lens.focus_distance == 1250.0);
    request.focus_distance_m = 0.01;
    CHECK_THROWS_AS(set_view(camera, scene, request), InputError);
}

TEST_CASE("A tiny scene is photographed from where the lens can focus") {
    Scene scene;
    add_rectangle(scene, 1e-4, 1e-4, 0);
    Camera camera = camera_with("double-gauss-50mm");
    set_view(camera, scene, {});
    CHECK(std::isfinite(camera.lens.focus_distance));
    CHECK(camera.pose.position_m.z > 0.1);
}

TEST_CASE("Where z is up the camera stands along -y") {
    Scene scene;
    add_rectangle(scene, 1, 1, 0);
    Camera camera = camera_with("double-gauss-50mm");
    ViewRequest request;
    request.up = {0, 0, 1};
    set_view(camera, scene, request);
    CHECK(camera.pose.position_m.y < -1);
    // 45 degrees above a floor.
    const Vec3d position = camera.pose.position_m;
    CHECK(position.z == doctest::Approx(std::hypot(position.x, position.y)));
}

TEST_CASE("Daylight comes from the upper left behind the camera") {
    Scene scene;
    add_daylight(scene, {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}});
    REQUIRE(scene.suns.size() == 1);
    const SunLight sun = scene.suns[0];
    CHECK(sun.direction.x > 0);
    CHECK(sun.direction.y < 0);
    CHECK(sun.direction.z < 0);
    CHECK(luminance(sun.illuminance) == doctest::Approx(80e3).epsilon(0.01));
    CHECK(luminance(scene.environment.constant) == doctest::Approx(5000).epsilon(0.01));
}

TEST_CASE("Metering leaves darkness and lamps out") {
    CHECK(metered_exposure(grey_image(100, 2)) == doctest::Approx(2));
    CHECK(metered_exposure(grey_image(100, 0)) == 0.0);
    Image half_black = grey_image(100, 2);
    for (std::size_t i = 0; i < 150; ++i) half_black.exposure[i] = 0;
    CHECK(metered_exposure(half_black) == doctest::Approx(2));
    Image lamp = grey_image(100, 2);
    for (std::size_t i = 0; i < 3; ++i) lamp.exposure[i] = 1e6f;
    CHECK(metered_exposure(lamp) == doctest::Approx(0.99 * 2 / (1 - 0.08)));
}
