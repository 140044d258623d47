// Fuzz target: cameras with absurd settings, and pupil tables at absurd film points. A camera is refused with an
// InputError, or its rays are finite and of unit length, with weights of at least 0.

#include <memory>
#include <vector>

#include "camera/camera_setup.hpp"
#include "camera/film/camera.hpp"
#include "camera/ray_request.hpp"
#include "draw_lens.hpp"
#include "embree/kernels.hpp"
#include "io/lens/lens_file.hpp"
#include "optics/lens/focus.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

bool finite(Vec3f v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

PupilTracer tracer() {
    const auto trace = kernels().trace_block;
    return {[trace](const LensView<float>& view, PupilTracer::Rays& rays) { trace(&view, &rays); }};
}

/// Lenses with a hole, with crescents at the edge of the image, with blades: their pupils are found once.
const std::vector<std::unique_ptr<CameraSetup>>& known_cameras() {
    static const std::vector<std::unique_ptr<CameraSetup>> all = [] {
        std::vector<std::unique_ptr<CameraSetup>> list;
        for (const char* name : {"double-gauss-50mm", "fisheye-6mm-220deg", "mirror-telephoto-500mm", "phone-4mm"}) {
            Camera camera;
            camera.lens = io::read_lens(name);
            camera.film.width_mm = camera.lens.film_width;
            camera.film.height_mm = camera.lens.film_height;
            list.push_back(std::make_unique<CameraSetup>(camera, tracer()));
        }
        return list;
    }();
    return all;
}

void sample_absurd_points(Bytes& in) {
    const auto& cameras = known_cameras();
    const CameraSetup& setup = *cameras[static_cast<std::size_t>(in.below(static_cast<int>(cameras.size())))];
    const PupilView pupil = setup.view({0, 0, 0}).pupil;
    const double n = std::sqrt(static_cast<double>(pupil.index_squared));
    for (int i = 0; i < 64; ++i) {
        const auto length_of = [&] {
            const double value =
                in.chance(128) ? in.between(-1.5, 1.5) * static_cast<double>(pupil.image_radius) : in.any();
            return std::isfinite(value) ? static_cast<float>(std::clamp(value, -1e9, 1e9)) : 0.0f;
        };
        const auto fraction = [&] {
            return in.chance(16) ? 1 - 0x1p-24f : in.chance(16) ? 0.0f : unit_float(in.word());
        };
        const float x = length_of(), y = length_of(), u = fraction(), v = fraction();
        const PupilSample sample = sample_pupil(pupil, x, y, u, v);
        const float pdf = pupil_pdf(pupil, x, y, sample.direction.x, sample.direction.y);
        const double size = length(static_cast<Vec3d>(sample.direction));
        const auto say = [&](const char* what) {
            report(what, "%s: film (%.9g, %.9g), u %.9g, v %.9g -> (%.9g %.9g %.9g), weight %.9g, pdf %.9g",
                   setup.camera().lens.name.c_str(), static_cast<double>(x), static_cast<double>(y),
                   static_cast<double>(u), static_cast<double>(v), static_cast<double>(sample.direction.x),
                   static_cast<double>(sample.direction.y), static_cast<double>(sample.direction.z),
                   static_cast<double>(sample.weight), static_cast<double>(pdf));
        };
        if (!finite(sample.direction)) say("a pupil sample is not finite");
        if (!(sample.weight >= 0) || !std::isfinite(sample.weight)) say("a pupil sample's weight is no weight");
        if (!(pdf >= 0) || !std::isfinite(pdf)) say("a pupil's density is no density");
        // A direction outside the medium's cone is one along the film.
        if (sample.weight > 0 && !(size < 1.5 * n)) say("a pupil sample's direction is too long");
    }
    findings().pupil_samples += 64;
}

Vec3d draw_place(Bytes& in) {
    const auto metres = [&] { return in.chance(24) ? in.any() : in.sign() * in.decades(-3, in.chance(64) ? 15 : 2); };
    return {metres(), metres(), metres()};
}

Camera draw_camera(Bytes& in) {
    const std::vector<std::string> names = io::lens_names();
    Camera camera;
    if (in.chance(64)) {
        camera.lens = draw_lens(in);
        validate(camera.lens);
    } else {
        camera.lens = io::read_lens(names[in.word() % names.size()]);
    }
    if (in.chance(128)) camera.lens = focused(camera.lens, in.chance(64) ? in.any() : in.decades(0, 9));
    if (in.chance(128)) camera.lens = stopped_down(camera.lens, in.chance(64) ? in.any() : in.decades(-1, 3));
    if (in.chance(64)) camera.lens.film_distance = in.any();
    camera.film.width_mm = in.chance(16) ? in.any() : in.decades(-4, 4);
    camera.film.height_mm = in.chance(16) ? in.any() : in.decades(-4, 4);
    camera.film.width = in.chance(16) ? static_cast<int>(in.word()) : 1 + in.below(256) * (1 + in.below(128));
    camera.film.height = in.chance(16) ? static_cast<int>(in.word()) : 1 + in.below(256);
    camera.pose = {draw_place(in), draw_place(in), in.chance(128) ? Vec3d{0, 1, 0} : draw_place(in)};
    camera.model = static_cast<CameraModel>(in.below(4));
    camera.exposure_time_s = in.chance(64) ? in.any() : 0.01;
    camera.iso = in.chance(64) ? in.any() : 100;
    return camera;
}

void check_rays(Bytes& in, const Camera& camera) {
    constexpr int kCount = 256;
    const CameraSetup setup(camera, tracer());
    const CameraView view = setup.view(camera.pose.position_m);
    const int pixels = camera.film.width * camera.film.height;
    std::vector<float> origins(3 * kCount), directions(3 * kCount), weights(kCount), times(kCount), wavelengths(kCount);
    RayRequest request{
        view,     {0, 0}, 0, 0, origins.data(), directions.data(), weights.data(), times.data(), wavelengths.data(),
        587.5618f};
    request.spp = in.chance(128) ? 1 : 8;
    const std::int64_t all = static_cast<std::int64_t>(pixels) * request.spp;
    request.range.count = std::min<std::int64_t>(all, kCount);
    request.range.first = in.word() % (all - request.range.count + 1);
    request.seed = in.word();
    kernels().generate_rays(&request);
    const int rays = static_cast<int>(request.range.count);
    findings().camera_rays += static_cast<std::uint64_t>(rays);
    for (int i = 0; i < rays; ++i) {
        const float *o = origins.data() + 3 * i, *d = directions.data() + 3 * i,
                    w = weights[static_cast<std::size_t>(i)];
        const auto say = [&](const char* what) {
            report(what,
                   "%s, model %d, film %.9g x %.9g mm, %d x %d, film distance %.9g: o (%.9g %.9g %.9g), d (%.9g %.9g "
                   "%.9g), weight %.9g",
                   camera.lens.name.c_str(), static_cast<int>(camera.model), camera.film.width_mm,
                   camera.film.height_mm, camera.film.width, camera.film.height, camera.lens.film_distance,
                   static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2]),
                   static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2]),
                   static_cast<double>(w));
        };
        if (!finite({o[0], o[1], o[2]})) say("a camera ray's origin is not finite");
        if (!finite({d[0], d[1], d[2]})) say("a camera ray's direction is not finite");
        if (!(w >= 0) || !std::isfinite(w)) say("a camera ray's weight is no weight");
        const double size = length(Vec3d{d[0], d[1], d[2]});
        if (!(std::fabs(size - 1) < 1e-5)) say("a camera ray's direction is not a unit vector");
    }
}

}  // namespace

int fuzz_camera(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    if (!in.chance(4)) {
        sample_absurd_points(in);
        return 0;
    }
    try {
        const Camera camera = draw_camera(in);
        ++findings().cameras;
        check_rays(in, camera);
        ++findings().cameras_made;
    } catch (const InputError&) {
    } catch (const LensFileError&) {
    } catch (const std::exception& error) {
        report("a camera raises something else", "%s", error.what());
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_camera)
