#pragma once
#include <memory>
#include <mutex>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// Keeps the last camera that was made ready, because its pupil serves the next one if lens and film are equal. Several
/// threads may use it.
class LastSetup {
public:
    /// Throws InputError, and keeps the last one then.
    std::shared_ptr<const CameraSetup> make(const Camera& camera, const PupilTracer& tracer,
                                            const LensEffects& effects = {}) {
        // Not locked while the pupil is found: another thread's camera may be ready at once.
        const std::shared_ptr<const CameraSetup> last = get();
        auto setup = std::make_shared<const CameraSetup>(camera, tracer, last.get(), effects);
        const std::lock_guard lock(mutex_);
        return setup_ = std::move(setup);
    }

private:
    std::shared_ptr<const CameraSetup> get() const {
        const std::lock_guard lock(mutex_);
        return setup_;
    }

    mutable std::mutex mutex_;
    std::shared_ptr<const CameraSetup> setup_;
};

}  // namespace REALCAM_NAMESPACE
