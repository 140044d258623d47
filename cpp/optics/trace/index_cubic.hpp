#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

// Refractive indices as functions of the wavelength, and the media policies of trace_lens. A media policy has a method
// at(surface, index), which returns a Boundary: squared_index_change(lane) is n'^2 / n^2 - 1 of that surface for a ray,
// and is_coated says whether it has a method `pass` that applies a coating (see CoatedMedia).

/// Function x = scale / (wavelength - 200 nm) + offset of the wavelength, in which refractive indices are nearly
/// polynomials: like the index of glass, it grows steeply towards the resonances in the ultraviolet. It runs from -1 to
/// 1 over the wavelengths of a picture (variable_over), and is 0 if there is a single wavelength.
struct WavelengthVariable {
    float scale, offset;

    /// A typical resonance of optical glass.
    static constexpr float kPole_nm = 200;

    REALCAM_INLINE float at(float wavelength_nm) const { return scale / (wavelength_nm - kPole_nm) + offset; }
};

/// A quantity of a surface that depends on its refractive indices, as a cubic of the WavelengthVariable x. Unless
/// stated otherwise, the quantity is n'^2 / n^2 - 1.
struct alignas(16) IndexCubic {
    float c[4];  ///< coefficients, the constant first

    REALCAM_INLINE float at(float x) const { return ((c[3] * x + c[2]) * x + c[1]) * x + c[0]; }
};

/// Media policy of a trace in which all rays have the wavelength of the LensView.
struct OneWavelength {
    template <class T>
    struct Boundary {
        T change;
        static constexpr bool is_coated = false;
        REALCAM_INLINE T squared_index_change(int) const { return change; }
    };
    template <class Surface>
    REALCAM_INLINE auto at(const Surface& surface, int) const {
        return Boundary<decltype(surface.curvature)>{surface.squared_index_change};
    }
};

/// Media policy of a trace in which each ray has its own wavelength.
struct ManyWavelengths {
    const IndexCubic* surfaces;  ///< n'^2 / n^2 - 1 of each surface, in the order of the light
    const float* variable;  ///< value of the WavelengthVariable of each ray

    struct Boundary {
        IndexCubic cubic;
        const float* variable;
        static constexpr bool is_coated = false;
        REALCAM_INLINE float squared_index_change(int lane) const { return cubic.at(variable[lane]); }
    };
    template <class Surface>
    REALCAM_INLINE Boundary at(const Surface&, int index) const {
        return {surfaces[index], variable};
    }
};

}  // namespace REALCAM_NAMESPACE
