#pragma once
#include <cstdint>
#include <vector>

#include "../scene/assembly.hpp"
#include "../scene/surface_point.hpp"
#include "layer_sum.hpp"
#include "layers.hpp"

namespace REALCAM_NAMESPACE {

/// Ids of the objects and materials of a scene. Objects: 1 is static geometry, and instances follow in their order.
/// Materials: from 1 on, those of static geometry, then those of each object, in the order in which it is first
/// instanced; all instances of an object share them.
class SurfaceIds {
public:
    explicit SurfaceIds(const Assembly& assembly);

    std::uint32_t object(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : index_of(surface) + 1;
    }
    std::uint32_t material(const PixelCentreSurface& surface) const {
        return surface.triangle == kNoTriangle ? 0 : first_material_[index_of(surface)] + surface.material;
    }

    const IdNames& object_names() const { return objects_; }
    const IdNames& names_of_materials() const { return materials_; }

private:
    static std::uint32_t index_of(const PixelCentreSurface& surface) {
        return surface.instance == kNoInstance ? 0 : surface.instance + 1;
    }

    IdNames objects_, materials_;
    std::vector<std::uint32_t> first_material_;  ///< first id: of static geometry, then of each instance
};

}  // namespace REALCAM_NAMESPACE
