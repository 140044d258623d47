#pragma once
#include <chrono>
#include <cstdint>

#include "../error.hpp"
#include "../keep_going.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// One picture of a session, on its way from the device. May outlive the session.
class LiveFrame {
public:
    virtual ~LiveFrame() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual std::int64_t samples() const = 0;  ///< per pixel, collected up to this frame
    /// Waits until it is there, or for so long; returns whether it is there. Throws DeviceError.
    virtual bool wait_for(std::chrono::microseconds longest) const = 0;
    /// height x width x 3, 8-bit sRGB; waits for it. Throws DeviceError, and Cancelled where it was stopped before its
    /// end.
    virtual const std::uint8_t* codes() const = 0;
};

/// Until it is there. Throws Cancelled where the caller does not want to wait any longer, and DeviceError.
void wait(const LiveFrame& frame, const KeepGoing& keep_going);

}  // namespace REALCAM_NAMESPACE
