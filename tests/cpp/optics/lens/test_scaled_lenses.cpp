// A lens times a power of two does the same, to the last bit: nothing in the core knows how long a millimetre is.

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "camera/camera_setup.hpp"
#include "camera/models/pinhole_camera.hpp"
#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/hard_lens_list.hpp"
#include "optics/hard_rays.hpp"
#include "optics/lens/best_focus.hpp"
#include "optics/lens/exposure.hpp"
#include "pixel_rays.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

template <class T>
bool same_bits(const T* a, const T* b, std::size_t count) {
    return std::memcmp(a, b, count * sizeof(T)) == 0;
}

/// How many of these numbers are not the others times the factor.
class Differences {
public:
    explicit Differences(double factor) : factor_(factor) {}
    void length(double small, double large) { compare(factor_ * small, large); }
    void number(double a, double b) { compare(a, b); }
    int found = 0, compared = 0;

private:
    void compare(double a, double b) {
        ++compared;
        found += a != b && !(std::isnan(a) && std::isnan(b));
    }
    double factor_;
};

/// By one backend, or by the core itself: the same rays, scaled.
template <class Trace>
void compare_rays(const LensSystem& lens, const LensSystem& large, double factor, Trace&& trace,
                  Differences& differences) {
    Random random(7);
    RayBatch rays, scaled_rays;
    for (int i = 0; i < 400; ++i) {
        const Vec3d film = point_on_film(lens, random), target = point_on_last_surface(lens, random);
        rays.add(film, target - film);
        scaled_rays.add(factor * film, target - film);
    }
    const BatchResult a = trace(lens, rays), b = trace(large, scaled_rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        differences.number(a.status[i], b.status[i]);
        differences.number(a.surface_index[i], b.surface_index[i]);
        differences.length(a.optical_path[i], b.optical_path[i]);
        differences.length(a.origins[i].x, b.origins[i].x);
        differences.length(a.origins[i].y, b.origins[i].y);
        differences.length(a.origins[i].z, b.origins[i].z);
        differences.number(length(a.directions[i] - b.directions[i]), 0);
    }
}

/// The core alone, without the backends' entry, which moves origins that are more than a metre away.
template <class T>
BatchResult core_trace(const LensSystem& lens, const RayBatch& rays) {
    const LensPath<T> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const std::size_t n = rays.size();
    BatchResult out{std::vector<Vec3d>(n), std::vector<Vec3d>(n), std::vector<double>(n), std::vector<int>(n),
                    std::vector<int>(n)};
    for (std::size_t i = 0; i < n; ++i) {
        LensRays<T, 1> ray;
        ray.origin.set(0, static_cast<Vec3<T>>(rays.origins[i] - Vec3d{0, 0, path.entry_position}));
        ray.direction.set(0, static_cast<Vec3<T>>(path.entry_index * normalized(rays.directions[i])));
        ray.status[0] = 0;
        PathRecord<T, 1> record{};
        trace_lens(path.view(), ray, record);
        out.origins[i] = static_cast<Vec3d>(ray.origin[0]);
        out.directions[i] = static_cast<Vec3d>(ray.direction[0]);
        out.optical_path[i] = static_cast<double>(record.optical_path[0]);
        out.status[i] = ray.status[0];
        out.surface_index[i] = record.surface_index[0];
    }
    return out;
}

void compare_figures(const LensSystem& lens, const LensSystem& large, double factor, Differences& differences) {
    const FirstOrder a = first_order(lens, lens.wavelength_nm), b = first_order(large, large.wavelength_nm);
    differences.length(a.effective_focal_length, b.effective_focal_length);
    differences.length(a.back_focal_distance, b.back_focal_distance);
    differences.length(a.front_focal_distance, b.front_focal_distance);
    differences.number(a.f_number, b.f_number);
    differences.length(a.entrance_pupil_position, b.entrance_pupil_position);
    differences.length(a.entrance_pupil_diameter, b.entrance_pupil_diameter);
    differences.length(a.exit_pupil_position, b.exit_pupil_position);
    differences.length(a.exit_pupil_diameter, b.exit_pupil_diameter);
    if (a.is_afocal()) return;
    differences.length(stopped_down(lens, 2 * a.f_number).stop_semi_diameter,
                       stopped_down(large, 2 * b.f_number).stop_semi_diameter);
    for (const double object : {0.5, 3.0, 1e6, kInfinity})
        differences.length(best_focus_distance(lens, lens.wavelength_nm, object * lens.film_position()),
                           best_focus_distance(large, large.wavelength_nm, object * factor * lens.film_position()));
    if (lens.film_distance > a.back_focal_distance + a.effective_focal_length) return;  // not focused at infinity
    for (const double share : {1.0, 1e4}) {
        const double focus = share * near_focus(lens);
        const LensSystem near = focused(lens, focus), same = focused(large, factor * focus);
        differences.length(near.film_distance, same.film_distance);
        for (std::size_t i = 0; i < near.surfaces.size(); ++i)
            differences.length(near.surfaces[i].thickness, same.surfaces[i].thickness);
    }
}

void compare_pictures(const LensSystem& lens, const LensSystem& large, Differences& differences) {
    const Pupil a(lens, half_diagonal(lens), fast_pupil_tracer()), b(large, half_diagonal(large), fast_pupil_tracer());
    const PupilView one = a.view(), other = b.view();
    differences.length(a.image_radius(), b.image_radius());
    const auto count = static_cast<std::size_t>(one.rows);
    differences.number(same_bits(one.nodes, other.nodes, count + 1), 1);
    differences.number(same_bits(one.outline, other.outline, count * static_cast<std::size_t>(PupilView::kSectors)), 1);
    differences.number(axis_irradiance(lens), axis_irradiance(large));
    differences.number(field_angle(lens, 0.3 * lens.film_width), field_angle(large, 0.3 * large.film_width));
    for (const CameraModel model : kModels) {
        const CameraSetup small_camera(camera_with(lens, model), fast_pupil_tracer()),
            large_camera(camera_with(large, model), fast_pupil_tracer());
        for (const int column : {3, 48, 90}) {
            const CameraRays<kLanes> x = rays_of_pixel(small_camera.view({0, 0, 0}), column, 20),
                                     y = rays_of_pixel(large_camera.view({0, 0, 0}), column, 20);
            differences.number(same_bits(x.passed, y.passed, kLanes), 1);
            differences.number(same_bits(x.weight, y.weight, kLanes), 1);
            differences.number(same_bits(x.direction.x, y.direction.x, kLanes), 1);
        }
    }
}

std::vector<LensSystem> lenses_to_scale() {
    std::vector<LensSystem> list;
    for (const std::string& name : centred_lens_names()) list.push_back(io::read_lens(name));
    for (const LensSystem& lens : {fisheye_270(), Cassegrain::lens(), FastLens::lens(), contact_doublet(true)})
        list.push_back(lens);
    return list;
}

}  // namespace

TEST_CASE("a lens times a power of two has the same rays, by every backend and by the core") {
    const std::vector<LensSystem> lenses = lenses_to_scale();
    for (const TraceBackend& backend : trace_backends()) {
        Differences all(1);
        for (const LensSystem& lens : lenses)
            for (const int power : {-6, -1, 1}) {
                const double factor = std::ldexp(1.0, power);
                Differences differences(factor);
                compare_rays(
                    lens, scaled(lens, factor), factor,
                    [&](const LensSystem& l, const RayBatch& r) { return backend(l, LightDirection::to_scene, r); },
                    differences);
                CAPTURE(lens.name);
                CHECK(differences.found == 0);
                all.found += differences.found, all.compared += differences.compared;
            }
        hold({"Lenses", "rays of a lens times 2^-6, 2^-1 and 2: other bits", std::to_string(all.compared) + " numbers",
              backend.name, backend.number_type(), static_cast<double>(all.found), 0, "numbers"});
    }
    int compared = 0, found[2] = {0, 0};
    for (const LensSystem& lens : lenses)
        for (const int power : {-9, 6}) {  // 50 mm become 0.1 mm and 3.2 m
            const double factor = std::ldexp(1.0, power);
            Differences exact_type(factor), single(factor);
            compare_rays(lens, scaled(lens, factor), factor, core_trace<double>, exact_type);
            compare_rays(lens, scaled(lens, factor), factor, core_trace<float>, single);
            compared += single.compared;
            found[0] += exact_type.found, found[1] += single.found;
        }
    for (const int type : {0, 1})
        hold({"Lenses", "rays of a lens times 2^-9 and 2^6: other bits", std::to_string(compared) + " numbers", "core",
              type == 0 ? "float64" : "float32", static_cast<double>(found[type]), 0, "numbers"});
}

TEST_CASE("aspheric coefficients may leave the range of float32") {
    const double factor = std::ldexp(1.0, -14);
    const LensSystem phone = io::read_lens("phone-4mm"), small = scaled(phone, factor);
    double largest = 0;
    for (const Surface& surface : small.surfaces)
        for (const double a : surface.aspheric) largest = std::max(largest, std::fabs(a));
    CHECK(largest > 1e39);
    Differences differences(factor);
    compare_rays(phone, small, factor, core_trace<float>, differences);
    CHECK(differences.compared > 0);
    CHECK(differences.found == 0);
}

TEST_CASE("a lens times a power of two has the same first order, focus, pupil and pictures") {
    Differences all(1);
    int power = 5;
    for (const LensSystem& lens : lenses_to_scale()) {
        power = power == 5 ? -6 : 5;  // in turn
        const double factor = std::ldexp(1.0, power);
        const LensSystem large = scaled(lens, factor);
        Differences differences(factor);
        compare_figures(lens, large, factor, differences);
        compare_pictures(lens, large, differences);
        CAPTURE(lens.name);
        CAPTURE(power);
        CHECK(differences.found == 0);
        all.found += differences.found, all.compared += differences.compared;
    }
    hold({"Lenses", "first order, focus, pupil, exposure and camera rays of a lens times 2^-6 and 2^5: other bits",
          std::to_string(all.compared) + " numbers and tables", "core", "float64 and float32",
          static_cast<double>(all.found), 0, "numbers"});
}
