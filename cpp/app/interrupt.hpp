#pragma once

namespace realcam::app {

/// While an object lives, Ctrl-C and SIGTERM are recorded and do not end the program, so that it leaves no partial file
/// behind. At other times they end it, as usual.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    /// Number of the last signal received; 0 before the first.
    static int signal();
    /// Returns true after SIGTERM or a second Ctrl-C: the program must end without writing anything more.
    static bool is_final();
};

}  // namespace realcam::app
