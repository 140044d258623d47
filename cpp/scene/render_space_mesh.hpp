#pragma once
#include <vector>

#include "emission_mean.hpp"
#include "scene.hpp"
#include "split_triangles.hpp"
#include "texture_levels.hpp"

namespace REALCAM_NAMESPACE {

/// A scene's triangles as kernels read them: float, in a frame that suits. What is measured between corners (planes,
/// areas, edges) comes from their double positions. Owns the memory of its view; the Scene must outlive it.
class RenderSpaceMesh {
public:
    /// `frame`: from that of the scene.
    RenderSpaceMesh(const Scene& scene, const Affine<double>& frame, LargeTriangles large, Checkpoint& checkpoint);

    MeshView view() const;

    const Scene& scene() const { return scene_; }
    const Affine<double>& frame() const { return frame_; }
    /// With room for one more, because Embree reads 16 bytes of each.
    const std::vector<Vec3f>& positions() const { return positions_; }
    /// The scene's, of which those that are large and near are in pieces.
    const std::vector<Triangle>& triangles() const { return split_.triangles(); }

    const std::vector<TrianglePlane>& planes() const { return planes_; }
    /// Those of the triangles that give light.
    const std::vector<std::uint32_t>& emitters() const { return emitters_; }
    /// What maps make of their luminance.
    const std::vector<float>& emission_means() const { return emission_means_; }

    /// Makes the coarser levels of colours, for which the mean of a part is what is seen of it; not of directions, of
    /// roughness and of coverage, for which it is not. Views made before do not have them.
    void add_texture_levels(Checkpoint& checkpoint);

    bool has_holes() const;

    /// Corner and edges of a triangle, as exact as the scene gives them.
    struct Edges {
        Vec3d corner, u, v;
    };
    Edges edges(const Triangle& t) const {
        return edges_of(t, [&](std::uint32_t v) { return split_.position(v); });
    }

private:
    template <class PositionOf>
    static Edges edges_of(const Triangle& t, PositionOf&& position) {
        const Vec3d a = position(t.vertices[0]);
        return {a, position(t.vertices[1]) - a, position(t.vertices[2]) - a};
    }

    void add_normals(Checkpoint& checkpoint);

    void add_planes(Checkpoint& checkpoint);

    const Scene& scene_;
    Affine<double> frame_;
    SplitTriangles split_;
    std::vector<Vec3f> turned_normals_;
    std::vector<Vec3f> positions_;
    std::vector<TrianglePlane> planes_;
    std::vector<std::uint32_t> emitters_;
    std::vector<float> emission_means_;
    std::vector<TextureView> textures_;
    std::vector<TextureLevels> levels_;  ///< of each of them; empty: none
};

}  // namespace REALCAM_NAMESPACE
