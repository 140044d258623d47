#include "live_view.hpp"

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "host_scene.hpp"
#include "pinned_array.hpp"
#include "share_array.hpp"

namespace realcam {
namespace {

/// Set by the host while kernels run, and read by every thread of them: from the GPU's memory, because reading the
/// host's takes longer than a frame.
class StopFlag {
public:
    StopFlag() : values_(2), flag_(1) {
        values_.data()[0] = 0;
        values_.data()[1] = 1;
        set(false);
    }
    void set(bool stop) {
        is_set_ = stop;
        check_cuda(cudaMemcpyAsync(flag_.data(), values_.data() + stop, sizeof(int), cudaMemcpyHostToDevice, stream_),
                   "stopping it");
        stream_.wait("stopping it");
    }
    bool is_set() const { return is_set_; }
    const volatile int* data() const { return flag_.data(); }

private:
    CudaStream stream_;  // of its own, beside the work that it stops
    PinnedArray<int> values_;
    DeviceArray<int> flag_;
    std::atomic<bool> is_set_{false};
};

using Codes = PinnedArray<std::uint8_t>;

/// Memory for pictures that is used again when nobody holds it any more: pinning it takes longer than a frame.
class CodesPool {
public:
    std::shared_ptr<Codes> take(std::size_t size) {
        std::erase_if(arrays_, [&](const auto& array) { return array.use_count() == 1 && array->size() != size; });
        for (const auto& array : arrays_)
            if (array.use_count() == 1) return array;
        return arrays_.emplace_back(std::make_shared<Codes>(size));
    }

private:
    std::vector<std::shared_ptr<Codes>> arrays_;
};

class Frame final : public LiveFrame {
public:
    Frame(int width, int height, int samples, std::shared_ptr<Codes> codes)
        : width_(width), height_(height), samples_(samples), codes_(std::move(codes)) {}

    int width() const override { return width_; }
    int height() const override { return height_; }
    int samples() const override { return samples_; }
    bool ready() const override { return end_.reached(); }
    const std::uint8_t* codes() const override {
        wait();
        if (cancelled_) throw Cancelled();
        return codes_->data();
    }

    std::uint8_t* data() { return codes_->data(); }
    void record(cudaStream_t stream) { end_.record(stream); }
    void cancel() { cancelled_ = true; }
    void wait() const { end_.wait(); }

private:
    int width_, height_, samples_;
    std::shared_ptr<Codes> codes_;
    CudaEvent end_;
    std::atomic<bool> cancelled_{false};
};

bool same_picture(const Camera& a, const Camera& b) {
    return a.lens == b.lens && a.film == b.film && a.pose == b.pose && a.model == b.model;
}

}  // namespace

class LiveView::Work {
public:
    Work(int ordinal, Assembly scene, PupilTracer tracer)
        : renderer_(ordinal), scene_(std::move(scene)), tracer_(std::move(tracer)) {
        validate(scene_);
        on_device_.add(renderer_);
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
        while (under_way_.size() >= kFramesInFlight) {
            under_way_.front()->wait();
            if (stop_.is_set()) under_way_.front()->cancel();
            under_way_.pop_front();
        }
        if (changed_ || !setup_ || !same_picture(camera, setup_->camera()) || settings.seed != settings_.seed ||
            settings.max_bounces != settings_.max_bounces)
            begin(camera, settings);
        const auto pixels = static_cast<std::size_t>(camera.film.width) * static_cast<std::size_t>(camera.film.height);
        auto frame = std::make_shared<Frame>(camera.film.width, camera.film.height, samples_ + settings.spp,
                                             pool_.take(3 * pixels));
        renderer_.add(
            {0, camera.film.height, static_cast<std::uint32_t>(samples_), static_cast<std::uint32_t>(settings.spp)},
            settings, stop_.data());
        samples_ = frame->samples();
        exposure_time_s_ = camera.exposure_time_s;
        renderer_.develop_codes(samples_, camera.exposure_time_s, camera.iso, curve, frame->data());
        frame->record(renderer_.stream());
        under_way_.push_back(frame);
        return frame;
    }

    DevicePicture picture() {
        const std::lock_guard lock(mutex_);
        if (!setup_ || changed_) throw InputError("there is no picture yet; shoot() takes one");
        const Film& film = setup_->camera().film;
        const std::int64_t width = film.width, height = film.height;
        renderer_.bind();
        DeviceArray<float> exposure(static_cast<std::size_t>(3 * width * height)),
            depth(static_cast<std::size_t>(width * height));
        renderer_.develop_here(samples_, exposure_time_s_, exposure.data(), depth.data());
        check_cuda(cudaStreamSynchronize(renderer_.stream()), "developing");
        return {share(std::move(exposure), renderer_.ordinal(), {height, width, 3}),
                share(std::move(depth), renderer_.ordinal(), {height, width})};
    }

    /// What is kept of the last picture is how its pupil was found.
    void show(Assembly scene) {
        validate(scene);
        const std::lock_guard lock(mutex_);
        scene_ = std::move(scene);
        changed_ = true;
    }

    void cancel() {
        stop_.set(true);
        const std::lock_guard lock(mutex_);
        for (const auto& frame : under_way_) {
            frame->cancel();
            frame->wait();
        }
        under_way_.clear();
        setup_.reset();
        stop_.set(false);
    }

private:
    void begin(const Camera& camera, const RenderSettings& settings) {
        CameraSetup setup(camera, tracer_, setup_ ? &*setup_ : nullptr);
        setup_.reset();  // whatever fails from here on, the next frame begins anew
        on_device_.place(scene_, camera);
        renderer_.set_camera(setup.view(on_device_.origin_m()));
        renderer_.clear_film(static_cast<std::int64_t>(camera.film.width) * camera.film.height);
        setup_ = std::move(setup);
        settings_ = settings;
        samples_ = 0;
        changed_ = false;
    }

    DeviceRenderer renderer_;
    StopFlag stop_;
    CodesPool pool_;
    std::mutex mutex_;
    Assembly scene_;
    HostScene on_device_;
    PupilTracer tracer_;
    std::optional<CameraSetup> setup_;  ///< of the picture that is being collected
    RenderSettings settings_;
    int samples_ = 0;
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
