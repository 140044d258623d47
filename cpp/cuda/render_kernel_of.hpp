#pragma once
#include "../camera/effects.hpp"
#include "render_kernel.hpp"

namespace realcam {

using RenderKernel = void (*)(RenderJob, int);

/// The kernel for a kind of lens and of scene, and a set of effects by its number. `instanced`: whether there is
/// anything but static geometry. `halves`: it sums those of dual pixels.
template <LensKind lens_kind, SceneKind scene_kind, int effects, bool halves>
RenderKernel render_kernel_of(bool instanced);

}  // namespace realcam
