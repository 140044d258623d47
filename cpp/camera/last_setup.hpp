#pragma once
#include <memory>
#include <mutex>

#include "camera_setup.hpp"

namespace REALCAM_NAMESPACE {

/// Keeps the last camera that was made ready, because its pupil serves the next one if lens and film are equal. Several
/// threads may use it.
class LastSetup {
public:
    /// Throws InputError, and keeps the last one then.
    std::shared_ptr<const CameraSetup> make(const Camera& camera, const PupilTracer& tracer,
                                            const LensEffects& effects = {}, PupilStart start = PupilStart::anew);

private:
    std::shared_ptr<const CameraSetup> get() const;

    mutable std::mutex mutex_;
    std::shared_ptr<const CameraSetup> setup_;
};

}  // namespace REALCAM_NAMESPACE
