#pragma once
#include <vector>

#include "../geometry/split_triangles.hpp"
#include "../lights/light_tables.hpp"
#include "../scene.hpp"
#include "../textures/texture_levels.hpp"

namespace REALCAM_NAMESPACE {

/// Triangle mesh as kernels read it: float, in a given frame. Planes, areas and edges are computed from
/// double-precision positions. Owns the memory of its view; the Scene must outlive it.
class RenderSpaceMesh {
public:
    /// `frame`: transform from scene space. Throws Cancelled if `checkpoint` does.
    RenderSpaceMesh(const Scene& scene, const Affine<double>& frame, LargeTriangles large, Checkpoint& checkpoint);

    MeshView view() const;

    const Scene& scene() const { return scene_; }
    /// Transform from scene space into the mesh's frame.
    const Affine<double>& frame() const { return frame_; }
    /// Vertices in the mesh's frame. The vector has capacity for one more, because Embree reads 16 bytes per vertex.
    const std::vector<Vec3f>& positions() const { return positions_; }
    /// The scene's triangles; those that are large and near are split (SplitTriangles).
    const std::vector<Triangle>& triangles() const { return split_.triangles(); }

    const std::vector<TrianglePlane>& planes() const { return planes_; }
    /// Indices of the triangles that emit light, ascending.
    const std::vector<std::uint32_t>& emitters() const { return emitters_; }
    /// Mean factor of each emitter's luminance (emission_means).
    const std::vector<float>& emission_means() const { return emission_means_; }

    /// Builds the mipmap levels of colour textures. Directions, roughness and coverage get none, because shading with
    /// their mean is not the mean of the shading. Views made earlier lack the levels.
    void add_texture_levels(Checkpoint& checkpoint);

    /// True if any material has holes (Material::has_holes).
    bool has_holes() const;

    /// First corner of a triangle, and its edges to the second and third corner, in double precision.
    struct Edges {
        Vec3d corner, u, v;
    };
    /// Returns the edges of a triangle in the mesh's frame.
    Edges edges(const Triangle& t) const {
        return edges_of(t, [&](std::uint32_t v) { return split_.position(v); });
    }

private:
    template <class PositionOf>
    static Edges edges_of(const Triangle& t, PositionOf&& position) {
        const Vec3d a = position(t.vertices[0]);
        return {a, position(t.vertices[1]) - a, position(t.vertices[2]) - a};
    }

    /// Transforms the vertex normals if the frame requires it.
    void add_normals(Checkpoint& checkpoint);

    /// Computes the planes of all triangles.
    void add_planes(Checkpoint& checkpoint);

    const Scene& scene_;
    Affine<double> frame_;
    SplitTriangles split_;
    std::vector<Vec3f> transformed_normals_;  ///< empty: the normals of split_ are valid in the mesh's frame
    std::vector<Vec3f> positions_;
    std::vector<TrianglePlane> planes_;
    std::vector<std::uint32_t> emitters_;
    std::vector<float> emission_means_;
    std::vector<TextureView> textures_;
    std::vector<TextureLevels> levels_;  ///< for each texture; empty: no levels
};

}  // namespace REALCAM_NAMESPACE
