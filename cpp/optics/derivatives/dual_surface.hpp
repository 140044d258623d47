#pragma once
#include <vector>

#include "../../math/affine.hpp"
#include "../trace/lens_path.hpp"
#include "dual.hpp"
#include "lens_variable.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kDualLanes = 8;
using Dual8 = Dual<kDualLanes>;

/// Numbers of a prescription with derivatives by up to eight variables: lane i belongs to variable first + i.
class DualLens {
public:
    DualLens(const LensSystem& lens, double wavelength_nm, const std::vector<LensVariable>& variables,
             std::size_t first);

    std::vector<Dual8> indices;  ///< see LensSystem::indices
    std::vector<Dual8> vertices;  ///< see LensSystem::vertices, followed by the film's vertex
    Dual8 film_distance;
    std::vector<Affine<Dual8>> placements;  ///< see SurfacePlacement::frame

    /// Transform from the frame of surface `from` to that of its neighbour `to`.
    Affine<Dual8> neighbour(const LensSystem& lens, int from, int to) const;
    /// Transform from a surface's frame to the lens frame.
    Affine<Dual8> frame(const LensSystem& lens, int surface) const;
    /// Transform from the last surface's frame to that of the axis that continues from its vertex.
    Affine<Dual8> last_axis(const LensSystem& lens) const;
    /// Transform from the last surface's frame to that of film_path_ends, shifted to the film.
    Affine<Dual8> film(const LensSystem& lens) const;
};

/// FrameChange in dual numbers, without that type's device code.
struct DualFrame {
    Vec3<Dual8> origin = {0.0, 0.0, 0.0}, x = {1.0, 0.0, 0.0}, y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    bool changes = false;
};

/// A surface on the path of a ray, with derivatives in eight lanes.
struct DualSurface {
    SurfaceView<Dual8> view;
    std::vector<FreeformView<Dual8>> form;  ///< one element for a freeform, otherwise empty: the type is large
    DualFrame before;  ///< frame change from the previous surface; if it changes, the view's shift is 0
    std::vector<int> variables;  ///< variable of each lane; -1: not a variable
    /// For each lane of an asphere: the power of r whose coefficient is the lane's variable; 0 for other variables.
    /// Kept apart from the view, whose terms are about the middle of the search region and cancel near the axis.
    std::vector<int> powers;

    DualSurface() : view{}, variables(kDualLanes, -1), powers(kDualLanes, 0) {}
    /// Has no derivatives yet, but the shape that `variables` of it require: a sphere with an aspheric variable becomes
    /// an asphere.
    DualSurface(const SurfaceView<double>& view, const Surface& surface, const std::vector<LensVariable>& variables);

    /// Sets all derivatives to 0 and frees all lanes; the values stay.
    void clear_lanes();
    /// Returns the lanes that have a derivative other than 0.
    std::vector<int> lanes() const;
    /// Copies the derivatives in lane `from_lane` of another surface to lane `lane`.
    void take_lane(int lane, const DualSurface& from, int from_lane);
};

/// Sets the derivatives of `lane` to those by a variable of this surface's shape; has no effect for other variables.
void seed_shape(DualSurface& dual, const Surface& surface, const LensVariable& variable, int lane);

}  // namespace REALCAM_NAMESPACE
