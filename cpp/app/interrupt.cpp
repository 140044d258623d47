#include "interrupt.hpp"

#include <csignal>

namespace realcam::app {
namespace {

volatile std::sig_atomic_t received = 0;  // number of the last signal; 0 before the first
volatile std::sig_atomic_t is_last = 0;   // 1 after SIGTERM or a second signal

void record(int signal) {
    if (received != 0 || signal != SIGINT) is_last = 1;
    received = signal;
}

void set_handler(void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;  // restarts a write that the signal interrupts
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() {
    received = 0;
    is_last = 0;
    set_handler(record);
}

Interrupt::~Interrupt() {
    set_handler(SIG_DFL);
}

int Interrupt::signal() {
    return received;
}

bool Interrupt::is_final() {
    return is_last != 0;
}

}  // namespace realcam::app
