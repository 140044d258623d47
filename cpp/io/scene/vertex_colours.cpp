#include "vertex_colours.hpp"

#include <algorithm>
#include <cmath>

#include "decoded_image.hpp"

namespace realcam::io {

std::string decode_vertex_colours(std::vector<VertexColor>& colours) {
    constexpr float kMost = 1e30f;
    std::size_t bad = 0;
    float largest = 0, most_opaque = 0;
    const auto usable = [&](float& v) {
        if (v >= 0 && v < kMost) return;
        ++bad;
        v = 0;
    };
    for (VertexColor& c : colours) {
        usable(c.color.r), usable(c.color.g), usable(c.color.b), usable(c.alpha);
        largest = std::max({largest, c.color.r, c.color.g, c.color.b});
        most_opaque = std::max(most_opaque, c.alpha);
    }
    const bool are_codes = largest > 1 || most_opaque > 1;
    const float unit = largest > 1 ? 255.0f : 1.0f, alpha_unit = most_opaque > 1 ? 255.0f : 1.0f;
    const auto light = [&](float v) { return linear_of_srgb(std::min(v / unit, 1.0f)); };
    for (VertexColor& c : colours)
        c = {{light(c.color.r), light(c.color.g), light(c.color.b)}, std::min(c.alpha / alpha_unit, 1.0f)};
    std::string text;
    if (bad > 0) text = std::to_string(bad) + " numbers of its vertices' colours are none from 0 on, 0 taken";
    if (are_codes)
        text += (text.empty() ? "" : "; ") +
                std::string("its vertices' colours go beyond 1: they are taken for codes up to 255");
    return text;
}

bool are_transparent(const std::vector<VertexColor>& colours) {
    return std::any_of(colours.begin(), colours.end(), [](const VertexColor& c) { return c.alpha < 1; });
}

}  // namespace realcam::io
