// Light through a lens: what the samples' means come to, against numerical quadrature over the pupil.

#include <string>

#include "../status_integral.hpp"
#include "camera/camera_setup.hpp"
#include "estimator_mean.hpp"
#include "measurement.hpp"
#include "pixel_rays.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("irradiance of a pixel through a real lens is the integral over its pupil") {
    struct State {
        const char* lens;
        double f_number;  // 0: wide open
    };
    constexpr State kStates[] = {{"double-gauss-50mm", 0},
                                 {"double-gauss-50mm", 11},
                                 {"wide-22mm", 0},
                                 {"fisheye-10mm", 0},
                                 {"phone-4mm", 0},
                                 {"mirror-telephoto-500mm", 0},
                                 {"telephoto-200mm-inner-focus", 5.6}};
    constexpr int kSamples = 1 << 17;
    Worst worst;
    double without_misses = 0;
    for (const State& state : kStates)
        for (const double share : {0.0, 0.85}) {
            CAPTURE(std::string(state.lens));
            CAPTURE(share);
            LensSystem lens = io::read_lens(state.lens);
            if (state.f_number > 0) lens = stopped_down(lens, state.f_number);
            Camera camera;
            camera.lens = lens;
            // Pixels so small that the irradiance over one is that of its middle.
            constexpr int kWidth = 6001, kHeight = 4001;
            camera.film = {lens.film_width, lens.film_height, kWidth, kHeight};
            const CameraSetup setup(camera);
            const CameraView view = setup.view({0, 0, 0});
            const int column = kWidth / 2 + static_cast<int>(share * (kWidth / 2));
            const int row = kHeight / 2 - static_cast<int>(share * (kHeight / 2));
            const Vec2f middle = film_point(view, column, row, {0.5f, 0.5f});
            const double truth = StatusIntegral(lens)(static_cast<double>(middle.x), static_cast<double>(middle.y));
            REQUIRE(truth > 0);
            Mean mean;
            double passed = 0;
            for (std::uint32_t first = 0; first < kSamples; first += kLanes) {
                const CameraRays<kLanes> rays = rays_of_pixel(view, column, row, first);
                for (int i = 0; i < kLanes; ++i) {
                    mean.add(rays.passed[i] ? static_cast<double>(rays.weight[i]) : 0.0);
                    passed += rays.passed[i];
                }
            }
            worst.add(mean, truth);
            without_misses = std::max(without_misses, std::fabs(mean.sum / passed - truth) / mean.standard_error());
        }
    const std::string tried = std::to_string(worst.cases) + " pixels of 2^17 samples: 7 lenses, axis and edge";
    hold({"Samplers", "irradiance through a lens: mean weight against quadrature over the pupil", tried, "core",
          "float32", worst.errors, kErrors, "standard errors"});
    // Three quarters of the samples pass at least, all with nearly one weight: 1.6e-3 is a standard error.
    hold({"Samplers", "irradiance through a lens: relative error of the mean", tried, "core", "float32", worst.relative,
          5 * 1.6e-3, "relative"});
    breaks({"Samplers", "irradiance through a lens: mean over the passing rays alone", tried, "core", "float32",
            without_misses, kErrors, "standard errors"});
}
