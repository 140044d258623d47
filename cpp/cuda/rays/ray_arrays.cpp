#include "ray_arrays.hpp"

#include "../../camera/camera_setup.hpp"
#include "../device/cuda_stream.hpp"
#include "../device/share_array.hpp"
#include "array_kernels.hpp"
#include "cuda_rays.hpp"

namespace realcam {
namespace {

/// An array as float64: the original, or a converted copy if it is float32.
class Doubles {
public:
    Doubles(const ForeignNumbers& numbers, std::int64_t count, cudaStream_t stream)
        : data_(static_cast<const double*>(numbers.data)) {
        if (numbers.type == NumberType::float64) return;
        converted_.resize(static_cast<std::size_t>(count));
        launch_widen(static_cast<const float*>(numbers.data), count, converted_.data(), stream);
        data_ = converted_.data();
    }
    const double* data() const { return data_; }

private:
    DeviceArray<double> converted_;
    const double* data_;
};

}  // namespace

TracedArrays trace_arrays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                          int surface_count, std::int64_t count, ForeignNumbers origins, ForeignNumbers directions) {
    const int ordinal = origins.ordinal;
    const CurrentDevice current(ordinal);
    const CudaStream stream;
    const Doubles from(origins, 3 * count, stream), along(directions, 3 * count, stream);
    const auto rays = static_cast<std::size_t>(count);
    DeviceArray<double> to(3 * rays), towards(3 * rays), path(rays);
    DeviceArray<int> status(rays), surface(rays);
    stream.wait("converting rays");
    trace_rays_on_device(ordinal, lens, direction, wavelength_nm, precision, surface_count, count, from.data(),
                         along.data(), {to.data(), towards.data(), path.data(), status.data(), surface.data()});
    return {share(std::move(to), ordinal, {count, 3}), share(std::move(towards), ordinal, {count, 3}),
            share(std::move(path), ordinal, {count}), share(std::move(status), ordinal, {count}),
            share(std::move(surface), ordinal, {count})};
}

CameraRayArrays generate_ray_arrays(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range) {
    const Camera& camera = setup.camera();
    const std::int64_t count = range.count;
    constexpr std::int64_t kMaxRays = std::int64_t{1} << 48;  // beyond this, sizes in bytes would overflow
    if (count > kMaxRays)
        throw OutOfDeviceMemory(
            std::to_string(count) +
            " rays are more than any GPU's memory holds; use fewer spp, or generate them in chunks");
    const CurrentDevice current(ordinal);
    const CudaStream stream;
    const auto rays = static_cast<std::size_t>(count);
    DeviceArray<float> relative(3 * rays), directions(3 * rays), weights(rays), shares(rays), wavelengths(rays);
    DeviceArray<double> origins(3 * rays), times(rays);
    DeviceArray<int> pixels(rays);
    generate_camera_rays_on_device(
        ordinal, setup, spp, seed, range,
        {relative.data(), directions.data(), weights.data(), shares.data(), wavelengths.data()});
    launch_rays_to_scene({relative.data(), shares.data(), camera.pose.position_m, camera.exposure(), range, spp,
                          origins.data(), times.data(), pixels.data()},
                         stream);
    stream.wait("placing rays");
    return {share(std::move(origins), ordinal, {count, 3}), share(std::move(directions), ordinal, {count, 3}),
            share(std::move(weights), ordinal, {count}),    share(std::move(wavelengths), ordinal, {count}),
            share(std::move(times), ordinal, {count}),      share(std::move(pixels), ordinal, {count})};
}

}  // namespace realcam
