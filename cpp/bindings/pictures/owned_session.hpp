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
/// There are two locks, the GIL and the session's lock. A thread that waits for the session's lock does not hold the
/// GIL; the holder of the session's lock may acquire the GIL for a while, for signals, warnings and progress functions.
/// The owner's data are written under both locks, and so may be read under either.
class OwnedSession {
public:
    /// Creates a session on a device. `notice` receives warnings.
    using Make = std::unique_ptr<Session> (*)(const std::string& device, const DeviceNotice& notice);

    /// `make` is called on first use. The work of the session is cancelled when Python exits.
    explicit OwnedSession(std::string device, Make make);
    ~OwnedSession();
    OwnedSession(const OwnedSession&) = delete;
    OwnedSession& operator=(const OwnedSession&) = delete;

    /// Returns the process-wide session on a device, which retains the last scene. All shared sessions have a common
    /// lock, because each uses all cores.
    static OwnedSession& shared(const std::string& device);

    /// Returns work(session), called with the session's lock and without the GIL. `session` is a
    /// std::shared_ptr<Session>. Throws InputError if called in a progress function or signal handler of work under the
    /// same lock, and DeviceError.
    template <class Work>
    auto use(Work&& work) {
        const Unlocked unlocked;
        const Lock lock(*mutex_);
        return work(session());
    }

    /// Cancels the current work, from any thread. `collected`: whether samples taken so far are kept. Must be called
    /// with the GIL.
    void cancel(OnCancel collected) const;

private:
    struct Mutex {
        std::timed_mutex mutex;
        std::atomic<std::thread::id> holder;  ///< the default id if no thread holds the mutex
    };
    /// Holds the session's lock for its lifetime. While it waits, signals are handled.
    class Lock {
    public:
        explicit Lock(Mutex& mutex);
        ~Lock() { mutex_.holder = std::thread::id(); }

    private:
        Mutex& mutex_;
        std::unique_lock<std::timed_mutex> lock_;
    };

    OwnedSession(std::string device, Make make, std::shared_ptr<Mutex> mutex);
    /// Returns the session, which is created on first use. Must be called with the session's lock and without the GIL.
    const std::shared_ptr<Session>& session();
    /// Cancels the work of all owners that are not shared. Must be called without the GIL.
    static void cancel_all();

    std::string device_;
    Make make_;
    std::shared_ptr<Mutex> mutex_;
    std::shared_ptr<Session> session_;
};

}  // namespace realcam::bindings
