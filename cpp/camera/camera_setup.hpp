#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "../optics/lens/lens_polynomial.hpp"
#include "../optics/pupil/pupil.hpp"
#include "../optics/pupil/pupil_grid.hpp"
#include "../platform.hpp"
#include "effects/effect_tables.hpp"
#include "effects/entrance_pupil_search.hpp"
#include "film/camera.hpp"
#include "models/bundle_motions.hpp"
#include "models/lens_map.hpp"

namespace REALCAM_NAMESPACE {

/// Start of the pupil search for a lens that differs from the last one.
enum class PupilStart {
    from_scratch,  ///< the result does not depend on the last lens
    near_last,  ///< faster, near the edges of the last pupil (see Pupil); from scratch if the lens is unchanged
};

/// A camera prepared for rendering. Owns the tables that its view points to.
class CameraSetup {
public:
    /// `tracer`: traces the rays of the pupil search, see PupilTracer. `last`: an earlier set-up or null; its pupil is
    /// reused if lens and film are unchanged, because the pupil search is most of the work. `effects`: effects for
    /// which tables are made; `start`: start of the pupil search if the lens differs from that of `last`. Throws
    /// InputError if the camera is invalid, passes no light, or rotates too fast for one exposure.
    explicit CameraSetup(const Camera& camera, PupilTracer tracer = {}, const CameraSetup* last = nullptr,
                         const LensEffects& effects = {}, PupilStart start = PupilStart::from_scratch);

    /// View for the render kernels, valid as long as this object. `origin_m`: origin of the render space in the scene.
    /// `scene_moves`: true if the scene moves during the exposure.
    CameraView view(Vec3d origin_m, bool scene_moves = false) const;

    const Camera& camera() const { return camera_; }
    /// Polynomials of the model polynomial_lens; null for other models.
    const LensPolynomial* polynomial() const { return polynomial_ ? &*polynomial_ : nullptr; }
    const EffectTables& effects() const { return tables_; }
    /// Pupil of a lens without rotational symmetry; null for other cameras.
    const PupilGrid* pupil_grid() const { return pupil_grid_.get(); }
    /// True if the pupil does not depend on the earlier set-up that the search started from (PupilStart).
    bool has_new_pupil() const { return !pupil_ || !pupil_->was_found_near_similar(); }
    /// Rectangle of the sampled film (sampled_film) in the lens's axes, mm.
    FilmArea film_area() const;
    /// True if lights can be traced through every surface of the lens.
    bool traces_lights() const {
        return has_real_pupil(camera_.model) && camera_.model != CameraModel::polynomial_lens;
    }
    /// Largest angle between the lens's axis and a direction that the film sees, rad.
    double widest_angle() const;
    /// Entrance-pupil bounds of a camera that traces lights through a rotationally symmetric lens; null for other
    /// cameras.
    const PupilEntryBounds* pupil_entries() const { return pupil_entries_.get(); }

private:
    /// Validates the camera before any member is built: a camera without a lens has no first surface.
    static const Camera& validated(const Camera& camera);

    /// Film that is as much larger than the camera's as the pixels' filter reaches beyond its border.
    Film sampled_film() const;
    /// Largest distance of a sampled film point from the axis, mm.
    double film_radius() const { return sampled_film().radius_mm(); }

    /// Finds the pupil, or reuses that of `last`.
    void set_pupil(const PupilTracer& tracer, const CameraSetup* last, PupilStart start);
    /// Throws InputError if no light reaches the film.
    void check_light() const;

    /// Measures distortion and vignetting, or reuses the map of `last`.
    void set_map(const PupilTracer& tracer, const CameraSetup* last);

    /// Pose in render space.
    static CameraFrame placement(const Affine<double>& scene_from_camera, Vec3d origin_m);

    /// Computes the motions of a calibrated camera's bundles, or reuses those of `last`.
    void set_bundle_motions(const PupilTracer& tracer, const CameraSetup* last);

    /// Sets the view's keyframes and row times; leaves the times 0 if nothing moves.
    void set_times(CameraView& view, bool scene_moves) const;

    bool has_lens_and_film_of(const CameraSetup& other) const;
    /// True if the set-up has a pupil that was found for these wavelengths and this sampling.
    bool has_pupil_for(const std::vector<double>& wavelengths, PupilSampling sampling) const;

    Camera camera_;
    LensEffects effects_;
    LensPath<float> path_;
    EffectTables tables_;
    std::optional<LensPath<double>> path_in_double_;
    LensView<double> view_in_double_{};
    std::optional<LensPolynomial> polynomial_;
    std::vector<CameraFrame> keys_;  ///< at uniformly spaced times of the exposure; positions relative to the first
    std::shared_ptr<const Pupil> pupil_;  ///< centred, rotationally symmetric lenses
    std::shared_ptr<const PupilGrid> pupil_grid_;  ///< all other lenses
    std::shared_ptr<const PupilEntryBounds> pupil_entries_;
    float axis_irradiance_ = 0;  ///< ideal models only
    std::shared_ptr<const LensMap> map_;  ///< model mapped_lens only
    std::shared_ptr<const BundleMotions> bundle_motions_;  ///< calibrated cameras only
};

/// Cache of the last camera set-up of each camera model, with and without a calibration, whose tables serve the next
/// one if lens and film are equal. They are stored apart because the planner takes pictures with other models between
/// two pictures of a camera. Thread-safe.
class LastSetup {
public:
    /// Returns a set-up of the camera and stores it. Throws InputError as CameraSetup; the cache is then unchanged.
    /// Parameters: see CameraSetup.
    std::shared_ptr<const CameraSetup> make(const Camera& camera, const PupilTracer& tracer,
                                            const LensEffects& effects = {},
                                            PupilStart start = PupilStart::from_scratch);

private:
    mutable std::mutex mutex_;
    std::map<std::pair<CameraModel, bool>, std::shared_ptr<const CameraSetup>> setups_;
    std::shared_ptr<const CameraSetup> latest_;  ///< serves a model that has no set-up yet
};

}  // namespace REALCAM_NAMESPACE
