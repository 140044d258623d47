#include <csignal>

#include "command_line.hpp"

int main(int argc, char** argv) {
    // Exceeding a limit on file sizes then makes the write fail with an error, which is reported and leaves no partial
    // file.
    std::signal(SIGXFSZ, SIG_IGN);
    return realcam::app::run_command_line(argc, argv);
}
