#include <csignal>

#include "command_line.hpp"

int main(int argc, char** argv) {
    // A limit on file sizes is then an error of the write, which is told, and leaves nothing behind.
    std::signal(SIGXFSZ, SIG_IGN);
    return realcam::app::run_command_line(argc, argv);
}
