#pragma once
#include <vector>

#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// A scene's view with every array replaced by a copy elsewhere: `copy(pointer, count)` copies at once, and returns
/// where to. This list is all that a device needs to know of what a scene consists of.
template <class Copy>
SceneView with_copied_arrays(SceneView view, Copy&& copy) {
    const auto move = [&](auto*& array, std::int64_t count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    std::vector<TextureView> textures(view.textures, view.textures + view.texture_count);
    for (TextureView& texture : textures) move(texture.rgba, std::int64_t{4} * texture.width * texture.height);
    view.textures = textures.data();
    move(view.textures, view.texture_count);
    move(view.triangles, view.triangle_count);
    move(view.planes, view.triangle_count);
    move(view.positions, view.vertex_count);
    move(view.normals, view.vertex_count);
    move(view.uvs, view.vertex_count);
    move(view.materials, view.material_count);
    move(view.points, view.point_count);
    move(view.suns, view.sun_count);
    move(view.areas, view.area_count);
    move(view.area_cdf, view.area_count + 1);
    EnvironmentView& environment = view.environment;
    if (environment.pixels) {
        const std::int64_t height = environment.height, width = environment.width;
        move(environment.pixels, height * width);
        move(environment.marginal_cdf, height + 1);
        move(environment.conditional_cdf, height * (width + 1));
    }
    return view;
}

}  // namespace REALCAM_NAMESPACE
