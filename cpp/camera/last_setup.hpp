#pragma once
#include <memory>
#include <mutex>

#include "camera_setup.hpp"

namespace REALCAM_NAMESPACE {

/// Cache of the last camera set-up, whose pupil serves the next one if lens and film are equal. Thread-safe.
class LastSetup {
public:
    /// Throws InputError; the last set-up is kept then.
    std::shared_ptr<const CameraSetup> make(const Camera& camera, const PupilTracer& tracer,
                                            const LensEffects& effects = {},
                                            PupilStart start = PupilStart::from_scratch);

private:
    std::shared_ptr<const CameraSetup> get() const;

    mutable std::mutex mutex_;
    std::shared_ptr<const CameraSetup> setup_;
};

}  // namespace REALCAM_NAMESPACE
