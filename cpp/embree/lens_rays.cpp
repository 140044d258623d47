#include "lens_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <vector>

#include "embree_backend.hpp"
#include "kernels.hpp"

namespace realcam {
namespace {

constexpr std::int64_t kChunk = 4096;

template <class F>
void in_chunks(std::int64_t count, F&& f) {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, kChunk),
                      [&](const tbb::blocked_range<std::int64_t>& range) { f(range.begin(), range.end()); });
}

/// Unit directions, and the status with which each ray starts. Bad rays are replaced by harmless ones.
void prepare(std::int64_t count, const double* origins, const double* directions, double* origin, double* unit,
             int* status) {
    for (std::int64_t i = 0; i < count; ++i) {
        const Vec3d o{origins[3 * i], origins[3 * i + 1], origins[3 * i + 2]};
        const Vec3d d{directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]};
        const double size = std::hypot(d.x, d.y, d.z);
        const bool good = std::isfinite(o.x + o.y + o.z) && std::isfinite(size) && size > 0;
        status[i] = static_cast<int>(good ? RayStatus::ok : RayStatus::bad_input);
        const Vec3d p = good ? o : Vec3d{0, 0, 0},
                    u = good ? Vec3d{d.x / size, d.y / size, d.z / size} : Vec3d{0, 0, 0};
        origin[3 * i] = p.x, origin[3 * i + 1] = p.y, origin[3 * i + 2] = p.z;
        unit[3 * i] = u.x, unit[3 * i + 1] = u.y, unit[3 * i + 2] = u.z;
    }
}

template <class T>
void trace_with(const LensPath<T>& path, double exit_position, int surface_count, void (*kernel)(const realcam_trace*),
                std::int64_t count, const double* origins, const double* directions, const TracedRays& out) {
    LensView<T> view = path.view();
    view.count = surface_count;
    in_chunks(count, [&](std::int64_t first, std::int64_t last) {
        const std::int64_t n = last - first;
        std::vector<double> origin(static_cast<std::size_t>(3 * n)), unit(static_cast<std::size_t>(3 * n));
        prepare(n, origins + 3 * first, directions + 3 * first, origin.data(), unit.data(), out.status + first);
        realcam_trace request{};
        request.lens_view = &view;
        request.entry_position = path.entry_position;
        request.entry_index = path.entry_index;
        request.origins = origin.data();
        request.directions = unit.data();
        request.out_origins = out.origins + 3 * first;
        request.out_directions = out.directions + 3 * first;
        request.optical_path = out.optical_path + first;
        request.status = out.status + first;
        request.surface_index = out.surface_index + first;
        request.count = n;
        kernel(&request);
        for (std::int64_t i = first; i < last; ++i) {
            const bool bad = out.status[i] == static_cast<int>(RayStatus::bad_input);
            out.origins[3 * i + 2] = bad ? 0 : out.origins[3 * i + 2] + exit_position;
        }
    });
}

}  // namespace

void trace_rays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                int surface_count, std::int64_t count, const double* origins, const double* directions,
                const TracedRays& out) {
    if (!(wavelength_nm >= 100 && wavelength_nm <= 20000))
        throw InputError("the wavelength must lie between 100 and 20000 nm");
    const int all = static_cast<int>(lens.surfaces.size());
    if (surface_count < 0) surface_count = all;
    if (surface_count < 1 || surface_count > all)
        throw InputError("the number of surfaces to trace must lie between 1 and " + std::to_string(all));
    const int last = direction == LightDirection::to_film ? surface_count - 1 : all - surface_count;
    const double exit_position = lens.vertices()[static_cast<std::size_t>(last)];
    if (precision == Precision::float64) {
        const LensPath<double> path(lens, direction, wavelength_nm);
        trace_with(path, exit_position, surface_count, kernels().trace_f64, count, origins, directions, out);
    } else {
        const LensPath<float> path(lens, direction, wavelength_nm);
        trace_with(path, exit_position, surface_count, kernels().trace_f32, count, origins, directions, out);
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
