#include "coated_faces.hpp"

#include <utility>

namespace realcam {

const Glass& medium_before(const LensSystem& lens, std::size_t index) {
    static const Glass air = Glass::air();
    for (std::size_t i = index; i-- > 0;)
        if (lens.surfaces[i].type == SurfaceType::refracting) return lens.surfaces[i].material;
    return air;
}

bool is_face_in_air(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.type == SurfaceType::refracting && medium_before(lens, index).is_air() != surface.material.is_air();
}

namespace {

/// True if the surface is a mirror or a face in air whose coating the lens does not specify.
bool has_unknown_coating(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.coating.kind == CoatingKind::unknown &&
           (surface.type == SurfaceType::mirror || is_face_in_air(lens, index));
}

}  // namespace

std::vector<int> surfaces_with_unknown_coating(const LensSystem& lens) {
    std::vector<int> found;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (has_unknown_coating(lens, i)) found.push_back(static_cast<int>(i));
    return found;
}

std::string coating_summary(const LensSystem& lens) {
    std::vector<std::pair<std::string, std::string>> groups;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& surface = lens.surfaces[i];
        const bool is_mirror = surface.type == SurfaceType::mirror;
        const bool unknown = surface.coating.kind == CoatingKind::unknown;
        if (!surface.bends_light() || (unknown && !has_unknown_coating(lens, i))) continue;
        const std::string name = unknown ? std::string("unknown, taken as ") + (is_mirror ? "a perfect mirror" : "bare")
                                 : surface.coating.name.empty() ? "unnamed"
                                                                : surface.coating.name;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& other) { return other.first == name; });
        if (group == groups.end()) group = groups.insert(group, {name, ""});
        group->second += (group->second.empty() ? "" : ", ") + std::to_string(i + 1);
    }
    std::string text;
    for (const auto& [name, numbers] : groups) text += (text.empty() ? "" : "; ") + name + ": " + numbers;
    return text;
}

}  // namespace realcam
