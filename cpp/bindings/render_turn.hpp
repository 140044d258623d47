#pragma once
#include <mutex>

#include "../error.hpp"

namespace realcam::bindings {

/// Held while a backend works for Python: it keeps one scene, so that pictures are taken one after the other, whichever
/// threads ask. Taken without the interpreter's lock. Throws InputError where this thread holds it already, which only
/// a progress function that takes a picture can bring about.
class RenderTurn {
public:
    RenderTurn() : lock_(mutex(), std::defer_lock) {
        if (taken_here()) throw InputError("a picture cannot be taken from the progress function of another one");
        lock_.lock();
        taken_here() = true;
    }
    ~RenderTurn() { taken_here() = false; }
    RenderTurn(const RenderTurn&) = delete;
    RenderTurn& operator=(const RenderTurn&) = delete;

private:
    static std::mutex& mutex() {
        static std::mutex one;
        return one;
    }
    static bool& taken_here() {
        thread_local bool taken = false;
        return taken;
    }
    std::unique_lock<std::mutex> lock_;
};

}  // namespace realcam::bindings
