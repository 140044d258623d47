#pragma once
#include <vector>

#include "dual_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Which frame rays leave in.
enum class ExitFrame {
    lens,       ///< the lens frame
    last_axis,  ///< that of the axis behind the last surface, from its vertex on: the film stands there
    film,       ///< that of film_path_ends, shifted to the film, whose vertex is in the origin
};

/// A ray where it leaves, and the derivatives of seven numbers: its origin, its optical direction and its optical path
/// from the start, mm.
struct RayDerivatives {
    static constexpr int kNumbers = 7;
    RayStatus status = RayStatus::ok;
    Vec3d origin{}, direction{};
    double path = 0;
    double by_start[kNumbers][6] = {};  ///< by the origin and the optical direction at the start
    std::vector<double> by_variable;  ///< by the variables: seven numbers for each
};

/// The path of rays through a lens, with derivatives by some of its numbers.
///
/// At each surface the core's trace finds the crossing in double. From there one step of Newton's method in dual
/// numbers has the exact derivatives, by the implicit function theorem; and so has the quadratic formula of a conic.
/// Each surface gives the derivatives of the ray behind it by the ray before it and by the variables that it depends
/// on. They are multiplied from the last surface backwards, which takes as long for one variable as for all.
class DualPath {
public:
    /// `has_rims`: whether rims, blades and obstructions block rays. Throws InputError for variables that make no
    /// sense.
    DualPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
             std::vector<LensVariable> variables, ExitFrame exit, bool has_rims = true);

    std::size_t variable_count() const { return variables_.size(); }
    int surface_count() const { return static_cast<int>(views_.size()); }
    double entry_index() const { return entry_index_; }
    double entry_position() const { return entry_position_; }
    double entry_reach() const { return entry_reach_; }

    /// What a ray leaves behind at each surface.
    class Tape {
        friend class DualPath;
        /// Of a ray's seven numbers behind a surface, by the lanes of a dual surface.
        struct Derivatives {
            Dual8::Derivatives of[RayDerivatives::kNumbers];
        };
        struct Step {
            Vec3d origin, direction;
            double path;
            std::vector<Derivatives> by;  ///< for each dual surface
        };
        Vec3d start_direction_;
        std::vector<Step> steps_;
        RayStatus status_ = RayStatus::ok;
    };

    /// Follows a ray from an origin relative to the first vertex that the light meets, with an optical direction, over
    /// the first `surfaces`; negative: all.
    RayStatus trace(Vec3d origin, Vec3d direction, Tape& tape, int surfaces = -1) const;
    /// The derivatives behind the first `surfaces` of a ray that has come so far, in the frame of the last of them.
    void derivatives_behind(const Tape& tape, int surfaces, RayDerivatives& ray) const;
    /// Those of a ray that has passed, in the exit frame.
    void derivatives(const Tape& tape, RayDerivatives& ray) const;

private:
    friend class AdjointPath;
    void add_surfaces(const LensSystem& lens, const std::vector<DualLens>& lenses, bool to_film);
    void write(const DualSurface& surface, bool has_ray, Vec3d o, Vec3d p, Vec3d at, Tape::Derivatives& by) const;

    std::vector<LensVariable> variables_;
    // The core's view, surface by surface.
    std::vector<SurfaceView<double>> views_;
    std::vector<FrameChanges<double>> frames_;
    std::vector<FreeformView<double>> freeforms_;
    std::vector<ApertureView<double>> apertures_;
    Iris<double> iris_{};
    LensKind kind_;
    // The same with derivatives. Of the first, lanes 0 to 5 are those of the ray; others have variables alone.
    std::vector<std::vector<DualSurface>> duals_;
    bool leaves_along_axis_ = false;  ///< the exit frame is shifted along z alone, whatever the variables
    std::vector<Affine<Dual8>> exits_;  ///< from the last surface's frame to the exit frame, by eight variables each
    std::vector<Dual8> entry_positions_, entry_indices_;  ///< by eight variables each
    double entry_index_, entry_position_, entry_reach_;
};

}  // namespace REALCAM_NAMESPACE
