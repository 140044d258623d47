#include "last_setup.hpp"

#include <utility>

namespace realcam {

std::shared_ptr<const CameraSetup> LastSetup::make(const Camera& camera, const PupilTracer& tracer,
                                                   const LensEffects& effects, PupilStart start) {
    // The lock is not held during the search of the pupil, so that no thread waits for another thread's camera.
    const std::shared_ptr<const CameraSetup> last = get();
    auto setup = std::make_shared<const CameraSetup>(camera, tracer, last.get(), effects, start);
    const std::lock_guard lock(mutex_);
    return setup_ = std::move(setup);
}

std::shared_ptr<const CameraSetup> LastSetup::get() const {
    const std::lock_guard lock(mutex_);
    return setup_;
}

}  // namespace realcam
