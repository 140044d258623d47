#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../platform.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the linear value, 0 to 1, of each 8-bit code. Host only.
std::array<float, 256> linear_values_of_codes(TextureEncoding encoding);

// Mipmap levels of a texture; they take a third of its memory in addition. Host only.

/// Memory of a TextureView's coarse levels; only one of the two vectors is used.
struct TextureLevels {
    std::vector<std::uint8_t> rgba;
    std::vector<float> linear_rgba;
};

/// Computes all coarser levels, down to one texel, and sets the view's pointers to them and its coarse_levels; the view
/// must not outlive the result. Throws Cancelled if `checkpoint` does.
TextureLevels coarser_levels(TextureView& texture, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
