#pragma once
#include <functional>

namespace realcam {

/// Asked by long work at least every tenth of a second, on the thread that began it; where it returns false, the work
/// ends by throwing Cancelled. Empty: nobody stops it.
using KeepGoing = std::function<bool()>;

}  // namespace realcam
