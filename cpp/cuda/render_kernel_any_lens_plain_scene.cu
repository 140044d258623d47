#include "render_kernel_template.hpp"

namespace realcam {

template RenderKernel render_kernel_of<LensKind::any, SceneKind::plain>(bool, bool);

}  // namespace realcam
