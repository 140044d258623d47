// Unrealistic lenses, as large, small, steep and dense as validate() allows: focus, stop, pupil and camera terminate
// with finite numbers or with an error that states the reason.

#include <cmath>
#include <string>
#include <vector>

#include "camera/camera_setup.hpp"
#include "camera/models/pinhole_camera.hpp"
#include "embree/lens_rays.hpp"
#include "measurement.hpp"
#include "optics/analysis/field_rays.hpp"
#include "optics/analysis/ray_aiming.hpp"
#include "optics/lens/exposure.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "pixel_rays.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

double anything(Random& random, double low, double high) {
    return std::pow(10.0, random.between(std::log10(low), std::log10(high)));
}

/// One to twelve surfaces; `decades`: how far their lengths lie apart.
LensSystem absurd_lens(Random& random, double decades) {
    const double scale = anything(random, 1e-4, 1e4), spread = std::pow(10.0, decades);
    const auto length = [&] { return std::clamp(scale * anything(random, 1 / spread, spread), 1e-6, 1e9); };
    const int count = 1 + static_cast<int>(12 * random());
    const int stop = static_cast<int>(count * random());
    std::vector<Surface> surfaces;
    double direction_sign = 1;
    for (int i = 0; i < count; ++i) {
        if (i == stop) {
            surfaces.push_back(stop_plane(random() < 0.2 ? 0 : direction_sign * length(), length()));
            continue;
        }
        const double radius = (random() < 0.5 ? -1 : 1) * length();
        Surface s = refracting(random() < 0.1 ? 0 : radius, 0, Glass::constant(anything(random, 1, 9.9)), length());
        if (random() < 0.3) s.material = Glass::air();
        if (random() < 0.2) s.conic = (random() < 0.5 ? -1 : 1) * anything(random, 1e-6, 1e6);
        const double end = std::fabs(radius) / std::sqrt(std::max(1 + s.conic, 1e-9));
        if (s.curvature != 0) s.clear_semi_diameter = std::clamp(s.clear_semi_diameter, 1e-6, 0.999 * end);
        if (random() < 0.2) s.inner_semi_diameter = random() * s.clear_semi_diameter;
        if (random() < 0.2)
            for (int k = 0; k < kMaxAsphericTerms; ++k)
                s.aspheric.push_back(random.between(-1, 1) * scale * std::pow(s.clear_semi_diameter, -4 - 2 * k));
        if (random() < 0.15) s.type = SurfaceType::mirror, direction_sign = -direction_sign;
        s.thickness = random() < 0.1 ? 0 : direction_sign * length();
        surfaces.push_back(s);
    }
    LensSystem lens = lens_of(surfaces);
    lens.iris.blades = random() < 0.2 ? 5 : 0;
    lens.stop_semi_diameter *= random() < 0.3 ? anything(random, 1e-12, 1) : 1;
    lens.film_distance = length();
    lens.film_width = length();
    lens.film_height = random.between(0.1, 1) * lens.film_width;
    if (random() < 0.2 && count > 2) lens.focusing = {0, 1, count / 2};
    return lens;
}

struct Outcomes {
    int lenses = 0, numbers = 0, errors = 0, wrong = 0;

    /// Calls f, which returns true if its results are numbers. Any other result must be thrown as an Error.
    template <class F>
    void take(const char* what, F&& f) {
        CAPTURE(std::string(what));
        try {
            const bool good = f();
            CHECK(good);
            ++(good ? numbers : wrong);
        } catch (const Error& error) {
            CHECK(std::string(error.what()).size() > 20);
            ++errors;
        }
    }
};

bool has_numbers(const FirstOrder& d) {
    for (const double v :
         {d.effective_focal_length, d.back_focal_distance, d.front_focal_distance, d.f_number,
          d.entrance_pupil_position, d.entrance_pupil_diameter, d.exit_pupil_position, d.exit_pupil_diameter})
        if (std::isnan(v)) return false;
    return true;
}

bool takes_pictures(const LensSystem& lens, CameraModel model) {
    const CameraSetup setup(camera_with(lens, model), fast_pupil_tracer());
    const CameraView view = setup.view({0, 0, 0});
    for (const int column : {0, 30, 48, 95}) {
        const CameraRays<kLanes> rays = rays_of_pixel(view, column, 31);
        for (int i = 0; i < kLanes; ++i)
            for (const float v : {rays.weight[i], rays.origin.x[i], rays.origin.y[i], rays.origin.z[i],
                                  rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]})
                if (!std::isfinite(v)) return false;
    }
    return true;
}

void try_all(const LensSystem& lens, Outcomes& outcomes) {
    ++outcomes.lenses;
    outcomes.take("first order", [&] { return has_numbers(first_order(lens, lens.wavelength_nm)); });
    for (const double distance : {1e-6, 1.0, 1.001, 30.0, 1e300, kInfinity})
        outcomes.take("focus", [&] {
            const LensSystem result = focused(lens, distance * lens.film_position());
            return std::isfinite(result.film_distance) && result.film_distance > 0;
        });
    for (const double f_number : {1e-9, 1.0, 22.0, 1e30})
        outcomes.take("stop", [&] {
            const double radius = stopped_down(lens, f_number).stop_semi_diameter;
            return radius >= 0 && radius <= lens.stop().clear_semi_diameter;
        });
    outcomes.take("irradiance on the axis", [&] {
        const double value = axis_irradiance(lens);
        return value >= 0 && value <= 100 * M_PI;  // n^2 pi
    });
    outcomes.take("field", [&] { return widest_field_angle(lens, 0.5 * lens.film_width) >= 0; });
    for (const CameraModel model : kModels) outcomes.take("picture", [&] { return takes_pictures(lens, model); });
    for (const double angle : {0.0, 0.3, 1.4})
        outcomes.take("aimed rays", [&] {
            const RayAimer aim(lens, lens.wavelength_nm, {angle, kInfinity});
            const AimedRay ray = aim({0.5 * stop_bounding_radius(lens), 0});
            return ray.status != RayStatus::ok || std::isfinite(length(ray.origin) + ray.path);
        });
}

}  // namespace

TEST_CASE("absurd lenses end in numbers or in errors") {
    Random random(77);
    Outcomes outcomes;
    for (int trial = 0; trial < 80; ++trial) {
        const LensSystem lens = absurd_lens(random, random.between(0, 8));
        try {
            validate(lens);
        } catch (const LensFileError&) {
            continue;
        }
        CAPTURE(trial);
        try_all(lens, outcomes);
    }
    CHECK(outcomes.numbers > 200);
    CHECK(outcomes.errors > 100);
    hold({"Iteration", "absurd lenses: first order, focus, stop, exposure, field, camera rays, aiming that end in NaN",
          std::to_string(outcomes.lenses) + " lenses, " + std::to_string(outcomes.numbers) + " answers, " +
              std::to_string(outcomes.errors) + " errors",
          "core", "float64 and float32", static_cast<double>(outcomes.wrong), 0, "answers"});
}
