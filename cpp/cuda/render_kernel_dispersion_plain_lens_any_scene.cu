#include "render_kernel_template.hpp"

namespace realcam {

template RenderKernel render_kernel_of<LensKind::plain, SceneKind::any, number_of(kDispersion)>(bool, bool);

}  // namespace realcam
