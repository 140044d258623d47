#pragma once
#include <string>

#include "../trace/lens_path.hpp"
#include "../trace/trace_request.hpp"

namespace REALCAM_NAMESPACE {

/// Floating-point type in which rays are traced.
enum class Precision { float32, float64 };

/// Results of a trace: arrays of `count` rays that the caller owns.
struct TracedRays {
    double* origins;  ///< count x 3: point on the last surface hit, mm, lens frame
    double* directions;  ///< count x 3: unit vectors
    double* optical_path;  ///< count: sum of index times distance from the start to `origins`, mm
    int* status;  ///< count: RayStatus
    int* surface_index;  ///< count: index (from 0) of the last surface hit or missed; -1 for RayStatus::bad_input
};

/// Part of a lens, prepared for tracing requests of rays in precision T: the first surfaces that the light hits. Owns
/// the data of their views.
template <class T>
class TracePath {
public:
    /// `surface_count`: number of surfaces, in the order of the light; negative: all. Throws InputError if the
    /// wavelength is not from 100 to 20000 nm, or if the lens does not have that many surfaces.
    TracePath(const LensSystem& lens, LightDirection direction, double wavelength_nm, int surface_count)
        : path_(lens, direction, checked(wavelength_nm)) {
        const int all = static_cast<int>(lens.surfaces.size());
        count_ = surface_count < 0 ? all : surface_count;
        if (count_ < 1 || count_ > all)
            throw InputError("the number of surfaces to trace must lie between 1 and " + std::to_string(all));
        const int last = direction == LightDirection::to_film ? count_ - 1 : all - count_;
        exit_position_ = lens.vertices()[static_cast<std::size_t>(last)];
    }

    /// Returns a request to trace `count` rays; `origins` and `directions` have three numbers per ray. It is valid as
    /// long as this object and the arrays.
    TraceRequest<T> request(std::int64_t count, const double* origins, const double* directions,
                            const TracedRays& out) const {
        LensView<T> view = path_.view();
        view.count = count_;
        return {view,
                path_.entry_position,
                exit_position_,
                path_.entry_index,
                path_.entry_reach,
                count,
                origins,
                directions,
                out.origins,
                out.directions,
                out.optical_path,
                out.status,
                out.surface_index};
    }

private:
    /// Returns the wavelength. Throws InputError if it is out of range.
    static double checked(double wavelength_nm) {
        if (!(wavelength_nm >= 100 && wavelength_nm <= 20000))
            throw InputError("the wavelength must lie between 100 and 20000 nm");
        return wavelength_nm;
    }

    LensPath<T> path_;
    int count_;
    double exit_position_;  ///< z of the last surface's vertex, mm
};

}  // namespace REALCAM_NAMESPACE
