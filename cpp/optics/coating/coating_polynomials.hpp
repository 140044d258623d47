#pragma once
#include <cstdint>
#include <type_traits>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kCosineTerms = 8;
/// Numbers of terms for one wavelength and for a spectrum. Ghosts have more, because so little is reflected that an
/// error of a thousandth of the transmitted light may be half of it.
inline constexpr int kOneWavelengthTerms = 1, kSpectrumTerms = 5, kGhostSpectrumTerms = 7;

/// Shares of the power that a surface without a coating lets through, for polarisation across (s) and in (p) the plane
/// of incidence.
struct FresnelTransmittance {
    float s, p;
};

/// Fresnel's formulas. `before`, `behind`: index times cosine on both sides, the latter 0 under total reflection;
/// `squared_quotient`: of the index behind over that before.
REALCAM_INLINE FresnelTransmittance fresnel_transmittance(float before, float behind, float squared_quotient) {
    const float sum_s = before + behind, sum_p = squared_quotient * before + behind;
    const float s = sum_s * sum_s, p = sum_p * sum_p, four = 4.0f * before * behind;
    const float scale = quotient(four, s * p);  // one division for both
    return {scale * p, scale * s * squared_quotient};
}

/// What a coating makes of Fresnel's transmittances, by which factor it changes them: a smooth function of the angle up
/// to grazing light, where transmittances themselves fall steeply. Polynomials of the cosine in the medium of the lower
/// index, and of the WavelengthVariable. For a mirror they hold its reflectances.
template <int kWavelengthTerms>
struct alignas(16) CoatingPolynomials {
    static constexpr int kTerms = kWavelengthTerms;
    float s[kWavelengthTerms][kCosineTerms], p[kWavelengthTerms][kCosineTerms];  ///< the constant first
    /// Makes the cosine's range [-1, 1]: scale * (index times cosine) - 1.
    float scale;
    std::int32_t is_behind;  ///< 1: the medium of the lower index is behind the surface
    std::int32_t unused[2];

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

    /// What is let through. `in`, `beyond`: index times cosine on both sides; `squared_quotient` as of
    /// fresnel_transmittance; `wavelength`: the WavelengthVariable.
    REALCAM_INLINE FresnelTransmittance transmittance(float in, float beyond, float squared_quotient,
                                                      float wavelength) const {
        const FresnelTransmittance bare = fresnel_transmittance(in, beyond, squared_quotient);
        const float cosine = scale * select(is_behind != 0, beyond, in) - 1.0f;
        return {bare.s * at(s, cosine, wavelength), bare.p * at(p, cosine, wavelength)};
    }
};

/// What rays have kept of each polarisation: products over the surfaces. Planes of incidence are taken to be the same
/// all the way.
template <int N>
struct PassedPower {
    Lanes<float, N> s, p;

    REALCAM_INLINE PassedPower() {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) s[i] = p[i] = 1;
    }
    REALCAM_INLINE float of_unpolarised(int lane) const { return 0.5f * (s[lane] + p[lane]); }
};

/// Media with coatings between them. `Media`: OneWavelength or ManyWavelengths.
template <class Media, int kWavelengthTerms, int N>
struct CoatedMedia {
    Media media;
    const CoatingPolynomials<kWavelengthTerms>* surfaces;  ///< in the order in which the light meets them
    const float* variable;  ///< the WavelengthVariable of each ray; not read for one wavelength
    PassedPower<N>& passed;

    template <class Uncoated>
    struct Boundary : Uncoated {
        CoatingPolynomials<kWavelengthTerms> coating;
        const float* variable;
        PassedPower<N>& passed;
        static constexpr bool is_coated = true;

        /// Takes note of a ray whose index times cosine is `before` in front of the surface and `behind` behind it.
        REALCAM_INLINE void pass(int lane, float before, float behind) const {
            float wavelength = 0;
            if constexpr (kWavelengthTerms > 1) wavelength = variable[lane];
            const FresnelTransmittance kept =
                coating.transmittance(std::fabs(before), behind, 1.0f + this->squared_index_change(lane), wavelength);
            passed.s[lane] *= kept.s;
            passed.p[lane] *= kept.p;
        }
    };

    template <class Surface>
    REALCAM_INLINE auto at(const Surface& surface, int place) const {
        const auto uncoated = media.at(surface, place);
        return Boundary<std::remove_const_t<decltype(uncoated)>>{uncoated, load_constant(surfaces + place), variable,
                                                                 passed};
    }
};

}  // namespace REALCAM_NAMESPACE
