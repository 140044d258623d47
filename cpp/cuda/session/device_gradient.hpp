#pragma once
#include <bit>
#include <vector>

#include "../../optics/derivatives/outline_rays.hpp"
#include "../device/cuda_stream.hpp"
#include "../device/device_array.hpp"
#include "../kernels/gradient_kernels.hpp"
#include "device_scene.hpp"

namespace realcam {

/// Camera and arrays of one GPU for the derivatives of a picture. Created by make_on_device; that GPU must be
/// the current device when a function is called. Functions throw DeviceError.
class DeviceGradient {
public:
    /// Copies the camera to the GPU; the host's copy may be freed afterwards. `camera`: view of the camera with the
    /// extended film; `used_numbers`: TangentPath::numbers_in_use of `path`.
    DeviceGradient(const DeviceScene& scene, const CameraView& camera, const PathSettings& settings,
                   const GradientFilm& film, const TangentPath& path, const std::vector<std::uint32_t>& used_numbers,
                   const OutlineRays& outline) {
        const auto copy = [&](const auto* from, std::size_t count) { return arrays_.copy(from, count, stream_); };
        job_.scene = scene.view(), job_.bvh = scene.bvh();
        job_.camera = with_copied_arrays(camera, copy);
        job_.path = settings;
        job_.film = film;
        job_.outline = outline.view();
        const auto surfaces = static_cast<std::size_t>(job_.outline.lens.count);
        job_.outline.lens.surfaces = copy(job_.outline.lens.surfaces, surfaces);
        job_.outline.lens.free.move_arrays(job_.outline.lens.count, [&](auto*& array, int count) {
            if (array) array = copy(array, static_cast<std::size_t>(count));
        });
        job_.tangents = path.view();
        job_.tangents.surfaces = copy(job_.tangents.surfaces, surfaces);
        job_.used_numbers = copy(used_numbers.data(), used_numbers.size());
        job_.sum_count = kFrameNumbers + kPoseAndRims;
        for (const std::uint32_t numbers : used_numbers) job_.sum_count += std::popcount(numbers);
        stream_.wait("copying a lens to it");
    }

    static constexpr int kPoseAndRims = 8;

    const CudaStream& stream() const { return stream_; }
    const GradientJob& job() const { return job_; }

    // Working memory, which grows on demand.
    DeviceArray<GradientRay> rays;
    DeviceArray<OutlineEdge> edges;
    DeviceArray<float> adjoint, control;
    DeviceArray<double> sums, totals;
    DeviceArray<FilteredPixel> picture;
    DeviceArray<unsigned long long> unexplained;

private:
    CudaStream stream_;
    DeviceArrays arrays_;
    GradientJob job_{};
};

}  // namespace realcam
