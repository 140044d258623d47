// Benchmarks for the command `realcam bench`: rays through a lens, and rays against a scene.

#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "../cuda/rays/bench_kernels.hpp"
#include "../devices/devices.hpp"
#include "../embree/kernels.hpp"
#include "../embree/lens_rays.hpp"
#include "../math/hypotenuse.hpp"
#include "../math/random.hpp"
#include "../optics/pupil/pupil.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

constexpr int kLanes = 256;  ///< rays per block, the number that the renderer traces at once
constexpr int kBlocks = 64;  ///< blocks in the test set: together 16384 rays

using Block = LensRays<float, kLanes>;

/// Samples rays from random film points through random pupil points, as rendering does.
std::vector<Block> sample_lens_rays(const LensSystem& lens) {
    const Pupil pupil(lens, 0.5 * hypotenuse(lens.film_width, lens.film_height), fast_pupil_tracer());
    std::vector<Block> blocks(kBlocks);
    for (std::size_t b = 0; b < blocks.size(); ++b)
        for (int i = 0; i < kLanes; ++i) {
            const Vec2f film = sample_2d(1, static_cast<std::uint32_t>(b) * kLanes + static_cast<std::uint32_t>(i), 0);
            const Vec2f u = sample_2d(1, static_cast<std::uint32_t>(b) * kLanes + static_cast<std::uint32_t>(i), 1);
            const float x = (film.x - 0.5f) * static_cast<float>(lens.film_width);
            const float y = (film.y - 0.5f) * static_cast<float>(lens.film_height);
            const PupilSample sample = sample_pupil(pupil.view(), x, y, u.x, u.y);
            blocks[b].origin.set(i, {x, y, static_cast<float>(lens.film_distance)});
            blocks[b].direction.set(i, sample.direction);
            blocks[b].status[i] = sample.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
    return blocks;
}

/// Measures rays per second through the lens on the calling thread and returns them by name of the instruction set. The
/// best round counts, because other programs can only slow a round down. `seconds`: time after which no further round
/// of all instruction sets begins.
std::map<std::string, double> lens_ray_rates(const LensSystem& lens, double seconds) {
    using Clock = std::chrono::steady_clock;
    const std::vector<Block> blocks = sample_lens_rays(lens);
    const LensPath<float> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const LensView<float> view = path.view();
    const auto scratch = std::make_unique<Block>();
    std::map<std::string, double> rates;
    const auto start = Clock::now();
    while (std::chrono::duration<double>(Clock::now() - start).count() < seconds)
        for (const realcam_kernels* kernel : available_kernels()) {
            constexpr int kRepeats = 20;
            const auto round = Clock::now();
            for (int r = 0; r < kRepeats; ++r)
                for (const Block& block : blocks) {
                    *scratch = block;
                    kernel->trace_block(&view, scratch.get());
                }
            const double rate =
                kRepeats * kBlocks * kLanes / std::chrono::duration<double>(Clock::now() - round).count();
            rates[kernel->instruction_set] = std::max(rates[kernel->instruction_set], rate);
        }
    return rates;
}

/// Returns the number of the GPU named `device`. Throws InputError if it names the CPU.
int gpu_for_bench(const std::string& device) {
    const std::optional<int> gpu = gpu_for_rays(device);
    if (!gpu) throw InputError("this benchmark is for a GPU; use device cuda");
    return *gpu;
}

}  // namespace

void bind_bench(py::module_& m) {
    m.def(
        "_lens_ray_rates",
        [](const LensSystem& lens, double seconds) {
            const Unlocked unlocked;
            return lens_ray_rates(lens, seconds);
        },
        "lens"_a, "seconds"_a,
        R"(Internal. Measures lens rays per second on one CPU thread, for about this many seconds. Returns a dict: name
of the instruction set to rays per second.)");
    m.def(
        "_gpu_lens_ray_rates",
        [](const Camera& camera, const std::string& device) {
            const Unlocked unlocked;
            const LensRayRates rates = lens_ray_rates(gpu_for_bench(device), camera, fast_pupil_tracer());
            return std::map<std::string, double>{
                {"traced", rates.traced}, {"generated", rates.generated}, {"passed", rates.passed}};
        },
        "camera"_a, "device"_a,
        R"(Internal. Measures lens rays on a GPU. Returns a dict: "traced" and "generated", rays per second with given
origins and sampled by the camera model; "passed", the fraction of the generated rays that pass the lens. Raises
InputError if device is not a GPU.)");
    m.def(
        "_gpu_hit_rates",
        [](const Assembly& scene, const Camera& camera, const std::string& device) {
            const Unlocked unlocked;
            const HitRates rates = hit_rates(gpu_for_bench(device), scene, camera, fast_pupil_tracer());
            return std::map<std::string, double>{{"build_seconds", rates.build_seconds},
                                                 {"upload_seconds", rates.upload_seconds},
                                                 {"camera", rates.camera_rays},
                                                 {"cosine", rates.bounce_rays},
                                                 {"uniform", rates.uniform_rays}};
        },
        "scene"_a, "camera"_a, "device"_a,
        R"(Internal. Measures closest-hit queries on a GPU. Returns a dict: build_seconds and upload_seconds of the
bounding volume hierarchy; rays per second of camera rays, of cosine-distributed rays from their hits, and of uniform
rays. Raises InputError if device is not a GPU.)");
}

}  // namespace realcam::bindings
