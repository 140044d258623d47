#pragma once
// All trace backends of this machine: the kernels of each instruction set and a GPU, in both number types. A test that
// loops over trace_backends() applies its bound to all of them.

#include <functional>
#include <string>
#include <vector>

#include "embree/lens_rays.hpp"
#if defined(REALCAM_HAS_CUDA)
#include "cuda/device/cuda_devices.hpp"
#include "cuda/rays/cuda_rays.hpp"
#endif

namespace realcam::test {

/// Rays in the lens frame, and what became of them.
struct RayBatch {
    std::vector<Vec3d> origins, directions;

    void add(Vec3d origin, Vec3d direction) {
        origins.push_back(origin);
        directions.push_back(direction);
    }
    std::size_t size() const { return origins.size(); }
};

struct BatchResult {
    std::vector<Vec3d> origins, directions;
    std::vector<double> optical_path;
    std::vector<int> status, surface_index;

    bool passed(std::size_t i) const { return status[i] == static_cast<int>(RayStatus::ok); }
};

/// See trace_rays.
using TraceRays =
    std::function<void(const LensSystem&, LightDirection, double wavelength_nm, Precision, int surface_count,
                       std::int64_t count, const double* origins, const double* directions, const TracedRays&)>;

struct TraceBackend {
    std::string name;
    Precision precision;
    TraceRays trace;

    const char* number_type() const { return precision == Precision::float64 ? "float64" : "float32"; }
    /// True if the backend uses fused multiply-add, which rounds a product and a sum once.
    bool fuses() const { return name != "Embree v2"; }
    double epsilon() const { return precision == Precision::float64 ? 0x1p-52 : 0x1p-23; }

    BatchResult operator()(const LensSystem& lens, LightDirection way, const RayBatch& rays) const {
        const std::size_t n = rays.size();
        BatchResult out{std::vector<Vec3d>(n), std::vector<Vec3d>(n), std::vector<double>(n), std::vector<int>(n),
                        std::vector<int>(n)};
        if (n == 0) return out;
        trace(lens, way, lens.wavelength_nm, precision, -1, static_cast<std::int64_t>(n), &rays.origins[0].x,
              &rays.directions[0].x,
              {&out.origins[0].x, &out.directions[0].x, out.optical_path.data(), out.status.data(),
               out.surface_index.data()});
        return out;
    }
};

/// Once for all: a driver takes its time to list GPUs.
inline const std::vector<TraceBackend>& trace_backends() {
    static const std::vector<TraceBackend> all = [] {
        std::vector<TraceBackend> list;
        const auto add = [&](const std::string& name, const TraceRays& trace) {
            for (const Precision precision : {Precision::float64, Precision::float32})
                list.push_back({name, precision, trace});
        };
        for (const realcam_kernels* kernels : available_kernels())
            add(std::string("Embree ") + kernels->instruction_set,
                [kernels](const auto&... asked) { trace_rays(asked..., kernels); });
#if defined(REALCAM_HAS_CUDA)
        if (!cuda_devices().empty()) add("CUDA", std::bind_front(trace_rays_on_gpu, 0));
#endif
        return list;
    }();
    return all;
}

}  // namespace realcam::test
