#pragma once
#include <cstdint>
#include <memory>

#include "../camera/develop.hpp"
#include "../render/backend.hpp"
#include "shared_device_array.hpp"

namespace realcam {

/// One picture of a live view, on its way from the GPU. May outlive the view.
class LiveFrame {
public:
    virtual ~LiveFrame() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual std::int64_t samples() const = 0;  ///< per pixel, collected up to this frame
    virtual bool ready() const = 0;
    /// height x width x 3, 8-bit sRGB; waits for it. Throws DeviceError, and Cancelled where it was stopped before its
    /// end.
    virtual const std::uint8_t* codes() const = 0;
};

/// A picture in a GPU's memory. float32, as Image: exposure (height, width, 3) and depth (height, width).
struct DevicePicture {
    SharedDeviceArray exposure, depth;
};

/// A scene before a camera that changes with every frame, on one GPU. Only what changed is copied there: the camera, or
/// instance transforms. Samples are collected for as long as both stay the same. Not for two threads at once, but
/// for cancel.
class LiveView {
public:
    /// Throws InputError and DeviceError.
    LiveView(int ordinal, Assembly scene, PupilTracer tracer);
    ~LiveView();
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    /// Starts to take settings.spp more samples of each pixel, and returns while they are taken: the next frame may be
    /// started before this one is there. With kFramesInFlight under way it waits for the oldest. A different camera,
    /// seed or number of bounces begins a new picture; exposure time, ISO and tone curve only develop it anew.
    std::shared_ptr<const LiveFrame> shoot(const Camera& camera, const RenderSettings& settings, ToneCurve curve);

    /// The scene of the frames to come. Of one in which only transforms differ, only these are copied.
    /// Throws InputError.
    void show(Assembly scene);

    /// What all frames up to the last have collected, on the GPU; waits for them. Throws InputError where there is no
    /// picture, Cancelled where another thread stops it meanwhile, and DeviceError.
    DevicePicture picture() const;

    /// Gives up all frames under way, from any thread: no sample is begun any more, so that it takes the time of one,
    /// some milliseconds. The next frame begins a new picture.
    void cancel();

    static constexpr int kFramesInFlight = 3;

private:
    class Work;
    std::unique_ptr<Work> work_;
};

}  // namespace realcam
