#include "live_frame.hpp"

namespace realcam {

void wait(const LiveFrame& frame, const KeepGoing& keep_going) {
    while (!frame.wait_for(std::chrono::milliseconds(50)))
        if (keep_going && !keep_going()) throw Cancelled();
}

}  // namespace realcam
