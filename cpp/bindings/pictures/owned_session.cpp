#include "owned_session.hpp"

#include <chrono>
#include <map>
#include <set>
#include <vector>

#include "../../error.hpp"

namespace realcam::bindings {

namespace {

/// Owners whose work is cancelled when Python exits, guarded by the GIL. Shared sessions are not included: their calls
/// check for the exit themselves, and a user's progress function may never return.
std::set<const OwnedSession*>& owners() {
    static auto* const set = new std::set<const OwnedSession*>;
    return *set;
}

}  // namespace

OwnedSession::OwnedSession(std::string device, Make make)
    : OwnedSession(std::move(device), make, std::make_shared<Mutex>()) {
    static const bool is_stopped_at_exit = (call_at_exit(&cancel_all), true);
    static_cast<void>(is_stopped_at_exit);
    owners().insert(this);
}

OwnedSession::OwnedSession(std::string device, Make make, std::shared_ptr<Mutex> mutex)
    : device_(std::move(device)), make_(make), mutex_(std::move(mutex)) {}

OwnedSession::~OwnedSession() {
    owners().erase(this);
    // Leaks the session, whose destructor would wait for threads that a forked process does not have.
    if (has_lost_threads()) static_cast<void>(new std::shared_ptr<Session>(std::move(session_)));
}

OwnedSession& OwnedSession::shared(const std::string& device) {
    // The GIL guards the map: this function neither runs Python code nor waits.
    static auto* const sessions = new std::map<std::string, OwnedSession*>;
    static auto* const mutex = new std::shared_ptr<Mutex>(std::make_shared<Mutex>());
    OwnedSession*& session = (*sessions)[device];
    if (!session) session = new OwnedSession(device, &make_session, *mutex);
    return *session;
}

void OwnedSession::cancel(OnCancel collected) const {
    const std::shared_ptr<Session> session = session_;
    if (!session) return;
    const Unlocked unlocked;
    session->cancel(collected);
}

const std::shared_ptr<Session>& OwnedSession::session() {
    if (session_) return session_;
    std::shared_ptr<Session> session = make_(device_, warn);
    const py::gil_scoped_acquire acquire;
    session_ = std::move(session);
    return session_;
}

void OwnedSession::cancel_all() {
    std::vector<std::shared_ptr<Session>> sessions;
    {
        const py::gil_scoped_acquire acquire;
        for (const OwnedSession* const owner : owners())
            if (owner->session_) sessions.push_back(owner->session_);
    }
    for (const auto& session : sessions) {
        try {
            session->cancel(OnCancel::drop);
        } catch (const DeviceError&) {
            // A lost GPU runs no kernels that could be stopped.
        }
    }
}

OwnedSession::Lock::Lock(Mutex& mutex) : mutex_(mutex), lock_(mutex.mutex, std::defer_lock) {
    if (mutex.holder == std::this_thread::get_id())
        throw InputError(
            "a progress function or a signal handler cannot take a picture with the session whose work it interrupts");
    while (!lock_.try_lock_for(std::chrono::milliseconds(50))) heed_signals();
    stop_at_exit();
    mutex.holder = std::this_thread::get_id();
}

}  // namespace realcam::bindings
