#pragma once
#include <cstdint>
#include <type_traits>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Transmittances of coated surfaces as polynomials, for rendering.

/// Number of terms in the cosine of the angle of incidence.
inline constexpr int kCosineTerms = 8;
/// Numbers of wavelength terms: for one wavelength, for a spectrum, and for ghosts of a spectrum. Ghosts need more,
/// because an error of a thousandth of the transmitted light may be half of the reflected light.
inline constexpr int kOneWavelengthTerms = 1, kSpectrumTerms = 5, kGhostSpectrumTerms = 7;

/// Power transmittance of an uncoated surface, for polarisation perpendicular (s) and parallel (p) to the plane of
/// incidence.
struct FresnelTransmittance {
    float s, p;
};

/// Returns the transmittances by the Fresnel equations. `before`, `behind`: index times cosine of the angle to the
/// normal on both sides, `behind` being 0 under total internal reflection; `squared_quotient`: (index behind / index
/// before)^2.
REALCAM_INLINE FresnelTransmittance fresnel_transmittance(float before, float behind, float squared_quotient) {
    const float sum_s = before + behind, sum_p = squared_quotient * before + behind;
    const float s = sum_s * sum_s, p = sum_p * sum_p, four = 4.0f * before * behind;
    const float scale = quotient(four, s * p);  // one division for both
    return {scale * p, scale * s * squared_quotient};
}

/// A surface's transmittances divided by the Fresnel transmittances of the same surface without a coating. Unlike the
/// transmittances, which fall steeply towards grazing incidence, this ratio is a smooth function of the angle. It is
/// represented as polynomials in the cosine of the angle in the medium of lower index and in the WavelengthVariable.
/// For a mirror, whose Fresnel transmittance counts as 1, they hold the reflectances.
template <int kWavelengthTerms>
struct alignas(16) CoatingPolynomials {
    static constexpr int kTerms = kWavelengthTerms;
    /// Coefficients for both polarisations, by power of the wavelength variable and of the scaled cosine; constant
    /// terms first.
    float s[kWavelengthTerms][kCosineTerms], p[kWavelengthTerms][kCosineTerms];
    /// The scaled cosine, in [-1, 1], is scale * (index times cosine) - 1.
    float scale;
    std::int32_t is_behind;  ///< 1: the medium of the lower index is behind the surface
    std::int32_t unused[2];  ///< padding to the alignment

    /// Returns the value of a polynomial. `cosine`: the scaled cosine; `wavelength`: the WavelengthVariable.
    REALCAM_INLINE static float at(const float (&c)[kWavelengthTerms][kCosineTerms], float cosine, float wavelength) {
        float sum = 0;
        REALCAM_UNROLL
        for (int i = kCosineTerms - 1; i >= 0; --i) {
            float term = c[kWavelengthTerms - 1][i];
            REALCAM_UNROLL
            for (int j = kWavelengthTerms - 2; j >= 0; --j) term = term * wavelength + c[j][i];
            sum = sum * cosine + term;
        }
        return sum;
    }

    /// Returns the transmittances of the coated surface. `before`, `behind`, `squared_quotient`: see
    /// fresnel_transmittance; `wavelength`: the WavelengthVariable.
    REALCAM_INLINE FresnelTransmittance transmittance(float before, float behind, float squared_quotient,
                                                      float wavelength) const {
        const FresnelTransmittance bare = fresnel_transmittance(before, behind, squared_quotient);
        const float cosine = scale * select(is_behind != 0, behind, before) - 1.0f;
        return {bare.s * at(s, cosine, wavelength), bare.p * at(p, cosine, wavelength)};
    }
};

/// Accumulated power transmittances of N rays, for each polarisation: products over the surfaces. The plane of
/// incidence is assumed to be the same at all surfaces.
template <int N>
struct PassedPower {
    Lanes<float, N> s, p;

    REALCAM_INLINE PassedPower() {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) s[i] = p[i] = 1;
    }
    /// Transmittance of a ray of unpolarised light.
    REALCAM_INLINE float of_unpolarised(int lane) const { return 0.5f * (s[lane] + p[lane]); }
};

/// Media policy of trace_lens (see index_cubic.hpp) with coated surfaces. `Media`: OneWavelength or ManyWavelengths,
/// which supplies the indices.
template <class Media, int kWavelengthTerms, int N>
struct CoatedMedia {
    Media media;
    const CoatingPolynomials<kWavelengthTerms>* surfaces;  ///< in the order of the light
    const float* variable;  ///< the WavelengthVariable of each ray; not read for one wavelength
    PassedPower<N>& passed;  ///< output: multiplied by the transmittances of each surface

    template <class Uncoated>
    struct Boundary : Uncoated {
        CoatingPolynomials<kWavelengthTerms> coating;
        const float* variable;
        PassedPower<N>& passed;
        static constexpr bool is_coated = true;

        /// Multiplies a ray's transmittances by those of the surface. `before`, `behind`: index times cosine on both
        /// sides; the sign of `before` does not matter.
        REALCAM_INLINE void pass(int lane, float before, float behind) const {
            float wavelength = 0;
            if constexpr (kWavelengthTerms > 1) wavelength = variable[lane];
            const FresnelTransmittance transmittance =
                coating.transmittance(std::fabs(before), behind, 1.0f + this->squared_index_change(lane), wavelength);
            passed.s[lane] *= transmittance.s;
            passed.p[lane] *= transmittance.p;
        }
    };

    template <class Surface>
    REALCAM_INLINE auto at(const Surface& surface, int index) const {
        const auto uncoated = media.at(surface, index);
        return Boundary<std::remove_const_t<decltype(uncoated)>>{uncoated, load_constant(surfaces + index), variable,
                                                                 passed};
    }
};

}  // namespace REALCAM_NAMESPACE
