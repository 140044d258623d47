// Pinhole, thin lens and thick lens: their closed forms, and where they must agree with the real lens.

#include <cmath>
#include <string>

#include "about.hpp"
#include "camera/camera_setup.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "optics/lens/exposure.hpp"
#include "pixel_rays.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// Intersection of a ray of the ideal models with the plane `distance` in front of the first vertex, mm.
Vec3d at_plane(const LensFrameRay& ray, double distance) {
    const Vec3d o = static_cast<Vec3d>(ray.origin_mm), d = static_cast<Vec3d>(ray.direction);
    return o + ((-distance - o.z) / d.z) * d;
}

}  // namespace

TEST_CASE("ideal models bring all rays of a film point together in the plane of focus") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        LensSystem lens = focused(io::read_lens(name), near_focus(io::read_lens(name)));
        const double object = lens.focus_distance - lens.film_position();
        // Best focus of real rays is not the paraxial one of the matrix: the film is put there.
        lens.film_distance = paraxial_image_distance(lens, lens.wavelength_nm, object);
        lens.focus_distance = object + lens.film_position();
        const CameraSetup thin(camera_with(lens, CameraModel::thin_lens)),
            thick(camera_with(lens, CameraModel::thick_lens));
        const CameraView view = thin.view({0, 0, 0}), thick_view = thick.view({0, 0, 0});
        const float h = static_cast<float>(0.3 * lens.film_height);
        const Vec3d first = at_plane(thin_lens_ray(view, {h, 0}, {0.1f, 0.9f}, view.thin.pupil_radius), object);
        for (const Vec2f& u : {Vec2f{0, 0}, Vec2f{0.3f, 1}, Vec2f{0.6f, 0.5f}, Vec2f{0.9f, 1}}) {
            const Vec3d a = at_plane(thin_lens_ray(view, {h, 0}, u, view.thin.pupil_radius), object);
            const Vec3d b = at_plane(thick_lens_ray(thick_view, {h, 0}, u), object);
            // 24 bits of the distance and of the matrix: on the film 1e-4 mm and less.
            const double tolerance = 3e-5 * std::fabs(first.x);
            CHECK(std::hypot(a.x - first.x, a.y) < tolerance);
            CHECK(std::hypot(b.x - first.x, b.y) < 3 * tolerance);
        }
    }
}

TEST_CASE("the thick lens is the real lens for rays close to the axis") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        for (Surface& s : lens.surfaces) s.inner_semi_diameter = 0;  // a mirror lens has no rays close to its axis
        const CameraSetup setup(camera_with(lens, CameraModel::thick_lens));
        const CameraView view = setup.view({0, 0, 0});
        const RayTracer trace(lens, LightDirection::to_scene);
        const FirstOrder data = first_order(lens, lens.wavelength_nm);
        for (const Vec2f& u : {Vec2f{0, 0}, Vec2f{0.2f, 1e-4f}, Vec2f{0.7f, 1e-4f}}) {
            const double height = 0.01 * lens.film_height;
            const LensFrameRay thick =
                thick_lens_ray(view, {static_cast<float>(height), static_cast<float>(-0.5 * height)}, u);
            const Vec2f disc = sample_disc(u);
            const double radius = 0.5 * data.exit_pupil_diameter;
            const Vec3d film{height, -0.5 * height, lens.film_position()};
            const Vec3d pupil{radius * static_cast<double>(disc.x), radius * static_cast<double>(disc.y),
                              data.exit_pupil_position};
            const TracedRay real = trace(film, (pupil.z < film.z ? 1.0 : -1.0) * (pupil - film));
            REQUIRE(real.passed());
            const Vec3d at_vertex = real.at(0), d = static_cast<Vec3d>(thick.direction);
            // Third-order aberrations of 1% of field and aperture are 1e-4 of the ray, times a few for the
            // fastest and the widest; heights are compared on the scale of pupil and field.
            const double slope = 2 * height / std::fabs(data.effective_focal_length) + 1e-3;
            CHECK(std::fabs(d.x / d.z - real.direction.x / real.direction.z) < 2e-3 * slope);
            CHECK(std::fabs(d.y / d.z - real.direction.y / real.direction.z) < 2e-3 * slope);
            const double scale = height + std::fabs(at_vertex.x) + 0.01 * data.entrance_pupil_diameter;
            CHECK(std::fabs(static_cast<double>(thick.origin_mm.x) - at_vertex.x) < 5e-3 * scale);
            CHECK(std::fabs(static_cast<double>(thick.origin_mm.y) - at_vertex.y) < 5e-3 * scale);
        }
    }
}

TEST_CASE("all models have the same magnification near the axis") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = focused(io::read_lens(name), near_focus(io::read_lens(name)));
        const double object = lens.focus_distance - lens.film_position(), height = 0.01 * lens.film_height;
        const CameraSetup setup(camera_with(lens, CameraModel::thick_lens));
        const CameraView view = setup.view({0, 0, 0});
        const FirstOrder data = first_order(lens, lens.wavelength_nm);
        const float h = static_cast<float>(height);
        const double pinhole = at_plane(thin_lens_ray(view, {h, 0}, {0.3f, 1}, 0), object).x;
        const double thick = at_plane(thick_lens_ray(view, {h, 0}, {0, 0}), object).x;
        LensSystem unobstructed = lens;
        for (Surface& s : unobstructed.surfaces) s.inner_semi_diameter = 0;
        const Vec3d film{height, 0, lens.film_position()}, pupil{0, 0, data.exit_pupil_position};
        const TracedRay chief =
            RayTracer(unobstructed, LightDirection::to_scene)(film, (pupil.z < film.z ? 1.0 : -1.0) * (pupil - film));
        REQUIRE(chief.passed());
        // 1% of the field: distortion and the pupil's aberration are 1e-4 and less.
        CHECK(thick == about(chief.at(-object).x, 1e-3));
        // The film lies at the best focus of real rays; the thin lens has the magnification of the paraxial
        // plane, which spherical aberration puts that much further from the exit pupil.
        const double away = paraxial_image_distance(lens, lens.wavelength_nm, object) - lens.film_distance;
        const double tolerance = 1e-3 + 1.1 * std::fabs(away / (lens.film_position() - data.exit_pupil_position));
        CHECK(pinhole == about(thick, tolerance));
    }
}

TEST_CASE("the mirror lens loses what its obstruction hides") {
    const LensSystem lens = io::read_lens("mirror-telephoto-500mm");
    const double f_number = first_order(lens, lens.wavelength_nm).f_number;
    const double share = axis_irradiance(lens) / (M_PI / (4 * f_number * f_number));
    // f/6.7 by geometry; its maker sells it as f/8 for the light that is left. Engraved numbers: 3%.
    CHECK(6.7 / std::sqrt(share) == about(8, 0.03));
}
