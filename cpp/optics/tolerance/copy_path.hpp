#pragma once
#include <vector>

#include "../trace/lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// The way of light to the film through one lens at several wavelengths. The shapes of its surfaces, of which freeforms
/// take longer to prepare than to trace, are made ready once.
class CopyPath {
public:
    CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm);

    /// What a trace at one of the wavelengths needs; valid as long as the path.
    struct At {
        LensView<double> view;
        double entry_position, entry_index;  ///< as LensPath has them
    };
    At at(std::size_t wavelength) const;

private:
    LensPath<double> first_;
    std::vector<std::vector<SurfaceView<double>>> surfaces_;  ///< of each wavelength
    std::vector<double> entry_indices_;
};

}  // namespace REALCAM_NAMESPACE
