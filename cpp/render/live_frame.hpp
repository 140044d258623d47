#pragma once
#include <chrono>
#include <cstdint>

#include "../error.hpp"
#include "../keep_going.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// One picture of a session while the device works on it. May outlive the session.
class LiveFrame {
public:
    virtual ~LiveFrame() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual std::int64_t samples() const = 0;  ///< per pixel, accumulated up to this frame
    /// Waits until the frame is complete, at most for `longest`; returns true if it is. Throws DeviceError.
    virtual bool wait_for(std::chrono::microseconds longest) const = 0;
    /// height x width x 3, 8-bit sRGB; waits until the frame is complete. Throws DeviceError, and Cancelled if the
    /// frame was stopped before its end.
    virtual const std::uint8_t* codes() const = 0;
};

/// Waits until the frame is complete. Throws Cancelled if `keep_going` returns false, and DeviceError.
void wait(const LiveFrame& frame, const KeepGoing& keep_going);

}  // namespace REALCAM_NAMESPACE
