// Every bundled lens in float64 against the oracle in 50 digits, by every backend: rays, and optical path in waves.
// (Their float32 images are held by tests/truth/test_float32_error.py.)

#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/hard_rays.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("rays and optical paths of bundled lenses are those of the oracle") {
    constexpr int kRays = 80;
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        lens.iris.blades = 0;  // the oracle's diaphragms are round
        Random random(5);
        const RayBatch rays = rays_from_film(lens, kRays, random);
        const std::vector<OracleRay> truth = oracle_rays(lens, LightDirection::to_scene, rays);
        for (const TraceBackend& backend : trace_backends()) {
            if (backend.precision != Precision::float64) continue;
            const BatchResult found = backend(lens, LightDirection::to_scene, rays);
            double place = 0, waves = 0;
            int passed = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (truth[i].clearance < 1e-10) continue;  // the last digits decide
                REQUIRE(found.passed(i) == (truth[i].status == RayStatus::ok));
                if (!found.passed(i)) continue;
                ++passed;
                const double off = length(found.origins[i] - rounded(truth[i].origin)),
                             turn = length(found.directions[i] - rounded(truth[i].direction));
                place = std::max({place, off / lens.film_position(), turn});
                const double path = static_cast<double>(Real(found.optical_path[i]) - truth[i].optical_path);
                waves = std::max(waves, std::fabs(path) / (1e-6 * lens.wavelength_nm));
            }
            CHECK(passed > kRays / 4);
            const std::string tried = std::to_string(kRays) + " rays each";
            // 1e-12 is some 5000 roundings: 25 surfaces round about 25 times each, and grazing rays ten times as much.
            hold({"Bundled lenses", "place and direction of rays", tried, backend.name, "float64", place, 1e-12,
                  "relative"});
            // 1 m of path has an ulp of 1e-13 mm, 2e-10 waves.
            hold({"Bundled lenses", "optical path", tried, backend.name, "float64", waves, 1e-6, "waves"});
        }
    }
}
