// Camera rays for other renderers: Camera.generate_rays and Camera.ray_chunks.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "../../camera/camera_setup.hpp"
#include "../../camera/effects/dispersion/film_spectrum.hpp"
#include "../../cuda/rays/ray_arrays.hpp"
#include "../../devices/devices.hpp"
#include "../../embree/lens_rays.hpp"
#include "../bindings.hpp"
#include "../values/restored.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Camera rays as numpy arrays or DeviceArrays; see the docstrings.
struct CameraRaysResult {
    Typed<"_Doubles"> origins_m;
    Typed<"_Floats"> directions, weights;
    Typed<"_Integers"> pixels;
    Typed<"_Floats"> wavelengths_nm;
    Typed<"_Doubles"> times_s;
};

/// Shortest and longest wavelength in nm; std::nullopt: the lens's design wavelength.
using WavelengthLimits = std::optional<std::pair<double, double>>;

/// Validated request for camera rays.
struct RayRequest {
    Camera camera;
    std::uint32_t spp, seed;
    std::optional<int> gpu;  ///< number of the GPU that makes the rays; std::nullopt: the CPU
    LensEffects effects;

    /// Range of all rays of the picture.
    RayRange all() const { return all_rays(camera.film.width, camera.film.height, spp); }
};

/// Returns effects with which each ray has a wavelength of its own, drawn uniformly between the limits. Throws
/// InputError.
LensEffects effects_for(const Camera& camera, const WavelengthLimits& limits) {
    LensEffects effects;
    if (!limits) return effects;
    const auto [first, last] = *limits;
    // In this range polynomials reproduce the refractive indices of glasses to within 1e-5 (WavelengthVariable).
    if (!(first >= 300 && first <= last && last <= 2500))
        throw InputError("wavelengths_nm must be two numbers between 300 and 2500, the shorter one first");
    if (camera.model != CameraModel::full_lens)
        throw InputError("wavelengths_nm requires the camera model \"full\"; the others use a single wavelength");
    effects.dispersion = true;
    effects.even_wavelengths = WavelengthRange{first, last};
    return effects;
}

RayRequest request_of(const Camera& camera, int spp, std::int64_t seed, const std::string& device,
                      const WavelengthLimits& wavelengths) {
    if (spp < 1) throw InputError("spp must be at least 1");
    if (seed < 0 || seed > 0xffffffff) throw InputError("the seed must lie between 0 and 4294967295");
    const std::optional<int> gpu = gpu_for_rays(device);
    if (gpu) validate_on_gpu(camera);
    return {camera, static_cast<std::uint32_t>(spp), static_cast<std::uint32_t>(seed), gpu,
            effects_for(camera, wavelengths)};
}

/// Returns the camera's set-up; reuses the last one if the camera is the same. Must be called without the GIL.
std::shared_ptr<const CameraSetup> setup_of(const RayRequest& request) {
    static LastSetup last;
    return last.make(request.camera, fast_pupil_tracer(), request.effects);
}

CameraRaysResult rays_on_gpu(const RayRequest& request, RayRange range) {
    const CameraRayArrays rays = [&] {
        const Unlocked unlocked;
        return generate_ray_arrays(*request.gpu, *setup_of(request), request.spp, request.seed, range);
    }();
    return {py::cast(rays.origins_m), py::cast(rays.directions),     py::cast(rays.weights),
            py::cast(rays.pixels),    py::cast(rays.wavelengths_nm), py::cast(rays.times_s)};
}

CameraRaysResult rays_on_host(const RayRequest& request, RayRange range) {
    constexpr std::int64_t kBetweenSignals = 1 << 20;  // about ten milliseconds of work
    const std::int64_t count = range.count;
    py::array_t<double> origins_m({count, std::int64_t{3}}), times_s(count);
    py::array_t<float> directions({count, std::int64_t{3}}), weights(count), wavelengths_nm(count);
    py::array_t<int> pixels(count);
    const CameraRayOutput out{origins_m.mutable_data(), directions.mutable_data(), weights.mutable_data(),
                              wavelengths_nm.mutable_data(), times_s.mutable_data()};
    int* to_pixels = pixels.mutable_data();
    for (std::int64_t done = 0; done < count; done += kBetweenSignals) {
        heed_signals();
        const Unlocked unlocked;
        const RayRange part = {range.first + done, std::min(kBetweenSignals, count - done)};
        generate_camera_rays(*setup_of(request), request.spp, request.seed, part, out.from(done));
        for (std::int64_t i = 0; i < part.count; ++i)
            to_pixels[done + i] = static_cast<int>((part.first + i) / request.spp);
    }
    return {origins_m, directions, weights, pixels, wavelengths_nm, times_s};
}

CameraRaysResult rays_of(const RayRequest& request, RayRange range) {
    return request.gpu ? rays_on_gpu(request, range) : rays_on_host(request, range);
}

/// Iterator over chunks of the camera's rays.
struct RayChunks {
    RayRequest request;
    std::int64_t max_rays;
    std::int64_t next = 0;  ///< index of the first ray of the next chunk
};

RayChunks chunks_of(const Camera& camera, int spp, std::int64_t seed, const std::string& device,
                    const WavelengthLimits& wavelengths_nm, std::int64_t max_rays) {
    if (max_rays < 1) throw InputError("max_rays must be at least 1");
    return {request_of(camera, spp, seed, device, wavelengths_nm), max_rays};
}

CameraRaysResult next_chunk(RayChunks& chunks) {
    const std::int64_t left = chunks.request.all().count - chunks.next;
    if (left <= 0) throw py::stop_iteration();
    const RayRange range = {chunks.next, std::min(left, chunks.max_rays)};
    chunks.next += range.count;
    return rays_of(chunks.request, range);
}

/// Returns an array with one row per wavelength cell: its first and last wavelength in nm, and the film's response
/// (red, green, blue) to white if all light is in this cell.
py::array_t<double> film_of_white(const std::string& illuminant) {
    const FilmSpectrum spectrum(Illuminant::parse(illuminant));
    py::array_t<double> rows({static_cast<py::ssize_t>(spectrum.cells().size()), py::ssize_t{5}});
    double* row = rows.mutable_data();
    for (const WavelengthCell& cell : spectrum.cells()) {
        *row++ = static_cast<double>(cell.first_nm);
        *row++ = static_cast<double>(cell.last_nm);
        for (int channel = 0; channel < 3; ++channel)
            *row++ =
                static_cast<double>(cell.film[3 * channel] + cell.film[3 * channel + 1] + cell.film[3 * channel + 2]);
    }
    return rows;
}

}  // namespace

void bind_camera_rays(py::module_& m) {
    py::class_<CameraRaysResult> rays(
        m, "CameraRays",
        R"(Rays of a camera in front of its lens, spp for each pixel, row by row from the upper left. numpy arrays or
DeviceArrays. See Camera.generate_rays.)");
    def_result(rays, [](const CameraRaysResult& r) {
        const py::ssize_t count = length_of(r.weights);
        check_arrays('f', {count, 3}, {r.origins_m, r.directions});
        check_arrays('f', {count}, {r.weights, r.wavelengths_nm, r.times_s});
        check_arrays('i', {count}, {r.pixels});
    });
    rays.def_readonly("origins_m", &CameraRaysResult::origins_m, "(N, 3) float64: origins, scene.")
        .def_readonly("directions", &CameraRaysResult::directions, "(N, 3) float32: unit directions, scene.")
        .def_readonly(
            "weights", &CameraRaysResult::weights,
            R"((N,) float32: irradiance on the film for unit radiance. The irradiance of a pixel is the mean over its
rays of weight times radiance. 0 if the lens blocks the ray.)")
        .def_readonly("pixels", &CameraRaysResult::pixels, "(N,) int32: index of the pixel, row * columns + column.")
        .def_readonly("wavelengths_nm", &CameraRaysResult::wavelengths_nm,
                      "(N,) float32: wavelengths at which the lens was traced.")
        .def_readonly(
            "times_s", &CameraRaysResult::times_s,
            "(N,) float64: times in the scene at which the rays pass the shutter, stratified over each pixel's "
            "exposure.")
        .def("__repr__", [](const CameraRaysResult& r) {
            return "<realcam.CameraRays " + counted(py::len(r.weights), "ray") + '>';
        });
    py::class_<RayChunks>(m, "RayChunks", "Iterator over chunks of a camera's rays, see Camera.ray_chunks.")
        .def("__iter__", [](const Typed<"Self">& self) { return self; })
        .def("__next__", &next_chunk, "Returns the CameraRays of the next chunk.");
    py::reinterpret_borrow<py::class_<Camera>>(m.attr("Camera"))
        .def(
            "generate_rays",
            [](const Camera& camera, int spp, std::int64_t seed, const std::string& device,
               const WavelengthLimits& wavelengths_nm) {
                const RayRequest request = request_of(camera, spp, seed, device, wavelengths_nm);
                return rays_of(request, request.all());
            },
            py::kw_only(), "spp"_a = 1, "seed"_a = 0, "device"_a = "cpu", "wavelengths_nm"_a = py::none(),
            R"(Generates the rays that realcam.render would trace, for use in another renderer; 56 bytes each.
spp: rays per pixel. seed: of the random numbers.
device: "cpu": the results are numpy arrays; "cuda", "cuda:1": they are DeviceArrays in that GPU's memory; "auto": a GPU
  if there is one.
wavelengths_nm: (shortest, longest), 300 to 2500: each ray has its own wavelength, drawn uniformly between them, with
  the glasses' refractive indices there. The irradiance of the band is the mean of weight times spectral radiance, times
  (longest - shortest). None: all rays have the lens's design wavelength.
Returns CameraRays. Raises InputError and DeviceError.)")
        .def("ray_chunks", &chunks_of, py::kw_only(), "spp"_a = 1, "seed"_a = 0, "device"_a = "cpu",
             "wavelengths_nm"_a = py::none(), "max_rays"_a = std::int64_t{1} << 22,
             R"(Returns an iterator over CameraRays with the rays of generate_rays in chunks of at most max_rays, for
pictures whose rays do not fit into memory. A chunk may end between two rays of a pixel. Raises InputError and
DeviceError.)");
    m.def("_film_of_white", &film_of_white, "illuminant"_a,
          R"(Internal. Returns one row per wavelength cell of an illuminant, (N, 5): its shortest and longest wavelength
in nm, and the film's response (red, green, blue) to a white surface if all light has wavelengths of this cell.)");
}

}  // namespace realcam::bindings
