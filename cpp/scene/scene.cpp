#include "scene.hpp"

#include <cmath>
#include <cstddef>
#include <set>

#include "../error.hpp"

namespace realcam {

bool Scene::has_local_light() const {
    if (!points.empty()) return true;
    for (const Triangle& t : triangles)
        if (materials[t.material].emits()) return true;
    return false;
}

std::vector<std::string> material_names(const Scene& scene) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const bool named = i < scene.material_names.size() && !scene.material_names[i].empty();
        const std::string base = named ? scene.material_names[i] : "material " + std::to_string(i);
        std::string name = base;
        for (int k = 2; !taken.insert(name).second; ++k) name = base + '.' + std::to_string(k);
        names.push_back(name);
    }
    return names;
}

void check_environment_change(const EnvironmentChange& change) {
    if (!(change.scale > 0) || !std::isfinite(change.scale))
        throw InputError("the environment's scale must be a positive number");
    if (!std::isfinite(change.rotation_deg)) throw InputError("the environment's rotation must be a number of degrees");
}

Environment changed(Environment environment, const EnvironmentChange& change) {
    check_environment_change(change);
    const auto scale = static_cast<float>(change.scale);
    environment.constant = scale * environment.constant;
    for (Color& pixel : environment.pixels) pixel = scale * pixel;
    if (environment.pixels.empty() || change.rotation_deg == 0) return environment;
    const auto width = static_cast<std::size_t>(environment.width);
    const double revolutions = change.rotation_deg / 360;
    // The map is shifted cyclically to the left by this number of columns.
    const double shift = (revolutions - std::floor(revolutions)) * static_cast<double>(width);
    const auto whole_columns = static_cast<std::size_t>(shift);
    const auto fraction = static_cast<float>(shift - static_cast<double>(whole_columns));
    std::vector<Color> shifted_row(width);
    for (std::size_t begin = 0; begin < environment.pixels.size(); begin += width) {
        Color* const row = environment.pixels.data() + begin;
        for (std::size_t c = 0; c < width; ++c)
            shifted_row[c] = mix(row[(c + whole_columns) % width], row[(c + whole_columns + 1) % width], fraction);
        for (std::size_t c = 0; c < width; ++c) row[c] = shifted_row[c];
    }
    return environment;
}

}  // namespace realcam
