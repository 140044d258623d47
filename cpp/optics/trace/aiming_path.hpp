#pragma once
#include <vector>

#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Path of a lens with modified rims, for ray aiming. Owns the memory of its views.
class AimingPath {
public:
    /// Returns the path without rims, iris blades, central obstructions and apertures. A ray that it passes may be
    /// blocked by the real lens. Aspheres are still searched only within their search radius.
    static AimingPath open(const LensPath<double>& path);
    /// Returns the real path, except that the stop has no rim and no blades. `stop`: surface index of the stop in the
    /// lens, from 0.
    static AimingPath with_open_stop(const LensPath<double>& path, int stop);
    /// Returns an unmodified copy of the path.
    static AimingPath real(const LensPath<double>& path) { return AimingPath(path); }

    /// View of all surfaces.
    LensView<double> view() const;
    /// View of the first `count` surfaces in the order of the light. Rays end in the frame of the last of them.
    LensView<double> first(int count) const;

private:
    explicit AimingPath(const LensPath<double>& path);

    LensKind kind_;
    std::vector<SurfaceView<double>> surfaces_;
    std::vector<FrameChanges<double>> frames_;
    std::vector<FrameChanges<double>> frames_without_exit_;  ///< `frames_` without the changes to the exit frame
    std::vector<FreeformView<double>> freeforms_;
    std::vector<ApertureView<double>> apertures_;
    Iris<double> iris_;
};

}  // namespace REALCAM_NAMESPACE
