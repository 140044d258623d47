#include "render_space_mesh.hpp"

#include <algorithm>

#include "../geometry/surface_point.hpp"
#include "../lights/light_tables.hpp"

namespace realcam {

RenderSpaceMesh::RenderSpaceMesh(const Scene& scene, const Affine<double>& frame, LargeTriangles large,
                                 Checkpoint& checkpoint)
    : scene_(scene), frame_(frame), split_(scene, frame, large, checkpoint) {
    positions_.reserve(split_.position_count() + 1);
    for (std::size_t i = 0; i < split_.position_count(); ++i) {
        checkpoint.pass();
        positions_.push_back(static_cast<Vec3f>(split_.position(i)));
    }
    for (const Texture& t : scene.textures)
        textures_.push_back({t.rgba.empty() ? nullptr : t.rgba.data(),
                             t.linear_rgba.empty() ? nullptr : t.linear_rgba.data(), t.width, t.height, t.encoding});
    add_normals(checkpoint);
    add_planes(checkpoint);
    for (std::uint32_t i = 0; i < triangles().size(); ++i)
        if (scene.materials[triangles()[i].material].emits()) emitters_.push_back(i);
    emission_means_ = REALCAM_NAMESPACE::emission_means(view(), checkpoint);
}

MeshView RenderSpaceMesh::view() const {
    MeshView view{};
    view.triangles = triangles().data();
    view.planes = planes_.data();
    view.positions = positions_.data();
    const std::vector<Vec3f>& normals = transformed_normals_.empty() ? split_.normals() : transformed_normals_;
    view.normals = normals.empty() ? nullptr : normals.data();
    view.uvs = split_.uvs().empty() ? nullptr : split_.uvs().data();
    view.second_uvs = split_.second_uvs().empty() ? nullptr : split_.second_uvs().data();
    view.colors = split_.colors().empty() ? nullptr : split_.colors().data();
    view.materials = scene_.materials.data();
    view.textures = textures_.data();
    view.emitters = emitters_.data();
    view.emitter_count = static_cast<std::int32_t>(emitters_.size());
    view.triangle_count = static_cast<std::int32_t>(triangles().size());
    view.vertex_count = static_cast<std::int32_t>(positions_.size());
    view.material_count = static_cast<std::int32_t>(scene_.materials.size());
    view.texture_count = static_cast<std::int32_t>(textures_.size());
    return view;
}

void RenderSpaceMesh::add_texture_levels(Checkpoint& checkpoint) {
    levels_.resize(textures_.size());
    for (const Material& material : scene_.materials) {
        for (const auto member :
             {&Material::diffuse_texture, &Material::specular_texture, &Material::emission_texture}) {
            const std::int32_t index = (material.*member).texture;
            if (index < 0) continue;
            TextureView& texture = textures_[static_cast<std::size_t>(index)];
            if (texture.coarse_levels == 0)
                levels_[static_cast<std::size_t>(index)] = coarser_levels(texture, checkpoint);
        }
    }
}

bool RenderSpaceMesh::has_holes() const {
    const auto& materials = scene_.materials;
    return std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.has_holes(); });
}

void RenderSpaceMesh::add_normals(Checkpoint& checkpoint) {
    if (frame_.is_scale_and_shift() || split_.normals().empty()) return;
    // Left unnormalised, so that interpolation between vertices is the transform of the original one.
    const InverseAffine<double> inverse = frame_.inverse();
    transformed_normals_.reserve(split_.normals().size());
    for (const Vec3f n : split_.normals()) {
        checkpoint.pass();
        transformed_normals_.push_back(static_cast<Vec3f>(inverse.normal_of(static_cast<Vec3d>(n))));
    }
}

void RenderSpaceMesh::add_planes(Checkpoint& checkpoint) {
    const double side = frame_.determinant() < 0 ? -1 : 1;  // a mirroring transform reverses the winding
    planes_.reserve(triangles().size());
    for (std::size_t i = 0; i < triangles().size(); ++i) {
        checkpoint.pass();
        // Uses the edges of the original triangle, so that all its pieces have the same plane.
        const Edges original = edges_of(scene_.triangles[split_.parent(i)],
                                        [&](std::uint32_t v) { return frame_.point(scene_.positions_m[v]); });
        const Vec3d cross_product = cross(original.u, original.v);
        const double size = length(cross_product);
        const Vec3d normal = size > 0 ? (side / size) * cross_product : Vec3d{0, 0, 1};
        float max_coordinate = 0;
        for (const std::uint32_t v : triangles()[i].vertices)
            max_coordinate = std::max(max_coordinate, largest_coordinate(positions_[v]));
        constexpr double kMinMargin = 1e-12;  // above 0 also for a triangle at the origin
        const double margin = static_cast<double>(kMarginShare) * static_cast<double>(max_coordinate) + kMinMargin;
        planes_.push_back(
            {static_cast<Vec3f>(normal), static_cast<float>(dot(normal, original.corner)), static_cast<float>(margin)});
    }
}

}  // namespace realcam
