#pragma once
#include "gradient_kernels.hpp"
#include "warp_tiles.hpp"

// Policies of the tangents' trace for one ray in each thread, for nvcc only.

namespace realcam {

/// Media policy of a single ray in double precision. `surfaces`: as in WavelengthsInDouble, or null if the ray has the
/// wavelength of the lens.
struct RayWavelength {
    const IndexCubic* surfaces;
    float variable;

    struct Boundary {
        double change;
        static constexpr bool is_coated = false;
        __device__ double squared_index_change(int) const { return change; }
    };
    __device__ Boundary at(const SurfaceView<double>& surface, int index) const {
        return {surfaces ? static_cast<double>(surfaces[index].at(variable)) : surface.squared_index_change};
    }
    __device__ RayWavelength from(int index) const { return {surfaces ? surfaces + index : nullptr, variable}; }
};

__device__ inline RayWavelength wavelength_of(const GradientJob& job, float variable) {
    return {job.camera.effects.dispersion ? job.camera.dispersion.to_scene : nullptr, variable};
}

/// `sums` of trace_tangents_to_scene that calls visit(k, origins, directions, tangents of the origins) for each
/// surface. Contributions are not used.
template <class Visit>
struct VisitCrossings {
    Visit& visit;
    AdjointStep<1> unused;
    Lanes<double, 1> unused_pose;

    __device__ AdjointStep<1>& surface(int) { return unused; }
    __device__ AdjointStep<1>& film() { return unused; }
    __device__ NoFreeforms forms(int) const { return {}; }
    __device__ Lanes<double, 1>& pose(int) { return unused_pose; }
    __device__ void finish(int k, const TangentRays<1>& rays) {
        if (k != kStartOnFilm) visit(k, rays.origin, rays.direction, rays.tangents[0].origin);
    }
};

/// `sums` of trace_tangents_to_scene that adds up the contributions of a warp's rays. All threads of the warp must
/// trace together, those without a ray one that has ended.
class WarpSums {
public:
    /// `sums`: those of the warp.
    __device__ WarpSums(const GradientJob& job, double* sums) : job_(job), sums_(sums), next_(sums), step_{}, pose_{} {}

    __device__ AdjointStep<1>& surface(int) { return step_; }
    __device__ AdjointStep<1>& film() { return step_; }
    __device__ NoFreeforms forms(int) const { return {}; }
    __device__ Lanes<double, 1>& pose(int i) { return pose_[i]; }
    __device__ void finish(int k, const LensRays<double, 1>& rays) {
        constexpr std::uint32_t kFrame = (1u << kFrameNumbers) - 1;
        const std::uint32_t used = k == kStartOnFilm ? kFrame : job_.used_numbers[k];
        const bool alive = rays.status[0] == 0;
        REALCAM_UNROLL
        for (int number = 0; number < kSurfaceNumbers; ++number) {
            if (used >> number & 1u) add(alive ? step_.sums[number][0] : 0.0);
            step_.sums[number][0] = 0;
        }
    }
    /// Adds the pose, the stop and the rims, and returns to the first sum.
    __device__ void finish_ray(const LensRays<double, 1>& rays, double by_stop, double by_rims) {
        const bool alive = rays.status[0] == 0;
        REALCAM_UNROLL
        for (int i = 0; i < 6; ++i) {
            add(alive ? pose_[i][0] : 0.0);
            pose_[i][0] = 0;
        }
        add(by_stop);
        add(by_rims);
        next_ = sums_;
    }

private:
    /// Adds a number of all threads to the next sum, in a fixed order.
    __device__ void add(double number) {
        const double sum = sum_of_neighbours(number, kWarpSize);
        if (threadIdx.x % kWarpSize == 0) *next_ += sum;
        ++next_;
    }

    const GradientJob& job_;
    double *sums_, *next_;
    AdjointStep<1> step_;
    Lanes<double, 1> pose_[6];
};

/// A ray that has ended, for threads that have none.
template <int M>
__device__ TangentRays<1, M> ended_ray(const GradientJob& job) {
    TangentRays<1, M> rays;
    set_film_ray(job.outline, {0, 0, 0}, {0, 0, 0}, rays, 0);
    for (RayTangents<1>& tangents : rays.tangents) tangents.direction.set(0, {0, 0, 0});
    rays.status[0] = static_cast<int>(RayStatus::vignetted);
    return rays;
}

}  // namespace realcam
