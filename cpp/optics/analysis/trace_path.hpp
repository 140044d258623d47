#pragma once
#include <string>

#include "../trace/lens_path.hpp"
#include "../trace/trace_request.hpp"

namespace REALCAM_NAMESPACE {

enum class Precision { float32, float64 };

/// Results of a trace: arrays of `count` rays that the caller owns.
struct TracedRays {
    double* origins;  ///< count x 3, mm, lens frame: on the last surface hit
    double* directions;  ///< count x 3, unit
    double* optical_path;  ///< count, mm: sum of index times distance up to the origin
    int* status;  ///< count, RayStatus
    int* surface_index;  ///< count: the last surface hit or missed, from 0; -1 for bad input
};

/// The first `surface_count` surfaces that the light meets (negative: all), prepared for trace requests. Owns the data
/// of their views.
template <class T>
class TracePath {
public:
    /// Throws InputError for a wavelength outside 100 to 20000 nm, or more surfaces than the lens has.
    TracePath(const LensSystem& lens, LightDirection direction, double wavelength_nm, int surface_count)
        : path_(lens, direction, checked(wavelength_nm)) {
        const int all = static_cast<int>(lens.surfaces.size());
        count_ = surface_count < 0 ? all : surface_count;
        if (count_ < 1 || count_ > all)
            throw InputError("the number of surfaces to trace must lie between 1 and " + std::to_string(all));
        const int last = direction == LightDirection::to_film ? count_ - 1 : all - count_;
        exit_position_ = lens.vertices()[static_cast<std::size_t>(last)];
    }

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
    static double checked(double wavelength_nm) {
        if (!(wavelength_nm >= 100 && wavelength_nm <= 20000))
            throw InputError("the wavelength must lie between 100 and 20000 nm");
        return wavelength_nm;
    }

    LensPath<T> path_;
    int count_;
    double exit_position_;
};

}  // namespace REALCAM_NAMESPACE
