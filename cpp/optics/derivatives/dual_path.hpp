#pragma once
#include <vector>

#include "dual_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Frame of the exit rays.
enum class ExitFrame {
    lens,  ///< the lens frame
    last_axis,  ///< axis behind the last surface, with origin at its vertex; the film is placed along it
    film,  ///< frame of film_path_ends, shifted so that the film's vertex is its origin
};

/// An exit ray and the derivatives of its seven numbers: origin, optical direction and optical path from the start, mm.
/// An optical direction has the length of the refractive index.
struct RayDerivatives {
    static constexpr int kNumbers = 7;
    RayStatus status = RayStatus::ok;
    Vec3d origin{}, direction{};
    double path = 0;
    double by_start[kNumbers][6] = {};  ///< by the origin and the optical direction at the start
    std::vector<double> by_variable;  ///< by the variables: seven numbers for each
};

/// Rays through a lens, with derivatives by some of its numbers.
///
/// At each surface the core's trace finds the intersection in double. One step of Newton's method in dual numbers from
/// there gives the exact derivatives, by the implicit function theorem; for a conic, the quadratic formula does. Each
/// surface yields the derivatives of the ray behind it by the ray before it and by the variables that it depends on.
/// These are multiplied from the last surface backwards, which takes as long for one variable as for all.
class DualPath {
public:
    /// `has_rims`: true if rims, blades and obstructions block rays. Throws InputError for invalid variables
    /// (check_variables).
    DualPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
             std::vector<LensVariable> variables, ExitFrame exit, bool has_rims = true);

    std::size_t variable_count() const { return variables_.size(); }
    int surface_count() const { return static_cast<int>(views_.size()); }
    double entry_index() const { return entry_index_; }
    double entry_position() const { return entry_position_; }
    double entry_reach() const { return entry_reach_; }

    /// Record of a traced ray at each surface.
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

    /// Traces a ray over the first `surfaces` surfaces (negative: all). `origin` is relative to the first vertex that
    /// the light meets; `direction` is an optical direction.
    RayStatus trace(Vec3d origin, Vec3d direction, Tape& tape, int surfaces = -1) const;
    /// Computes the derivatives of a ray behind the first `surfaces` surfaces, which it must have passed, in the frame
    /// of the last of them.
    void derivatives_behind(const Tape& tape, int surfaces, RayDerivatives& ray) const;
    /// Computes the derivatives of a ray that has passed all surfaces, in the exit frame.
    void derivatives(const Tape& tape, RayDerivatives& ray) const;

private:
    friend class AdjointPath;
    void add_surfaces(const LensSystem& lens, const std::vector<DualLens>& lenses, bool to_film);
    void write(const DualSurface& surface, bool has_ray, Vec3d o, Vec3d p, Vec3d at, Tape::Derivatives& by) const;

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
    std::vector<Affine<Dual8>> exits_;  ///< last surface's frame to exit frame, one for each eight variables
    std::vector<Dual8> entry_positions_, entry_indices_;  ///< one for each eight variables
    double entry_index_, entry_position_, entry_reach_;
};

}  // namespace REALCAM_NAMESPACE
