#include "live_view.hpp"

#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "../render/sample_range.hpp"
#include "host_scene.hpp"
#include "on_device.hpp"
#include "pinned_array.hpp"
#include "share_array.hpp"

namespace realcam {
namespace {

/// What a frame leaves in memory of the host.
struct FrameMemory {
    explicit FrameMemory(std::size_t size) : codes(size), stopped(1) {}

    PinnedArray<std::uint8_t> codes;
    PinnedArray<int> stopped;  ///< not 0: it may hold fewer samples than it should
};

/// Memory for pictures that is used again when nobody holds it any more: pinning it takes longer than a frame.
class FramePool {
public:
    std::shared_ptr<FrameMemory> take(std::size_t size) {
        std::erase_if(frames_,
                      [&](const auto& frame) { return frame.use_count() == 1 && frame->codes.size() != size; });
        for (const auto& frame : frames_)
            if (frame.use_count() == 1) return frame;
        return frames_.emplace_back(std::make_shared<FrameMemory>(size));
    }

private:
    std::vector<std::shared_ptr<FrameMemory>> frames_;
};

class Frame final : public LiveFrame {
public:
    /// Made by make_on_device.
    Frame(int width, int height, std::int64_t samples, std::shared_ptr<FrameMemory> memory)
        : width_(width), height_(height), samples_(samples), memory_(std::move(memory)) {}

    int width() const override { return width_; }
    int height() const override { return height_; }
    std::int64_t samples() const override { return samples_; }
    bool ready() const override { return end_.reached(); }
    const std::uint8_t* codes() const override {
        wait();
        if (*memory_->stopped.data()) throw Cancelled();
        return memory_->codes.data();
    }

    /// Starts to develop it, behind all that exposes it.
    void develop(DeviceRenderer& renderer, const Camera& camera, ToneCurve curve) {
        renderer.develop_codes(samples_, camera.exposure_time_s, camera.iso, curve, memory_->codes.data());
        renderer.stop_flag().download(memory_->stopped.data(), renderer.stream());
        end_.record(renderer.stream());
    }
    void wait() const { end_.wait(); }

private:
    int width_, height_;
    std::int64_t samples_;
    std::shared_ptr<FrameMemory> memory_;
    CudaEvent end_;
};

bool same_picture(const Camera& a, const Camera& b) {
    return a.lens == b.lens && a.film == b.film && a.pose == b.pose && a.model == b.model;
}

}  // namespace

class LiveView::Work {
public:
    Work(int ordinal, Assembly scene, PupilTracer tracer)
        : ordinal_(ordinal),
          renderer_(make_on_device<DeviceRenderer>(ordinal, ordinal)),
          scene_(std::move(scene)),
          tracer_(std::move(tracer)) {
        validate(scene_);
        on_device_.add(*renderer_);
    }
    ~Work() {
        try {
            cancel();
        } catch (const DeviceError&) {
            // A GPU that is lost has nothing to be stopped.
        }
    }

    std::shared_ptr<const LiveFrame> shoot(const Camera& camera, const RenderSettings& settings, ToneCurve curve) {
        validate(settings);
        const std::lock_guard lock(mutex_);
        const CurrentDevice current(ordinal_);
        while (under_way_.size() >= kFramesInFlight) {
            under_way_.front()->wait();
            under_way_.pop_front();
        }
        if (changed_ || !setup_ || !same_picture(camera, setup_->camera()) || settings.seed != settings_.seed ||
            settings.max_bounces != settings_.max_bounces)
            begin(camera, settings);
        expose(settings);
        exposure_time_s_ = camera.exposure_time_s;
        const auto pixels = static_cast<std::size_t>(camera.film.width) * static_cast<std::size_t>(camera.film.height);
        const std::shared_ptr<Frame> frame =
            make_on_device<Frame>(ordinal_, camera.film.width, camera.film.height, samples_, pool_.take(3 * pixels));
        frame->develop(*renderer_, camera, curve);
        under_way_.push_back(frame);
        return frame;
    }

    DevicePicture picture() {
        const std::lock_guard lock(mutex_);
        if (!setup_ || changed_) throw InputError("there is no picture yet; shoot() takes one");
        const CurrentDevice current(ordinal_);
        const Film& film = setup_->camera().film;
        const std::int64_t width = film.width, height = film.height;
        DeviceArray<float> exposure(static_cast<std::size_t>(3 * width * height)),
            depth(static_cast<std::size_t>(width * height));
        renderer_->develop_here(samples_, exposure_time_s_, exposure.data(), depth.data());
        int stopped = 0;
        renderer_->stop_flag().download(&stopped, renderer_->stream());
        check_cuda(cudaStreamSynchronize(renderer_->stream()), "developing");
        if (stopped) throw Cancelled();
        return {share(std::move(exposure), ordinal_, {height, width, 3}),
                share(std::move(depth), ordinal_, {height, width})};
    }

    /// What is kept of the last picture is how its pupil was found.
    void show(Assembly scene) {
        validate(scene);
        const std::lock_guard lock(mutex_);
        scene_ = std::move(scene);
        changed_ = true;
    }

    void cancel() {
        renderer_->stop_flag().raise();
        const std::lock_guard lock(mutex_);
        for (const auto& frame : under_way_) frame->wait();
        under_way_.clear();
        setup_.reset();
        renderer_->stop_flag().lower();
    }

private:
    void begin(const Camera& camera, const RenderSettings& settings) {
        CameraSetup setup(camera, tracer_, setup_ ? &*setup_ : nullptr);
        setup_.reset();  // whatever fails from here on, the next frame begins anew
        on_device_.place(scene_, camera);
        renderer_->set_camera(setup.view(on_device_.origin_m()));
        renderer_->clear_film(static_cast<std::int64_t>(camera.film.width) * camera.film.height);
        setup_ = std::move(setup);
        settings_ = settings;
        samples_ = 0;
        changed_ = false;
    }

    /// Starts to take the next samples of the picture.
    void expose(RenderSettings settings) {
        for (const std::int64_t end = samples_ + settings.spp; samples_ < end;) {
            const SampleRange range = next_samples(settings_.seed, samples_, end);
            settings.seed = range.seed;
            renderer_->add({0, setup_->camera().film.height, range.first, range.count}, settings);
            samples_ += range.count;
        }
    }

    int ordinal_;
    OnDevice<DeviceRenderer> renderer_;
    FramePool pool_;
    std::mutex mutex_;
    Assembly scene_;
    HostScene on_device_;
    PupilTracer tracer_;
    std::optional<CameraSetup> setup_;  ///< of the picture that is being collected
    RenderSettings settings_;
    std::int64_t samples_ = 0;
    double exposure_time_s_ = 0;  ///< of the last frame
    bool changed_ = false;  ///< the scene, since the picture began
    std::deque<std::shared_ptr<Frame>> under_way_;
};

LiveView::LiveView(int ordinal, Assembly scene, PupilTracer tracer)
    : work_(std::make_unique<Work>(ordinal, std::move(scene), std::move(tracer))) {}

LiveView::~LiveView() = default;

std::shared_ptr<const LiveFrame> LiveView::shoot(const Camera& camera, const RenderSettings& settings,
                                                 ToneCurve curve) {
    return work_->shoot(camera, settings, curve);
}

void LiveView::show(Assembly scene) {
    work_->show(std::move(scene));
}

DevicePicture LiveView::picture() const {
    return work_->picture();
}

void LiveView::cancel() {
    work_->cancel();
}

}  // namespace realcam
