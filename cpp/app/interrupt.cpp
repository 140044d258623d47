#include "interrupt.hpp"

#include <csignal>

namespace realcam::app {
namespace {

volatile std::sig_atomic_t received = 0, is_last = 0;

void take_note(int signal) {
    if (received != 0 || signal != SIGINT) is_last = 1;
    received = signal;
}

void handle(void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;  // restarts an interrupted write
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() {
    received = 0;
    is_last = 0;
    handle(take_note);
}

Interrupt::~Interrupt() {
    handle(SIG_DFL);
}

int Interrupt::signal() {
    return received;
}

bool Interrupt::is_final() {
    return is_last != 0;
}

}  // namespace realcam::app
