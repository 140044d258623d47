#pragma once
#include <array>
#include <optional>
#include <vector>

#include "adjoint_trace.hpp"
#include "tangent_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Policy of trace_tangents for lenses that may have freeforms.
struct FreeformTangents {
    const DualSurface* duals;  ///< dual surfaces of the surface
    int dual_count;
    Dual8* sums;  ///< contributions of its own variables: for each lane, as many numbers as there are dual surfaces

    static constexpr bool enabled = true;
    FreeformPoint point(Vec3d at, int lane) const { return {duals, dual_count, sums + lane * dual_count, at}; }
};

/// Derivatives by the numbers of a camera.
struct CameraDerivatives {
    std::vector<double> by_variable;  ///< lens variables
    /// Translation of the film, mm, and its rotation about its centre, rad, relative to the camera, along the film's
    /// axes (film_frame).
    std::array<double, 6> by_film{};
    /// Translation of the camera, mm, and its rotation about the film's centre, rad, along the camera's axes.
    std::array<double, 6> by_pose{};
};

/// Derivatives, at fixed scene rays, of functions of the rays on the film by the numbers of a camera: tangents of rays
/// that are traced from the film (tangent_trace.hpp). The camera's frame has the axes of the lens frame, and its origin
/// is the film's centre, as for Pose. A variable of the lens that changes the distance between film and lens therefore
/// moves the lens.
class TangentPath {
public:
    static constexpr int kLanes = 16;  ///< rays that are traced together
    using Rays = TangentRays<kLanes>;

    /// Prepares a lens. Throws InputError if a variable is invalid (check_variables) or the film is curved.
    TangentPath(const LensSystem& lens, double wavelength_nm, std::vector<LensVariable> variables);

    int surface_count() const { return static_cast<int>(surfaces_.size()); }
    std::size_t variable_count() const { return variables_.size(); }

    /// View for traces of other blocks of rays, valid as long as this object.
    TangentLens view() const { return {surfaces_.data(), surface_count(), exit_}; }
    /// Numbers of each surface that derivatives depend on, as bits (1 << SurfaceNumber).
    std::vector<std::uint32_t> numbers_in_use() const;

    /// Contributions to -dH of each lane, from all numbers of the camera; cleared by the constructor.
    struct Sums {
        explicit Sums(const TangentPath& path);
        void clear();

        AdjointStep<kLanes> film;  ///< start on the film; its origin and direction are unused
        /// Of each surface. After a trace, `origin` and `direction` are those of the ray behind the surface.
        std::vector<AdjointStep<kLanes>> surfaces;
        std::vector<std::vector<Dual8>> forms;
        Lanes<double, kLanes> pose[6];
    };

    /// Traces rays and their tangents from the film to the scene; no rim blocks them. Rays start in the frame of the
    /// film's rays (film_path_ends): x and y on the film and the film distance. A ray's tangent starts at the film,
    /// with the change of the ray's optical direction, or at the rim of surface `starts[lane]`: it then has the
    /// direction `rim_tangents[lane]` behind that surface, in whose plane the ray's point is fixed. On return, rays and
    /// tangents are those in front of the lens, in the camera's frame. `wavelengths`: indices of the rays' own
    /// wavelengths at the surfaces, in the order of the trace; null: all rays have the wavelength of the constructor.
    void trace(Rays& rays, Sums& sums, const int* starts = nullptr, const Vec3d* rim_tangents = nullptr,
               const WavelengthsInDouble* wavelengths = nullptr) const;
    /// Traces rays with two tangents in the same way. The pose's sums are those of the second, all others those of the
    /// first. `rim_tangents`: two of each lane, side by side.
    void trace(TangentRays<kLanes, 2>& rays, Sums& sums, const int* starts = nullptr,
               const Vec3d* rim_tangents = nullptr, const WavelengthsInDouble* wavelengths = nullptr) const;

    /// Rays behind a surface, in its frame, and tangents of their points on it.
    struct Crossing {
        Vec3Lanes<double, kLanes> origin, direction, origin_tangent;
    };
    /// Traces rays and their tangents from the film like `trace`, but without sums, and records their crossings of each
    /// surface.
    void record(Rays& rays, std::vector<Crossing>& crossings, const WavelengthsInDouble* wavelengths = nullptr) const;

    /// Returns the derivatives that follow from the sums of all lanes.
    CameraDerivatives derivatives(const Sums& sums) const;

    /// Derivative along a direction, as the coefficients of each sum (for_sums).
    using Coefficients = std::vector<double>;
    /// `along`: rates of the numbers of the camera in the direction.
    Coefficients coefficients(const CameraDerivatives& along) const;
    /// Adds the derivative along a direction, which follows from the sums of each lane, to `by`.
    static void add_along(const Coefficients& coefficients, const Sums& sums, std::array<double, kLanes>& by);

    /// Returns the policy of a surface; `form_sums`: see FreeformTangents::sums.
    FreeformTangents forms(int surface, Dual8* form_sums) const {
        const std::vector<DualSurface>& duals = duals_[static_cast<std::size_t>(surface)];
        return {duals.data(), static_cast<int>(duals.size()), form_sums};
    }

private:
    /// Calls f(sums of the lanes) for all sums but those of freeform terms.
    template <class SomeSums, class F>
    static void for_sums(SomeSums& sums, F&& f);
    std::vector<LensVariable> variables_;
    std::vector<TangentSurface> surfaces_;  ///< from the film to the scene
    std::vector<FreeformView<double>> freeforms_;
    /// For each surface: one without derivatives, whose lanes FreeformPoint uses, then one for every eight variables.
    std::vector<std::vector<DualSurface>> duals_;
    std::vector<DualFrame> film_frames_;  ///< motion of the film, one for every eight variables
    FrameChange<double> exit_;  ///< from the last surface's frame to the camera's
};

}  // namespace REALCAM_NAMESPACE
