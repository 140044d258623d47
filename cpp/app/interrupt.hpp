#pragma once

namespace realcam::app {

/// While it lives, Ctrl-C and SIGTERM are taken note of and do not end the program, so that it can leave without half a
/// file behind. At other times they end it, as usual.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    /// The last signal that came; 0: none.
    static int signal();
    /// Returns true after a second Ctrl-C or SIGTERM: nothing more is to be written.
    static bool is_final();
};

}  // namespace realcam::app
