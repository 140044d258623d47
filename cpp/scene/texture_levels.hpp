#pragma once
#include <cstdint>
#include <vector>

#include "../checkpoint.hpp"
#include "../platform.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

// The coarser levels of a texture, a third of its memory more. On the host.

/// What the coarse arrays of a TextureView point to: one of the two.
struct TextureLevels {
    std::vector<std::uint8_t> rgba;
    std::vector<float> linear_rgba;
};

/// All coarser levels, down to one texel; the view gets them, and must not outlive what is returned.
TextureLevels coarser_levels(TextureView& texture, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
