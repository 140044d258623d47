// Rays through lenses that are hard to trace, by every backend, against the oracle in 50 digits.

#include "measurement.hpp"
#include "optics/hard_lens_list.hpp"
#include "optics/hard_rays.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "refusal.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kRaysEachWay = 160;

struct KnownRays {
    const LensSystem* lens;
    RayBatch to_scene, to_film;
    std::vector<OracleRay> in_scene, on_film;
};

KnownRays known_rays(const LensSystem& lens) {
    Random random(31);
    KnownRays known{&lens, rays_from_film(lens, kRaysEachWay, random), {}, {}, {}};
    known.in_scene = oracle_rays(lens, LightDirection::to_scene, known.to_scene);
    known.to_film = rays_back(lens, known.in_scene);
    known.on_film = oracle_rays(lens, LightDirection::to_film, known.to_film);
    return known;
}

}  // namespace

TEST_CASE("rays through hard lenses are those of the oracle, there and back, by every backend") {
    for (const LensGroup& group : hard_lenses()) {
        CAPTURE(group.what);
        std::vector<KnownRays> lenses;
        for (const HardLens& hard : group.lenses) {
            validate(hard.lens);
            lenses.push_back(known_rays(hard.lens));
        }
        const std::string tried = std::to_string(lenses.size()) + " lenses, " + std::to_string(kRaysEachWay) +
                                  " rays to the scene and those that pass back";
        for (const TraceBackend& backend : trace_backends()) {
            RayErrors worst;
            for (const KnownRays& k : lenses) {
                RayErrors there = errors_of(backend, *k.lens, LightDirection::to_scene, k.to_scene, k.in_scene);
                const RayErrors back = errors_of(backend, *k.lens, LightDirection::to_film, k.to_film, k.on_film);
                CHECK(there.passed > kRaysEachWay / 4);
                CHECK(back.passed > kRaysEachWay / 4);
                there.take(back);
                worst.take(there);
            }
            const bool exact_type = backend.precision == Precision::float64;
            const auto held = [&](const std::string& what, double value, double limit, const char* unit) {
                hold({"Lenses", group.what + ": " + what, tried, backend.name, backend.number_type(), value, limit,
                      unit});
            };
            if (exact_type) {
                held("place, direction and optical path of rays", worst.ray, 1e-12, "of the lens's length");
            } else if (group.float32_images) {
                // 0.05 um at 50 mm, a tenth of a wavelength.
                held("image points", worst.image, 1e-6, "of the lens's length");
            }
            held("rays that end otherwise than the oracle's", worst.decided_otherwise, 0, "rays");
        }
    }
}

TEST_CASE("the fisheye's light comes from behind it") {
    const KnownRays known = known_rays(fisheye_270());
    double backwards = 0;  // of rays that graze no surface
    for (const OracleRay& ray : known.in_scene)
        if (ray.status == RayStatus::ok && ray.clearance > 0.01)
            backwards = std::max(backwards, static_cast<double>(ray.direction.z));
    CHECK(backwards > std::cos(M_PI / 4));  // 135 degrees to the axis
}

TEST_CASE("256 surfaces make a lens, 257 do not, and one without a stop neither") {
    std::vector<Surface> surfaces = plates(127, 1, 5);
    surfaces.insert(surfaces.begin(), {stop_plane(1, 2), refracting(0, 1, Glass::air(), 5)});
    REQUIRE(surfaces.size() == 256);
    CHECK_NOTHROW(validate(lens_of(surfaces)));
    const auto complaint = [](const std::vector<Surface>& list) {
        return message_of<LensFileError>([&] { validate(lens_of(list)); });
    };
    surfaces.push_back(refracting(0, 0, Glass::air(), 5));
    CHECK(contains(complaint(surfaces), "257 surfaces; at most 256 are supported"));
    CHECK(contains(complaint({}), "no surfaces"));
    CHECK(contains(complaint({refracting(50, 0, Glass::constant(1.5), 5)}), "no surface of type"));
    CHECK(complaint({stop_plane(0, 5)}) == "(no error)");
}
