#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "../../optics/coating/fit_coatings.hpp"
#include "../film/pixel_filter.hpp"
#include "../models/pupil_sampling.hpp"
#include "diffraction/diffraction_tables.hpp"
#include "direct_lens_path.hpp"
#include "dispersion/film_spectrum.hpp"
#include "effect_views.hpp"
#include "ghosts/ghost_tables.hpp"

namespace REALCAM_NAMESPACE {

/// Effects of the lens on light, beyond refraction at the design wavelength.
struct LensEffects : Effects {
    std::optional<Illuminant> illuminant = {};  ///< for pictures whose samples have wavelengths
    std::optional<LensFilter> filter = {};  ///< applies to the illuminant
    std::optional<GhostChoice> ghosts = {};  ///< std::nullopt: no ghosts
    PupilSampling pupil_sampling = PupilSampling::outline;
    PixelFilter pixel_filter = PixelFilter::box;
    std::optional<WavelengthRange> even_wavelengths = {};  ///< replaces the illuminant: uniform over these wavelengths

    bool operator==(const LensEffects&) const = default;
};

/// Tables of a lens for its effects. Owns the memory of its views.
class EffectTables {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. `last`: earlier tables, from which unchanged ones
    /// are reused. Throws InputError if a refractive index is unknown.
    EffectTables(const LensSystem& lens, double film_radius, const LensEffects& effects, const PupilTracer& tracer,
                 const EffectTables* last);

    /// `film_angle`: film area over the squared image distance of the thin lens (approximate solid angle, sr).
    EffectViews views(double film_angle) const;

    /// Ghosts and starbursts, which are traced separately from the pixel samples.
    std::vector<GhostView> splats() const;

    /// Direct (ghost-free) lens path, on which the lights themselves are visible. Built at first use. Throws InputError
    /// as the constructor does.
    const DirectLensPath& direct_lens_path() const { return *shared_direct_lens_path(); }

    /// Wavelengths at which the pupil has to be found; empty: the design wavelength alone.
    const std::vector<double>& pupil_wavelengths() const { return pupil_wavelengths_; }

private:
    /// Sets the spectrum, and the wavelengths of the pupil to the design wavelength and both ends of the spectrum,
    /// whose rays leave the lens farthest apart.
    void set_wavelengths(FilmSpectrum spectrum);

    /// Fits the transmittances, or copies those of `same`, tables of the same lens and effects, if not null.
    void set_coatings(const EffectTables* same);

    std::shared_ptr<const DirectLensPath> shared_direct_lens_path() const;

    /// Built at first use, and shared by tables of the same lens and effects.
    struct LazyDirectLensPath {
        std::once_flag once;
        std::shared_ptr<const DirectLensPath> path;
    };

    LensEffects effects_;
    LensSystem lens_;
    double film_radius_;
    std::optional<FilmSpectrum> spectrum_;  ///< this and the next four only if samples have wavelengths
    std::vector<IndexCubic> to_scene_, to_film_;  ///< refractive indices at the surfaces, in the order of light
    std::optional<LensPath<float>> film_path_;  ///< the lens for light towards the film
    std::vector<double> pupil_wavelengths_;
    std::vector<CoatingPolynomials<kOneWavelengthTerms>> coatings_;
    std::vector<CoatingPolynomials<kSpectrumTerms>> coatings_to_scene_, coatings_to_film_;
    std::shared_ptr<const GhostTables> ghosts_;
    std::shared_ptr<LazyDirectLensPath> direct_lens_path_;
    std::shared_ptr<const DiffractionTables> diffraction_;
    std::shared_ptr<const StarburstTables> starbursts_;
};

}  // namespace REALCAM_NAMESPACE
