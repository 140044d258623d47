#pragma once
#include "../camera/effects.hpp"
#include "render_kernel.hpp"

namespace realcam {

using RenderKernel = void (*)(RenderJob, int);

/// Returns the kernel for a lens kind, a scene kind and the index of a set of effects. `instanced`: true if the scene
/// has instances. `halves`: true if it sums the halves of dual pixels.
template <LensKind lens_kind, SceneKind scene_kind, int effects, bool halves>
RenderKernel render_kernel_of(bool instanced);

}  // namespace realcam
