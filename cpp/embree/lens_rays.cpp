#include "lens_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <vector>

#include "embree_backend.hpp"

namespace realcam {
namespace {

constexpr std::int64_t kChunk = 4096;

template <class F>
void in_chunks(std::int64_t count, F&& f) {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, kChunk),
                      [&](const tbb::blocked_range<std::int64_t>& range) { f(range.begin(), range.end()); });
}

template <class T>
void trace_with(const LensPath<T>& path, double exit_position, int surface_count, void (*kernel)(const realcam_trace*),
                std::int64_t count, const double* origins, const double* directions, const TracedRays& out) {
    LensView<T> view = path.view();
    view.count = surface_count;
    in_chunks(count, [&](std::int64_t first, std::int64_t last) {
        realcam_trace request{};
        request.lens_view = &view;
        request.entry_position = path.entry_position;
        request.exit_position = exit_position;
        request.entry_index = path.entry_index;
        request.entry_reach = path.entry_reach;
        request.origins = origins + 3 * first;
        request.directions = directions + 3 * first;
        request.out_origins = out.origins + 3 * first;
        request.out_directions = out.directions + 3 * first;
        request.optical_path = out.optical_path + first;
        request.status = out.status + first;
        request.surface_index = out.surface_index + first;
        request.count = last - first;
        kernel(&request);
    });
}

}  // namespace

void trace_rays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                int surface_count, std::int64_t count, const double* origins, const double* directions,
                const TracedRays& out, const realcam_kernels* on) {
    if (!(wavelength_nm >= 100 && wavelength_nm <= 20000))
        throw InputError("the wavelength must lie between 100 and 20000 nm");
    const int all = static_cast<int>(lens.surfaces.size());
    if (surface_count < 0) surface_count = all;
    if (surface_count < 1 || surface_count > all)
        throw InputError("the number of surfaces to trace must lie between 1 and " + std::to_string(all));
    const int last = direction == LightDirection::to_film ? surface_count - 1 : all - surface_count;
    const double exit_position = lens.vertices()[static_cast<std::size_t>(last)];
    const realcam_kernels& chosen = on ? *on : kernels();
    if (precision == Precision::float64) {
        const LensPath<double> path(lens, direction, wavelength_nm);
        trace_with(path, exit_position, surface_count, chosen.trace_f64, count, origins, directions, out);
    } else {
        const LensPath<float> path(lens, direction, wavelength_nm);
        trace_with(path, exit_position, surface_count, chosen.trace_f32, count, origins, directions, out);
    }
}

void generate_camera_rays(const Camera& camera, std::uint32_t spp, std::uint32_t seed, double* origins_m,
                          float* directions, float* weights) {
    const CameraSetup setup(camera, fast_pupil_tracer());
    const CameraView view = setup.view(camera.pose.position_m);
    const std::int64_t pixels = static_cast<std::int64_t>(camera.film.width) * camera.film.height;
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, pixels, kChunk / spp + 1),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                          const std::int64_t first = range.begin() * spp,
                                             count = static_cast<std::int64_t>(range.size()) * spp;
                          std::vector<float> origins(static_cast<std::size_t>(3 * count));
                          realcam_ray_request request{};
                          request.camera_view = &view;
                          request.first_pixel = static_cast<int>(range.begin());
                          request.pixel_count = static_cast<int>(range.size());
                          request.sample_count = spp;
                          request.seed = seed;
                          request.origins = origins.data();
                          request.directions = directions + 3 * first;
                          request.weights = weights + first;
                          kernels().generate_rays(&request);
                          // The camera's place is added in double: far from the scene's origin float would lose the
                          // pupil.
                          const Vec3d place = camera.pose.position_m;
                          for (std::int64_t i = 0; i < count; ++i) {
                              const float* from = origins.data() + 3 * i;
                              double* to = origins_m + 3 * (first + i);
                              to[0] = place.x + static_cast<double>(from[0]);
                              to[1] = place.y + static_cast<double>(from[1]);
                              to[2] = place.z + static_cast<double>(from[2]);
                          }
                      });
}

}  // namespace realcam
