#pragma once
#include <vector>

#include "../../math/affine.hpp"
#include "../trace/lens_path.hpp"
#include "dual.hpp"
#include "lens_variable.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kDualLanes = 8;
using Dual8 = Dual<kDualLanes>;

/// What a lens is made of, with derivatives by up to eight variables: lane i is that of the variable first + i.
class DualLens {
public:
    DualLens(const LensSystem& lens, double wavelength_nm, const std::vector<LensVariable>& variables,
             std::size_t first);

    std::vector<Dual8> indices;   ///< as LensSystem::indices
    std::vector<Dual8> vertices;  ///< as LensSystem::vertices, and the film's behind them
    Dual8 film_distance;
    std::vector<Affine<Dual8>> placements;  ///< as SurfacePlacement::frame

    /// From the frame of surface `from` to that of its neighbour `to`.
    Affine<Dual8> neighbour(const LensSystem& lens, int from, int to) const;
    /// From a surface's frame to the lens frame.
    Affine<Dual8> frame(const LensSystem& lens, int surface) const;
    /// From the last surface's frame to that of the axis that goes on from its vertex.
    Affine<Dual8> last_axis(const LensSystem& lens) const;
    /// From the last surface's frame to that of film_path_ends, shifted to the film.
    Affine<Dual8> film(const LensSystem& lens) const;
};

/// As FrameChange, which has code for devices.
struct DualFrame {
    Vec3<Dual8> origin = {0.0, 0.0, 0.0}, x = {1.0, 0.0, 0.0}, y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    bool changes = false;
};

/// A surface on the path of a ray, with derivatives by eight numbers.
struct DualSurface {
    SurfaceView<Dual8> view;
    std::vector<FreeformView<Dual8>> form;  ///< one of a freeform, none of others: it is large
    DualFrame before;  ///< where it changes, the view's shift is 0
    std::vector<int> variables;  ///< those of the lanes; -1: none, and all derivatives of this lane are 0
    /// Of an asphere: the power of r whose coefficient a lane is that of; 0: none. Not in the view, whose terms about
    /// the middle of the search region cancel near the axis.
    std::vector<int> powers;

    DualSurface() : view{}, variables(kDualLanes, -1), powers(kDualLanes, 0) {}
    /// Without derivatives, but ready for those by `variables` of its shape: a sphere that may become an asphere is
    /// one.
    DualSurface(const SurfaceView<double>& view, const Surface& surface, const std::vector<LensVariable>& variables);

    /// Leaves the numbers themselves.
    void clear_lanes();
    /// Which lanes have a derivative that is not 0.
    std::vector<int> lanes() const;
    /// The derivatives of a lane of another become those of one of this.
    void take_lane(int lane, const DualSurface& from, int from_lane);
};

/// Gives a lane to a variable, if it is one of the shape of this surface.
void seed_shape(DualSurface& dual, const Surface& surface, const LensVariable& variable, int lane);

}  // namespace REALCAM_NAMESPACE
