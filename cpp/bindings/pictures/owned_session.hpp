#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "../../devices/devices.hpp"
#include "../../render/session/session.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

/// Owner of a core session used from Python; no session used from Python has another owner.
///
/// There are two locks, the GIL and the session's turn. A thread that waits for the turn does not hold the GIL; the
/// holder of the turn may take the GIL for a while, for signals, warnings and progress functions. The owner's data are
/// written under both locks, and so may be read under either.
class OwnedSession {
public:
    using Make = std::unique_ptr<Session> (*)(const std::string& device, const DeviceNotice& notice);

    /// `make` is called on first use.
    explicit OwnedSession(std::string device, Make make);
    ~OwnedSession();
    OwnedSession(const OwnedSession&) = delete;
    OwnedSession& operator=(const OwnedSession&) = delete;

    /// Returns the process-wide session on a device, which keeps the last scene. All shared sessions have a common
    /// turn, because each uses all cores.
    static OwnedSession& shared(const std::string& device);

    /// Returns work(session), called with the turn and without the GIL. `session` is a std::shared_ptr<Session>. Throws
    /// InputError if called in a progress function or signal handler of work under the same turn, and DeviceError.
    template <class Work>
    auto use(Work&& work) {
        const Unlocked unlocked;
        const Turn turn(*turnstile_);
        return work(made());
    }

    /// Cancels the current work, from any thread. Called with the GIL.
    void cancel(Collected collected) const;

private:
    struct Turnstile {
        std::timed_mutex mutex;
        std::atomic<std::thread::id> holder;
    };
    class Turn {
    public:
        explicit Turn(Turnstile& turnstile);
        ~Turn() { turnstile_.holder = std::thread::id(); }

    private:
        Turnstile& turnstile_;
        std::unique_lock<std::timed_mutex> lock_;
    };

    OwnedSession(std::string device, Make make, std::shared_ptr<Turnstile> turnstile);
    const std::shared_ptr<Session>& made();
    static void cancel_all();

    std::string device_;
    Make make_;
    std::shared_ptr<Turnstile> turnstile_;
    std::shared_ptr<Session> session_;
};

}  // namespace realcam::bindings
