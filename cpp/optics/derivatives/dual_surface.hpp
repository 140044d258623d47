#pragma once
#include <vector>

#include "../../math/affine.hpp"
#include "../trace/lens_path.hpp"
#include "dual.hpp"
#include "lens_variable.hpp"

namespace REALCAM_NAMESPACE {

/// Number of derivatives of a dual number in lens derivatives: one AVX-512 register, or two AVX2 registers.
inline constexpr int kDualLanes = 8;
using Dual8 = Dual<kDualLanes>;

/// Numbers of a lens prescription with derivatives by up to eight variables: lane i holds the derivative by variable
/// first + i.
class DualLens {
public:
    /// `first`: index of the first of the eight variables.
    DualLens(const LensSystem& lens, double wavelength_nm, const std::vector<LensVariable>& variables,
             std::size_t first);

    std::vector<Dual8> indices;  ///< see LensSystem::indices
    std::vector<Dual8> vertices;  ///< see LensSystem::vertices, followed by the film's vertex
    Dual8 film_distance;
    std::vector<Affine<Dual8>> placements;  ///< see SurfacePlacement::frame

    // The transforms below require the same lens as the constructor.

    /// Transform from the frame of surface `from` to that of its neighbour `to` (from + 1 or from - 1).
    Affine<Dual8> neighbour(const LensSystem& lens, int from, int to) const;
    /// Transform from a surface's frame to the lens frame.
    Affine<Dual8> frame(const LensSystem& lens, int surface) const;
    /// Transform from the last surface's frame to that of the axis that continues from its vertex.
    Affine<Dual8> last_axis(const LensSystem& lens) const;
    /// Transform from the last surface's frame to the film frame (film_path_ends), with its origin at the film's
    /// vertex.
    Affine<Dual8> film(const LensSystem& lens) const;
};

/// FrameChange in dual numbers. It is a type of its own, because FrameChange contains device code.
struct DualFrame {
    Vec3<Dual8> origin = {0.0, 0.0, 0.0}, x = {1.0, 0.0, 0.0}, y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    bool changes = false;  ///< false: identity
};

/// A surface on the path of a ray, with derivatives of its numbers in eight lanes.
struct DualSurface {
    SurfaceView<Dual8> view;
    std::vector<FreeformView<Dual8>> form;  ///< one element for a freeform, otherwise empty: the type is large
    DualFrame before;  ///< frame change from the previous surface; if it is not the identity, view.shift is 0
    std::vector<int> variables;  ///< for each lane: index of its variable; -1: the lane does not belong to a variable
    /// For each lane of an asphere: the power of r whose coefficient is the lane's variable; 0 for other variables.
    /// These derivatives are not stored in the view, whose polynomial is about the middle of the search region: they
    /// would cancel near the axis.
    std::vector<int> powers;

    DualSurface() : view{}, variables(kDualLanes, -1), powers(kDualLanes, 0) {}
    /// Converts a surface to dual numbers without derivatives, in the kind of shape that its variables require: a
    /// sphere with an aspheric variable becomes an asphere. `variables`: those of this surface.
    DualSurface(const SurfaceView<double>& view, const Surface& surface, const std::vector<LensVariable>& variables);

    /// Sets all derivatives to 0 and removes the variables of all lanes; values are not changed.
    void clear_lanes();
    /// Returns the indices of the lanes that have a derivative other than 0.
    std::vector<int> lanes() const;
    /// Copies the derivatives and the variable of lane `from_lane` of another surface to lane `lane`.
    void copy_lane(int lane, const DualSurface& from, int from_lane);
};

/// Sets the derivatives of `lane` to those by a variable of the surface's shape. Has no effect for variables of other
/// quantities, such as thicknesses.
void seed_shape(DualSurface& dual, const Surface& surface, const LensVariable& variable, int lane);

}  // namespace REALCAM_NAMESPACE
