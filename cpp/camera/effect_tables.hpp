#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "../optics/coating/fit_coatings.hpp"
#include "diffraction_tables.hpp"
#include "effect_views.hpp"
#include "film_spectrum.hpp"
#include "ghost_tables.hpp"
#include "lens_way.hpp"
#include "pupil_sampling.hpp"
#include "starburst_tables.hpp"

namespace REALCAM_NAMESPACE {

/// What is simulated of the light in the lens besides its refraction at the design wavelength.
struct LensEffects : Effects {
    std::optional<Illuminant> illuminant = {};  ///< of a picture whose samples have wavelengths
    std::optional<GhostChoice> ghosts = {};
    PupilSampling pupil_sampling = PupilSampling::outline;
    std::optional<WavelengthRange> even_wavelengths = {};  ///< in place of an illuminant: all of these alike

    bool operator==(const LensEffects&) const = default;
};

/// A lens made ready for effects. Owns the memory of its views.
class EffectTables {
public:
    /// `film_radius`: of a circle that holds the film, mm. `last`: made before, of which is taken over what is the
    /// same. Throws InputError where an index is not known.
    EffectTables(const LensSystem& lens, double film_radius, const LensEffects& effects, const PupilTracer& tracer,
                 const EffectTables* last);

    /// `film_angle`: the film's area over the square of its distance from the exit pupil.
    EffectViews views(double film_angle) const;

    /// Of all light of the picture that is traced apart from the samples of its pixels: at most kMostSplats.
    std::vector<GhostView> splats() const;

    /// The way on which lights are seen themselves. Made when it is first wanted. Throws InputError as the constructor.
    const LensWay& lens_way() const { return *shared_lens_way(); }

    /// At which light may pass that the picture has to find; none: the design wavelength alone.
    const std::vector<double>& pupil_wavelengths() const { return pupil_wavelengths_; }

private:
    /// Rays of the shortest and of the longest wavelength leave the lens farthest apart.
    void set_wavelengths(FilmSpectrum spectrum);

    void set_coatings(const EffectTables* same);

    std::shared_ptr<const LensWay> shared_lens_way() const;

    struct LazyLensWay {
        std::once_flag once;
        std::shared_ptr<const LensWay> way;
    };

    LensEffects effects_;
    LensSystem lens_;
    double film_radius_;
    std::optional<FilmSpectrum> spectrum_;  ///< of a picture whose samples have wavelengths, as what follows
    std::vector<IndexCubic> to_scene_, to_film_;
    std::optional<LensPath<float>> film_path_;
    std::vector<double> pupil_wavelengths_;
    std::vector<CoatingPolynomials<kOneWavelengthTerms>> coatings_;
    std::vector<CoatingPolynomials<kSpectrumTerms>> coatings_to_scene_, coatings_to_film_;
    std::shared_ptr<const GhostTables> ghosts_;
    std::shared_ptr<LazyLensWay> lens_way_;
    std::shared_ptr<const DiffractionTables> diffraction_;
    std::shared_ptr<const StarburstTables> starbursts_;
};

}  // namespace REALCAM_NAMESPACE
