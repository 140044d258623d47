// Stops that are nearly closed, closed, and no length at all.

#include <cmath>
#include <string>

#include "about.hpp"
#include "camera/models/pinhole_camera.hpp"
#include "field_picture.hpp"
#include "measurement.hpp"
#include "optics/lens/best_focus.hpp"
#include "optics/lens/exposure.hpp"
#include "optics/trace_backends.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("stops down to nothing: the right exposure or a clear error, on the axis and over the film") {
    const LensSystem gauss = io::read_lens("double-gauss-50mm");
    LensSystem open = gauss;
    open.stop_semi_diameter = 0.1;
    // A small stop's light goes with the square of its radius: pupil aberration is of the order of its square.
    const double per_square = axis_irradiance(open) / 0.01, film = photograph(open, 20, 16, 64).irradiance / 0.01;
    double worst = 0, worst_axis = 0;
    int taken = 0, refused = 0;
    for (double radius = 0.1; radius > 1e-20; radius *= 0.3) {
        CAPTURE(radius);
        LensSystem lens = gauss;
        lens.stop_semi_diameter = radius;
        worst_axis = std::max(worst_axis, std::fabs(axis_irradiance(lens) / (per_square * radius * radius) - 1));
        for (const CameraModel model : {CameraModel::pinhole, CameraModel::thin_lens, CameraModel::thick_lens})
            CHECK(photograph(lens, 20, 4, 16, model).finite);
        try {
            const FieldPicture picture = photograph(lens, 20, 16, 64);
            CHECK(picture.finite);
            worst = std::max(worst, std::fabs(picture.irradiance / (film * radius * radius) - 1));
            ++taken;
        } catch (const InputError& error) {
            const std::string message = error.what();
            CHECK((contains(message, "too small") || contains(message, "no light passes")));
            ++refused;
        }
    }
    CHECK(taken >= 4);  // down to 3 um, f/8500
    CHECK(refused > 10);
    // The pupil's own size changes the exposure by its square, 1e-5; double precision knows the axis to 1e-9 there.
    hold({"Lenses", "stops of 0.1 mm down to 1e-20 mm: irradiance on the axis goes with their area", "37 radii", "core",
          "float64", worst_axis, 1e-4, "of it"});
    // The noise of 16384 samples, at most half of them lost.
    hold({"Lenses", "small stops that are not refused: irradiance of the film goes with their area",
          std::to_string(taken) + " radii", "core", "float32", worst, 0.02, "of it"});
}

TEST_CASE("the field of view does not shrink as the stop closes") {
    double worst = 0;
    int count = 0;
    for (const char* name : {"double-gauss-50mm", "wide-22mm", "fisheye-10mm", "telephoto-250mm", "phone-4mm"}) {
        LensSystem lens = io::read_lens(name);
        const double full = lens.stop().clear_semi_diameter, height = 0.3 * lens.film_width;
        lens.stop_semi_diameter = 0.02 * full;  // the mean of many rays, all within a fiftieth of the aperture
        const double chief = field_angle(lens, height);
        REQUIRE(chief > 0);
        for (const double share : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9}) {
            lens.stop_semi_diameter = share * full;
            worst = std::max(worst, std::fabs(field_angle(lens, height) / chief - 1));
            CHECK(widest_field_angle(lens, 0.5 * lens.film_width) > chief);
            ++count;
        }
        lens.stop_semi_diameter = 0;
        CHECK(std::isnan(field_angle(lens, height)));
    }
    // Eight rays or more over 0.02 of the stop: their mean lies at most an eighth of that off the middle. For a hole
    // the angle is known.
    LensSystem hole = lens_of({stop_plane(0, 10)});
    hole.film_distance = 30;
    for (const double radius : {1.0, 1e-3, 1e-9}) {
        hole.stop_semi_diameter = radius;
        CHECK(field_angle(hole, 17) == about(std::atan2(17, 30), radius < 1e-2 ? 1e-9 : 2e-3));
    }
    hold({"Lenses", "field angle through stops of 1e-2 to 1e-9 of the full one", std::to_string(count) + " stops",
          "core", "float64", worst, 0.0025, "of it"});
}

TEST_CASE("a closed stop is dark for the ideal models, and an error for the real lens") {
    for (const char* name : {"double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm"})
        for (const int blades : {0, 6}) {
            LensSystem lens = io::read_lens(name);
            lens.stop_semi_diameter = 0;
            lens.iris.blades = blades;
            CHECK(contains(camera_error(lens), "its stop is closed"));
            for (const CameraModel model : {CameraModel::pinhole, CameraModel::thin_lens, CameraModel::thick_lens}) {
                const FieldPicture picture = photograph(lens, 10, 4, 16, model);
                CHECK(picture.finite);
                CHECK(picture.irradiance == 0);
            }
            CHECK(axis_irradiance(lens) == 0);
            CHECK(first_order(lens, lens.wavelength_nm).f_number == kInfinity);
            // No ray passes; focus and f-number are the open lens's.
            CHECK(std::isnan(best_focus_distance(lens, lens.wavelength_nm, kInfinity)));
            CHECK(std::isfinite(focused(lens, kInfinity).film_distance));
            CHECK(stopped_down(lens, 16).stop_semi_diameter > 0);
            Random random(5);
            for (const TraceBackend& backend : trace_backends()) {
                RayBatch rays;
                for (int i = 0; i < 100; ++i)
                    rays.add(point_on_film(lens, random),
                             point_on_last_surface(lens, random) - point_on_film(lens, random));
                const BatchResult result = backend(lens, LightDirection::to_scene, rays);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    CHECK_FALSE(result.passed(i));
                    CHECK(std::isfinite(length(result.origins[i]) + length(result.directions[i])));
                }
            }
        }
    for (const double wrong : {-1.0, std::nan("")}) {
        LensSystem lens = io::read_lens("double-gauss-50mm");
        lens.stop_semi_diameter = wrong;
        CHECK(contains(camera_error(lens), "open stop must be a length"));
        lens = io::read_lens("double-gauss-50mm");
        lens.film_distance = wrong;
        CHECK(contains(camera_error(lens), "film must lie behind the last surface"));
    }
    LensSystem endless = io::read_lens("double-gauss-50mm");
    endless.film_distance = kInfinity;
    CHECK(contains(camera_error(endless), "film must lie behind"));
}
