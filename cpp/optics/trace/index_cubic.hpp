#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Function of the wavelength in which refractive indices are nearly polynomials: like the index of glass, it grows
/// steeply towards the resonances in the ultraviolet. It runs from -1 to 1 over the wavelengths of a picture; 0 if
/// there is a single one.
struct WavelengthVariable {
    float scale, offset;

    static constexpr float kPole_nm = 200;

    REALCAM_INLINE float at(float wavelength_nm) const { return scale / (wavelength_nm - kPole_nm) + offset; }
};

/// A surface's function of its refractive indices as a cubic of the WavelengthVariable: n'^2 / n^2 - 1, unless stated
/// otherwise.
struct alignas(16) IndexCubic {
    float c[4];

    REALCAM_INLINE float at(float x) const { return ((c[3] * x + c[2]) * x + c[1]) * x + c[0]; }
};

/// Media of a trace in which all rays have the wavelength of the LensView.
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

/// Media of a trace in which each ray has its own wavelength.
struct ManyWavelengths {
    const IndexCubic* surfaces;  ///< in the order of the light
    const float* variable;       ///< WavelengthVariable of each ray

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
