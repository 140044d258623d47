#pragma once
#include "../coating/coating_polynomials.hpp"
#include "../trace/index_cubic.hpp"

namespace REALCAM_NAMESPACE {

/// Coating at one surface crossing of a ghost path. At a reflection, the polynomials are fits of (1 - reflectance) /
/// (Fresnel transmittance of the bare surface).
template <int kWavelengthTerms>
struct alignas(16) GhostCoating : CoatingPolynomials<kWavelengthTerms> {
    // Index changes to the medium on the other side of the surface, which a reflected ray does not enter:
    IndexCubic other_change;      ///< n'^2 / n^2 - 1
    IndexCubic other_difference;  ///< n'^2 - n^2
    std::int32_t is_reflected;  ///< 1: the ghost is reflected here; 0: it is transmitted
    std::int32_t unused[3];     ///< pads the size to a multiple of 16 bytes
};

/// Media and coatings along a ghost path, as a policy of trace_lens. `kWavelengthTerms`: kOneWavelengthTerms for a
/// single wavelength; more for a spectrum, in which each ray has its own wavelength.
template <int kWavelengthTerms, int N>
struct GhostMedia {
    /// True for a spectrum.
    static constexpr bool disperses = kWavelengthTerms > kOneWavelengthTerms;
    using Uncoated = std::conditional_t<disperses, ManyWavelengths::Boundary, OneWavelength::Boundary<float>>;

    const IndexCubic* indices;  ///< in the order of the light; not read for one wavelength
    const GhostCoating<kWavelengthTerms>* coatings;
    const float* variable;  ///< the WavelengthVariable of each ray; not read for one wavelength
    PassedPower<N>& passed;  ///< updated: power of each ray, for both polarisations

    /// Interface between two media at one crossing.
    struct Boundary : Uncoated {
        GhostCoating<kWavelengthTerms> coating;
        const float* variable;
        PassedPower<N>& passed;
        static constexpr bool is_coated = true;

        /// Multiplies the power of a ray by the transmittance, or at a reflection the reflectance, of the coating.
        /// `before`, `behind`: see CoatedMedia.
        REALCAM_INLINE void pass(int lane, float before, float behind) const {
            const float in = std::fabs(before), x = disperses ? variable[lane] : 0.0f;
            const bool reflects = coating.is_reflected != 0;
            const float change = disperses ? coating.other_change.at(x) : coating.other_change.c[0];
            const float difference = disperses ? coating.other_difference.at(x) : coating.other_difference.c[0];
            // 0 under total internal reflection: the transmittance is then 0 and the reflectance 1.
            const float other = select(reflects, sqrt_or_zero(in * in + difference), behind);
            const FresnelTransmittance through = coating.transmittance(in, other, 1.0f + change, x);
            passed.s[lane] *= select(reflects, 1.0f - through.s, through.s);
            passed.p[lane] *= select(reflects, 1.0f - through.p, through.p);
        }
    };

    /// Returns the interface at crossing `index`, whose surface is `surface`.
    template <class Surface>
    REALCAM_INLINE auto at(const Surface& surface, int index) const {
        if constexpr (disperses)
            return Boundary{{indices[index], variable}, load_constant(coatings + index), variable, passed};
        else
            return Boundary{{surface.squared_index_change}, load_constant(coatings + index), variable, passed};
    }
};

}  // namespace REALCAM_NAMESPACE
