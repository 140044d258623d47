#include "cuda_gradient.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "../../bvh/scene_bvh.hpp"
#include "../../render/session/live_frame.hpp"
#include "../device/current_device.hpp"
#include "../kernels/render_kernel.hpp"
#include "device_gradient.hpp"

namespace realcam {
namespace {

// Samples of a launch: enough to fill a GPU, in at most 200 MB.
constexpr std::int64_t kFilmLaunch = 1 << 21, kOutlineLaunch = 1 << 18;

/// Scene on a GPU.
struct PlacedScene {
    RenderSpaceScene placed;
    OnDevice<DeviceScene> on_gpu;

    PlacedScene(int ordinal, const Assembly& scene, const Camera& camera)
        : placed(scene, position_when_open(camera), camera.exposure()), on_gpu(make_on_device<DeviceScene>(ordinal)) {
        const CurrentDevice current(ordinal);
        check_render_code();
        CudaStream stream;
        on_gpu->set(placed, build_scene_bvh(placed), stream);
    }
};

/// Returns a scene on a GPU. The last one is kept, because pictures are differentiated many times with other cameras.
std::shared_ptr<const PlacedScene> placed_scene(int ordinal, const Assembly& scene, const Camera& camera) {
    // Never destroyed: while the process ends, the GPU's memory can no longer be freed.
    static auto* const mutex = new std::mutex;
    static auto* const kept = new std::map<int, std::shared_ptr<const PlacedScene>>;
    const std::lock_guard lock(*mutex);
    std::shared_ptr<const PlacedScene>& last = (*kept)[ordinal];
    if (scene_change(last ? &last->placed : nullptr, scene, camera) != SceneChange::none) {
        last.reset();  // freed before the next scene is allocated
        last = std::make_shared<const PlacedScene>(ordinal, scene, camera);
    }
    return last;
}

/// Derivatives of a picture on a GPU.
class CudaGradient final : public CameraGradient {
public:
    CudaGradient(int ordinal, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                 std::vector<LensVariable> variables, const PupilTracer& tracer)
        : CameraGradient(scene, camera, settings, std::move(variables), tracer),
          ordinal_(ordinal),
          used_numbers_(path_.numbers_in_use()) {
        if (!gpu_differentiates(camera.lens))
            throw InputError("derivatives of pictures on a GPU do not support freeform surfaces, and lens \"" +
                             camera.lens.name + "\" has one; use device=\"cpu\"");
        scene_ = placed_scene(ordinal, scene, camera);
        const RenderSpaceScene& placed = scene_->placed;
        scene_moves_ = placed.moves();
        device_ =
            make_on_device<DeviceGradient>(ordinal, *scene_->on_gpu, setup_->view(placed.origin_m(), placed.moves()),
                                           settings.path(), film_, path_, used_numbers_, outline_);
    }

    std::vector<float> picture(const GradientSamples& samples, const KeepGoing& keep_going) override {
        const CurrentDevice current(ordinal_);
        const CudaStream& stream = device_->stream();
        const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
        device_->picture.resize(pixels);
        device_->picture.clear(stream);
        for_parts(samples.seed, samples.spp, samples.pairs, kFilmLaunch, keep_going, [&](const GradientPart& part) {
            sample_film(part, samples.uniform);
            launch_add_filtered(device_->job(), settings_.filter, part, device_->rays.data(), device_->picture.data(),
                                stream);
        });
        std::vector<FilteredPixel> sums(pixels);
        device_->picture.download(sums.data(), stream);
        stream.wait("copying a picture from it");
        const double scale = exposure_per_sample(samples.spp);
        std::vector<float> exposure(3 * pixels);
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t k = 0; k < 3; ++k) exposure[3 * i + k] = static_cast<float>(scale * sums[i].sums[k]);
        return exposure;
    }

    std::vector<double> reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                const KeepGoing& keep_going) override {
        const CurrentDevice current(ordinal_);
        const CudaStream& stream = device_->stream();
        const std::vector<float> of_control = adjoint_of_control(adjoint, control);
        const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
        device_->adjoint.upload(adjoint, 3 * pixels, stream);
        device_->control.upload(of_control.data(), of_control.size(), stream);
        const auto sum_count = static_cast<std::size_t>(device_->job().sum_count);
        const AdjointFilm film{settings_.filter, width(), height(), device_->adjoint.data(),
                               control ? device_->control.data() : nullptr};
        device_->totals.resize(sum_count);
        device_->totals.clear(stream);
        device_->unexplained.resize(1);
        device_->unexplained.clear(stream);
        if (samples.interior) add_interior(film, samples, keep_going);
        if (samples.boundary) add_boundary(film, samples, keep_going);
        std::vector<double> totals(sum_count);
        unsigned long long unexplained = 0;
        device_->totals.download(totals.data(), stream);
        device_->unexplained.download(&unexplained, stream);
        stream.wait("copying derivatives from it");
        unexplained_ = static_cast<std::int64_t>(unexplained);
        edges_ = samples.boundary ? sample_count(samples.outline_spp) : 0;
        return by_all_numbers(derivatives_of(totals.data()), totals[sum_count - 2], totals[sum_count - 1]);
    }

    std::vector<float> forward(const std::vector<double>&, const float*, const GradientSamples&,
                               const KeepGoing&) override {
        throw InputError("derivatives of pictures in forward mode run on the CPU: use device=\"cpu\"");
    }

private:
    std::int64_t sample_count(int spp) const {
        return std::int64_t{film_.extended_width()} * film_.extended_height() * spp;
    }

    /// Calls f(part) for parts of all samples, of at most `most` samples each, and waits for each. `pairs`: see
    /// GradientPart.
    template <class F>
    void for_parts(std::uint32_t seed, int spp, bool pairs, std::int64_t most, const KeepGoing& keep_going, F&& f) {
        const std::int64_t count = sample_count(spp);
        for (std::int64_t first = 0; first < count; first += most) {
            if (keep_going && !keep_going()) throw Cancelled();
            f(GradientPart{seed, spp, pairs, first, static_cast<int>(std::min(most, count - first))});
            device_->stream().wait("differentiating a picture");
        }
    }

    /// Samples rays on the film with their light.
    void sample_film(const GradientPart& part, bool uniform) {
        device_->rays.resize(static_cast<std::size_t>(part.count));
        launch_sample_film(device_->job(), part, device_->rays.data(), device_->stream());
        if (!uniform) launch_trace_light(device_->job(), part, part.count, device_->rays.data(), device_->stream());
    }

    // Adds a term to the totals.
    void add_interior(const AdjointFilm& film, const GradientSamples& samples, const KeepGoing& keep_going) {
        const double scale = exposure_per_sample(samples.spp);
        const Vec2d per_mm = pixels_per_mm(), factors = {scale * per_mm.x, scale * per_mm.y};
        for_parts(samples.seed, samples.spp, samples.pairs, kFilmLaunch, keep_going, [&](const GradientPart& part) {
            sample_film(part, samples.uniform);
            add_sums(part.count, [&](double* sums) {
                launch_film_tangents(device_->job(), film, factors, part.count, device_->rays.data(), sums,
                                     device_->stream());
            });
        });
    }
    void add_boundary(const AdjointFilm& film, const GradientSamples& samples, const KeepGoing& keep_going) {
        const double scale = exposure_per_sample(samples.outline_spp);
        const std::uint32_t seed = samples.outline_seed();
        for_parts(seed, samples.outline_spp, false, kOutlineLaunch, keep_going, [&](const GradientPart& part) {
            const int points = kMostOutlinePoints * part.count;
            device_->rays.resize(static_cast<std::size_t>(points));
            device_->edges.resize(static_cast<std::size_t>(points));
            launch_find_outline(device_->job(), part, device_->edges.data(), device_->rays.data(),
                                device_->unexplained.data(), device_->stream());
            if (!samples.uniform)
                launch_trace_light(device_->job(), part, points, device_->rays.data(), device_->stream());
            add_sums(points, [&](double* sums) {
                launch_outline_tangents(device_->job(), film, scale, points, device_->edges.data(),
                                        device_->rays.data(), sums, device_->stream());
            });
        });
    }

    /// Calls launch(sums of the warps) for `count` samples, and adds these sums to the totals.
    template <class Launch>
    void add_sums(int count, Launch&& launch) {
        const GradientJob& job = device_->job();
        const std::int64_t warps = gradient_warps(count);
        device_->sums.resize(static_cast<std::size_t>(warps * job.sum_count));
        launch(device_->sums.data());
        launch_add_sums(job.sum_count, warps, device_->sums.data(), device_->totals.data(), device_->stream());
    }

    /// Returns the derivatives that follow from the totals of all rays, in the order of WarpSums; the last two are the
    /// derivatives by the stop and the rims.
    CameraDerivatives derivatives_of(const double* total) const {
        TangentPath::Sums sums(path_);
        for (int number = 0; number < kFrameNumbers; ++number) sums.film.sums[number][0] = *total++;
        for (std::size_t k = 0; k < used_numbers_.size(); ++k)
            for (int number = 0; number < kSurfaceNumbers; ++number)
                if (used_numbers_[k] >> number & 1u) sums.surfaces[k].sums[number][0] = *total++;
        for (auto& lanes : sums.pose) lanes[0] = *total++;
        return path_.derivatives(sums);
    }

    int ordinal_;
    std::vector<std::uint32_t> used_numbers_;  ///< TangentPath::numbers_in_use
    std::shared_ptr<const PlacedScene> scene_;
    OnDevice<DeviceGradient> device_;
};

}  // namespace

std::unique_ptr<CameraGradient> make_cuda_gradient(int ordinal, const Assembly& scene, const Camera& camera,
                                                   const RenderSettings& settings, std::vector<LensVariable> variables,
                                                   const PupilTracer& tracer) {
    return std::make_unique<CudaGradient>(ordinal, scene, camera, settings, std::move(variables), tracer);
}

}  // namespace realcam
