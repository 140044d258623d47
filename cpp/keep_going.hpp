#pragma once
#include <functional>

namespace realcam {

/// Called by long tasks at least every tenth of a second, on the thread that started them; if it returns false, the
/// task ends by throwing Cancelled. Empty: the task is never stopped.
using KeepGoing = std::function<bool()>;

}  // namespace realcam
