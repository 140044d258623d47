#pragma once
#include <vector>

#include "dual_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Frame of the exit rays.
enum class ExitFrame {
    lens,  ///< the lens frame
    last_axis,  ///< axis behind the last surface, with its origin at the surface's vertex; the film is placed along it
    film,  ///< frame of film_path_ends, shifted so that the film's vertex is its origin
};

/// Exit ray with the derivatives of its seven numbers: origin (mm), optical direction, and optical path from the start
/// (mm). An optical direction has the length of the refractive index.
struct RayDerivatives {
    static constexpr int kNumbers = 7;  ///< origin (3), optical direction (3), optical path
    RayStatus status = RayStatus::ok;
    Vec3d origin{}, direction{};
    double path = 0;
    double by_start[kNumbers][6] = {};  ///< derivatives by origin and optical direction at the start
    std::vector<double> by_variable;  ///< derivatives by the variables: seven numbers for each variable
};

/// Rays through a lens, with derivatives by some of its numbers (variables).
///
/// At each surface the ray trace of lens_trace.hpp finds the intersection in double. From there, one step of Newton's
/// method in dual numbers yields the exact derivatives by the implicit function theorem; for conics, the quadratic
/// formula in dual numbers does. Each surface yields the derivatives of the ray behind it by the ray in front of it and
/// by the variables that the surface depends on. These are multiplied from the last surface backwards, which takes as
/// long for one variable as for all.
class DualPath {
public:
    /// `exit`: frame of the exit rays; `has_rims`: true if rims, blades and obstructions block rays. Throws InputError
    /// if a variable is invalid (check_variables).
    DualPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
             std::vector<LensVariable> variables, ExitFrame exit, bool has_rims = true);

    /// Number of variables.
    std::size_t variable_count() const { return variables_.size(); }
    /// Number of surfaces that the light hits.
    int surface_count() const { return static_cast<int>(views_.size()); }
    // See LensPath.
    double entry_index() const { return entry_index_; }
    double entry_position() const { return entry_position_; }
    double entry_reach() const { return entry_reach_; }

    /// Record of a traced ray behind each surface, with its derivatives.
    class Tape {
        friend class DualPath;
        /// Derivatives of a ray's seven numbers behind a surface, by the lanes of a dual surface.
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

    /// Traces a ray through the first `surfaces` surfaces (negative: all) and records it. `origin`: mm, relative to the
    /// first vertex that the light hits; `direction`: optical direction.
    RayStatus trace(Vec3d origin, Vec3d direction, Tape& tape, int surfaces = -1) const;
    /// Computes a ray and its derivatives behind the first `surfaces` surfaces, which it must have passed, in the frame
    /// of the last of them.
    void derivatives_behind(const Tape& tape, int surfaces, RayDerivatives& ray) const;
    /// Computes a ray that has passed all surfaces, and its derivatives, in the exit frame.
    void derivatives(const Tape& tape, RayDerivatives& ray) const;

private:
    friend class AdjointPath;
    /// Prepares the dual surfaces. `lenses`: the lens in dual numbers, one for every eight variables.
    void add_surfaces(const LensSystem& lens, const std::vector<DualLens>& lenses, bool to_film);
    /// Computes the derivatives of a ray behind a surface by the lanes of a dual surface. `o`, `p`: the ray behind the
    /// previous surface; `at`: its intersection with this one; `has_ray_lanes`: true if lanes 0 to 5 are derivatives by
    /// o and p.
    void differentiate(const DualSurface& surface, bool has_ray_lanes, Vec3d o, Vec3d p, Vec3d at,
                       Tape::Derivatives& by) const;

    std::vector<LensVariable> variables_;
    // The core's view of the lens, surface by surface.
    std::vector<SurfaceView<double>> views_;
    std::vector<FrameChanges<double>> frames_;
    std::vector<FreeformView<double>> freeforms_;
    std::vector<ApertureView<double>> apertures_;
    Iris<double> iris_{};
    LensKind kind_;
    // Dual surfaces of each surface. In the first one, lanes 0 to 5 hold derivatives by the incoming ray; all other
    // lanes hold those by variables.
    std::vector<std::vector<DualSurface>> duals_;
    bool leaves_along_axis_ = false;  ///< the exit frame is only shifted along z, whatever the variables
    std::vector<Affine<Dual8>> exits_;  ///< last surface's frame to exit frame, one for every eight variables
    std::vector<Dual8> entry_positions_, entry_indices_;  ///< one for every eight variables
    double entry_index_, entry_position_, entry_reach_;
};

}  // namespace REALCAM_NAMESPACE
