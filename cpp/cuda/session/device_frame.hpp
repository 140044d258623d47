#pragma once
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "../../camera/film/camera.hpp"
#include "../../render/session/live_frame.hpp"
#include "../device/device_array.hpp"
#include "device_renderer.hpp"

namespace realcam {

/// Pinned host memory to which the GPU writes a frame.
struct FrameMemory {
    /// `size`: number of 8-bit values.
    explicit FrameMemory(std::size_t size) : codes(size), stopped(/*count=*/1) {}

    PinnedArray<std::uint8_t> codes;  ///< 8-bit sRGB, 3 per pixel
    PinnedArray<int> stopped;  ///< one number; if it is not 0, the frame was stopped and may lack samples
};

/// Pool of frame memory, which is reused after a frame is released: pinning memory takes longer than rendering a frame.
class FramePool {
public:
    /// Returns memory of a size that no frame uses, and frees unused memory of all other sizes.
    std::shared_ptr<FrameMemory> acquire(std::size_t size) {
        std::erase_if(frames_,
                      [&](const auto& frame) { return frame.use_count() == 1 && frame->codes.size() != size; });
        for (const auto& frame : frames_)
            if (frame.use_count() == 1) return frame;
        return frames_.emplace_back(std::make_shared<FrameMemory>(size));
    }

private:
    std::vector<std::shared_ptr<FrameMemory>> frames_;
};

/// Live frame rendered on a GPU. Created by make_on_device.
class DeviceFrame final : public LiveFrame {
public:
    /// `samples`: see LiveFrame::samples.
    DeviceFrame(const Film& film, std::int64_t samples, FramePool& pool)
        : width_(film.width),
          height_(film.height),
          samples_(samples),
          memory_(pool.acquire(std::size_t{3} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_))) {
    }

    int width() const override { return width_; }
    int height() const override { return height_; }
    std::int64_t samples() const override { return samples_; }
    bool wait_for(std::chrono::microseconds timeout) const override {
        // Spins at first: a frame takes a few milliseconds, and a sleeping thread wakes up late.
        constexpr auto kSpinTime = std::chrono::milliseconds(5);
        const auto start = std::chrono::steady_clock::now();
        while (!end_.reached()) {
            const auto waited = std::chrono::steady_clock::now() - start;
            if (waited >= timeout) return false;
            if (waited < kSpinTime)
                std::this_thread::yield();
            else
                std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
        return true;
    }
    const std::uint8_t* codes() const override {
        end_.wait();
        if (*memory_->stopped.data()) throw Cancelled();
        return memory_->codes.data();
    }

    /// Queues the development of the frame in the renderer's stream, after the launches that take its samples.
    void develop(DeviceRenderer& renderer, const FilmControlVariates& control_variates, double exposure_s, double iso,
                 ToneCurve curve) {
        renderer.develop_codes(control_variates, exposure_s, iso, curve, memory_->codes.data());
        renderer.stop_flag().download(memory_->stopped.data(), renderer.stream());
        end_.record(renderer.stream());
    }

private:
    int width_, height_;
    std::int64_t samples_;
    std::shared_ptr<FrameMemory> memory_;
    CudaEvent end_;  ///< after all work of the frame
};

}  // namespace realcam
