#pragma once
#include <vector>

#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Direct path to the film through one lens at several wavelengths. The shapes of the surfaces are prepared once for
/// all wavelengths, because preparing a freeform takes longer than tracing it.
class CopyPath {
public:
    CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm);

    /// View for tracing at one of the wavelengths; valid as long as the path.
    struct At {
        LensView<double> view;
        double entry_position, entry_index;  ///< see LensPath
    };
    At at(std::size_t wavelength) const;

private:
    LensPath<double> first_;
    std::vector<std::vector<SurfaceView<double>>> surfaces_;  ///< for each wavelength
    std::vector<double> entry_indices_;
};

}  // namespace REALCAM_NAMESPACE
