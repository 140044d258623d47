#pragma once
#include <vector>

#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// The path of a lens, with its rims changed for aiming. Owns the memory of its views.
class AimingPath {
public:
    /// Without rims, blades, obstructions and apertures: what a ray is aimed through. Whether the real lens lets it
    /// pass is asked afterwards. Aspheres stay searched for within their rim.
    static AimingPath open(const LensPath<double>& path);
    /// As it is, but for the stop, the surface of that index in the lens: its plane is open.
    static AimingPath with_open_stop(const LensPath<double>& path, int stop);
    /// The lens as it is.
    static AimingPath real(const LensPath<double>& path) { return AimingPath(path); }

    LensView<double> view() const;
    /// The first `count` surfaces that the light meets. Rays end in the frame of the last of them.
    LensView<double> first(int count) const;

private:
    explicit AimingPath(const LensPath<double>& path);

    LensKind kind_;
    std::vector<SurfaceView<double>> steps_;
    std::vector<FrameChanges<double>> frames_, frames_in_place_;  ///< those without the change to where rays leave
    std::vector<FreeformView<double>> freeforms_;
    std::vector<ApertureView<double>> apertures_;
    Iris<double> iris_;
};

}  // namespace REALCAM_NAMESPACE
