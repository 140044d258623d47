#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "../optics/lens/lens_polynomial.hpp"
#include "../optics/pupil/pupil.hpp"
#include "../optics/pupil/pupil_grid.hpp"
#include "camera.hpp"
#include "effect_tables.hpp"
#include "lens_map.hpp"
#include "pupil_entries.hpp"
#include "pupil_start.hpp"

namespace REALCAM_NAMESPACE {

/// A camera made ready: owns the tables that its view points to.
class CameraSetup {
public:
    /// Throws InputError, also for a camera that turns too fast for the exposure. `tracer`: see Pupil. `last`: a set-up
    /// whose pupil is taken over if it is the same one: finding it is most of the work, and a camera that only moves
    /// keeps it.
    explicit CameraSetup(const Camera& camera, PupilTracer tracer = {}, const CameraSetup* last = nullptr,
                         const LensEffects& effects = {}, PupilStart start = PupilStart::anew);

    /// `origin_m`: of the placed scene. `scene_moves`: whether that does during the exposure.
    CameraView view(Vec3d origin_m, bool scene_moves = false) const;

    const Camera& camera() const { return camera_; }
    /// The polynomials of a camera with the model polynomial_lens; else null.
    const LensPolynomial* polynomial() const { return polynomial_ ? &*polynomial_ : nullptr; }
    const EffectTables& effects() const { return tables_; }
    /// Of a camera whose lens is not of revolution; else null.
    const PupilGrid* pupil_grid() const { return pupil_grid_.get(); }
    /// Whether its pupil is the same for any last set-up.
    bool has_pupil_anew() const { return !pupil_ || !pupil_->is_moved(); }
    FilmArea film_area() const;
    /// Whether lights can be followed through every surface of the lens.
    bool traces_lights() const {
        return has_real_pupil(camera_.model) && camera_.model != CameraModel::polynomial_lens;
    }
    /// Between the lens's axis and the farthest from it that the film sees, rad.
    double widest_angle() const;
    /// Of such a camera, if its lens is one of revolution; else null.
    const PupilEntries* pupil_entries() const { return pupil_entries_.get(); }

private:
    /// Before anything is made from it: a camera without a lens has no surface to begin with.
    static const Camera& validated(const Camera& camera);

    /// Distance of the film point furthest from the axis, mm.
    double film_radius() const { return camera_.film.radius_mm(); }

    /// Finds where rays are sent into the lens, or takes it over.
    void set_pupil(const PupilTracer& tracer, const CameraSetup* last, PupilStart start);
    /// Throws InputError where no light arrives.
    void check_light() const;

    void set_map(const PupilTracer& tracer, const CameraSetup* last);

    static CameraPlacement placement(const Affine<double>& scene_from_camera, Vec3d origin_m);

    void set_times(CameraView& view, bool scene_moves) const;

    bool has_lens_and_film_of(const Camera& camera) const;
    /// Whether it has a pupil, and that is one for all of these wavelengths and this sampling.
    bool has_pupil_for(const std::vector<double>& wavelengths, PupilSampling sampling) const;

    Camera camera_;
    LensEffects effects_;
    LensPath<float> path_;
    EffectTables tables_;
    std::optional<LensPath<double>> path_in_double_;
    LensView<double> view_in_double_{};
    std::optional<LensPolynomial> polynomial_;
    std::vector<CameraPlacement> keys_;  ///< positions relative to the first
    std::shared_ptr<const Pupil> pupil_;  ///< of a centred lens of revolution
    std::shared_ptr<const PupilGrid> pupil_grid_;  ///< of any other
    std::shared_ptr<const PupilEntries> pupil_entries_;
    float axis_irradiance_ = 0;  ///< of an ideal lens
    std::shared_ptr<const LensMap> map_;  ///< of the model mapped_lens
};

}  // namespace REALCAM_NAMESPACE
