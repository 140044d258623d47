#pragma once
#include <chrono>
#include <mutex>

#include "../error.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

/// Held while a session of session_for works for Python: it takes one picture, so that they come one after the other,
/// whichever threads ask. Taken without the interpreter's lock. Throws InputError where this thread holds it already,
/// which only a progress function that takes a picture can bring about.
class RenderTurn {
public:
    RenderTurn() : lock_(mutex(), std::defer_lock) {
        if (taken_here()) throw InputError("a picture cannot be taken from the progress function of another one");
        while (!lock_.try_lock_for(std::chrono::milliseconds(50))) heed_signals();
        stop_at_exit();
        taken_here() = true;
    }
    ~RenderTurn() { taken_here() = false; }
    RenderTurn(const RenderTurn&) = delete;
    RenderTurn& operator=(const RenderTurn&) = delete;

private:
    static std::timed_mutex& mutex() {
        static std::timed_mutex one;
        return one;
    }
    static bool& taken_here() {
        thread_local bool taken = false;
        return taken;
    }
    std::unique_lock<std::timed_mutex> lock_;
};

}  // namespace realcam::bindings
