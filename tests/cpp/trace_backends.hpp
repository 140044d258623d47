#pragma once
// Every way in which this machine can trace rays through a lens: the kernels of each instruction set, in both number
// types. A test that loops over trace_backends() holds all of them to its bound.

#include <string>
#include <vector>

#include "../../cpp/embree/lens_rays.hpp"

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

struct TraceBackend {
    std::string name;
    Precision precision;
    const realcam_kernels* kernels;

    const char* number_type() const { return precision == Precision::float64 ? "float64" : "float32"; }
    double epsilon() const { return precision == Precision::float64 ? 0x1p-52 : 0x1p-23; }
    /// Without fused multiply-add every product is rounded once more.
    bool fuses() const { return kernels->instruction_set != std::string("x86-64-v2"); }

    BatchResult operator()(const LensSystem& lens, LightDirection way, const RayBatch& rays) const {
        const std::size_t n = rays.size();
        BatchResult out{std::vector<Vec3d>(n), std::vector<Vec3d>(n), std::vector<double>(n), std::vector<int>(n),
                        std::vector<int>(n)};
        if (n == 0) return out;
        trace_rays(lens, way, lens.wavelength_nm, precision, -1, static_cast<std::int64_t>(n), &rays.origins[0].x,
                   &rays.directions[0].x,
                   {&out.origins[0].x, &out.directions[0].x, out.optical_path.data(), out.status.data(),
                    out.surface_index.data()},
                   kernels);
        return out;
    }
};

inline std::vector<TraceBackend> trace_backends() {
    std::vector<TraceBackend> list;
    for (const realcam_kernels* kernels : available_kernels())
        for (const Precision precision : {Precision::float64, Precision::float32})
            list.push_back({std::string("Embree ") + kernels->instruction_set, precision, kernels});
    return list;
}

}  // namespace realcam::test
