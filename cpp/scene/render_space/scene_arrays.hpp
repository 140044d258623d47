#pragma once
#include <vector>

#include "../textures/texture.hpp"

namespace REALCAM_NAMESPACE {

// These functions return views with every array replaced by a copy, such as one on a device: `copy(pointer, count)`
// copies an array and returns the address of the copy. Transferring a scene to a device needs no other knowledge of its
// members.

namespace scene_arrays_detail {

/// Replaces an array by its copy; a null pointer stays.
template <class T, class Copy>
void replace(const T*& array, std::int64_t count, Copy&& copy) {
    if (array) array = copy(array, static_cast<std::size_t>(count));
}

}  // namespace scene_arrays_detail

/// Copies all arrays of a mesh, with its textures.
template <class Copy>
MeshView with_copied_arrays(MeshView view, Copy&& copy) {
    using scene_arrays_detail::replace;
    std::vector<TextureView> textures(view.textures, view.textures + view.texture_count);
    for (TextureView& texture : textures) {
        const std::int64_t texels = std::int64_t{texture.width} * texture.height;
        replace(texture.rgba, 4 * texels, copy);
        replace(texture.linear_rgba, 4 * texels, copy);
        const std::int64_t coarse = coarse_texels(texture);
        if (texture.coarse_levels > 0 && texture.rgba)
            replace(texture.coarse_rgba, 4 * coarse, copy);
        else if (texture.coarse_levels > 0)
            replace(texture.coarse_linear_rgba, 4 * coarse, copy);
    }
    view.textures = textures.data();
    replace(view.textures, view.texture_count, copy);
    replace(view.triangles, view.triangle_count, copy);
    replace(view.planes, view.triangle_count, copy);
    replace(view.positions, view.vertex_count, copy);
    replace(view.normals, view.vertex_count, copy);
    replace(view.uvs, view.vertex_count, copy);
    replace(view.second_uvs, view.vertex_count, copy);
    replace(view.colors, view.vertex_count, copy);
    replace(view.materials, view.material_count, copy);
    replace(view.emitters, view.emitter_count, copy);
    return view;
}

/// Copies all arrays except those of the InstancesView.
template <class Copy>
SceneView with_copied_arrays(SceneView view, Copy&& copy) {
    using scene_arrays_detail::replace;
    static_cast<MeshView&>(view) = with_copied_arrays(static_cast<const MeshView&>(view), copy);
    std::vector<MeshView> objects(view.objects, view.objects + view.object_count);
    for (MeshView& object : objects) object = with_copied_arrays(object, copy);
    view.objects = objects.data();
    replace(view.objects, view.object_count, copy);
    replace(view.suns, view.sun_count, copy);
    EnvironmentView& environment = view.environment;
    if (environment.pixels) {
        const std::int64_t height = environment.height, width = environment.width;
        replace(environment.pixels, height * width, copy);
        replace(environment.marginal_cdf, height + 1, copy);
        replace(environment.conditional_cdf, height * (width + 1), copy);
    }
    return view;
}

/// Copies the arrays of an InstancesView.
template <class Copy>
InstancesView with_copied_arrays(InstancesView view, Copy&& copy) {
    using scene_arrays_detail::replace;
    replace(view.instances, view.instance_count, copy);
    replace(view.keys, view.key_count, copy);
    replace(view.points, view.point_count, copy);
    replace(view.areas, view.area_count, copy);
    replace(view.light_nodes, view.light_node_count, copy);
    replace(view.leaf_lights, view.leaf_light_count, copy);
    replace(view.light_trails, view.point_count + view.area_count, copy);
    replace(view.leaf_probabilities, view.point_count + view.area_count, copy);
    return view;
}

}  // namespace REALCAM_NAMESPACE
