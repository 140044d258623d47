#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "../devices/devices.hpp"
#include "../render/session.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

/// A session of the core that Python uses; sessions for Python have no other owner.
///
/// There are two locks, the interpreter's and the session's turn. A thread that waits for the turn does not hold the
/// interpreter's lock; the holder of the turn may take the interpreter's lock for a while, for signals, warnings and
/// progress functions. Data of the owner are written under both locks, and so may be read under either.
class OwnedSession {
public:
    using Make = std::unique_ptr<Session> (*)(const std::string& device, const DeviceNotice& notice);

    /// `make` is called at the first use.
    explicit OwnedSession(std::string device, Make make);
    ~OwnedSession();
    OwnedSession(const OwnedSession&) = delete;
    OwnedSession& operator=(const OwnedSession&) = delete;

    /// The process's session on a device, which keeps the last scene. These sessions have one turn together, as each
    /// works with all cores.
    static OwnedSession& shared(const std::string& device);

    /// Returns work(session), which holds the turn and not the interpreter's lock. `session` is a
    /// std::shared_ptr<Session>. Throws InputError in a progress function or a signal handler of work under the same
    /// turn, and DeviceError.
    template <class Work>
    auto use(Work&& work) {
        const Unlocked unlocked;
        const Turn turn(*turnstile_);
        return work(made());
    }

    /// Ends the work under way, from any thread. Called with the interpreter's lock.
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
