// Derivatives of film points and rims at fixed scene rays, from Hamiltonians and one tangent, against those of
// DualPath, which traces the ray from the scene and which test_ray_derivatives.cpp compares with 50 digits. Both are
// exact but for roundings; 1e-9 of the largest derivative of its kind is far above these and far below any mistake.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "doctest/doctest.h"
#include "optics/derivatives/dual_path.hpp"
#include "optics/derivatives/outline_rays.hpp"
#include "optics/derivatives/tangent_path.hpp"
#include "optics/lens/focus.hpp"
#include "optics/lens/lens_changes.hpp"
#include "optics/trace/film_frame.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"
#include "variable_lens.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kPathTolerance = 1e-9;

/// A ray from the film: point (mm) and optical direction cosines towards the scene, in the film's frame.
struct TestRay {
    double x, y, l, m;
};

/// Motion of the film's centre in the lens frame, per unit of a variable: it moves the lens in the camera's frame.
Vec3d film_motion(const LensSystem& lens, const LensVariable& v) {
    if (v.quantity == LensQuantity::film_distance) return surface_frames(lens).last_axis.z;
    // A rotation by 1e-4 degrees is linear to 1e-12, and a displacement exactly.
    const double step = v.quantity == LensQuantity::tilt ? 1e-4 : 1;
    const auto at = [&](double change) {
        LensSystem other = lens;
        Surface& s = other.surfaces[static_cast<std::size_t>(v.surface)];
        const auto part = [&](Vec3d& of) -> double& { return v.number == 0 ? of.x : v.number == 1 ? of.y : of.z; };
        if (v.quantity == LensQuantity::thickness) s.thickness += change;
        if (v.quantity == LensQuantity::decentre || v.quantity == LensQuantity::tilt) {
            s.placement.returns = moves_alone(s);
            part(v.quantity == LensQuantity::tilt ? s.placement.tilt_deg : s.placement.decentre) += change;
        }
        return film_frame(other).origin;
    };
    return (0.5 / step) * (at(step) - at(-step));
}

struct Tangents {
    CameraDerivatives by[2];  ///< derivatives of x and y on the film
    Vec3d origin, direction;  ///< ray in front of the lens, in the camera's frame, towards the scene
    std::vector<Vec3d> behind;  ///< directions behind each surface, in its frame
    std::vector<Vec3d> at;
};

constexpr int kLane = 3;  ///< the only lane with a tangent

/// Starts a ray in all lanes, and its tangent in one; `w`: direction of the tangent in the film's direction cosines.
TangentPath::Rays start_rays(const LensSystem& lens, const TestRay& ray, Vec2d w) {
    TangentPath::Rays rays;
    const double n = lens.indices(lens.wavelength_nm).back(), z = -std::sqrt(n * n - ray.l * ray.l - ray.m * ray.m);
    for (int i = 0; i < TangentPath::kLanes; ++i) {
        rays.origin.set(i, {ray.x, ray.y, lens.film_distance});
        rays.direction.set(i, {ray.l, ray.m, z});
        rays.tangents[0].direction.set(i, {0, 0, 0});
        rays.status[i] = 0;
    }
    // The light's direction cosines are opposite to the ray's.
    rays.tangents[0].direction.set(kLane, {-w.x, -w.y, (ray.l * w.x + ray.m * w.y) / z});
    return rays;
}

Tangents tangents_of(const TangentPath& path, const LensSystem& lens, const TestRay& ray) {
    Tangents result;
    for (int axis = 0; axis < 2; ++axis) {
        TangentPath::Rays rays = start_rays(lens, ray, {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0});
        TangentPath::Sums sums(path);
        path.trace(rays, sums);
        REQUIRE(rays.status[kLane] == 0);
        result.by[axis] = path.derivatives(sums);
        result.origin = rays.origin[kLane], result.direction = rays.direction[kLane];
        if (axis == 1) continue;
        for (const auto& step : sums.surfaces) {
            result.behind.push_back(step.direction[kLane]);
            result.at.push_back(step.origin[kLane]);
        }
    }
    return result;
}

/// Derivatives of a point on a plane z = const from those of a ray (origin, direction), with the ray's rate `by(i)`.
template <class By>
Vec2d landing_rate(Vec3d o, Vec3d p, By&& by) {
    const double t = -o.z / p.z, t_rate = -(by(2) + t * by(5)) / p.z;
    return {by(0) + t * by(3) + t_rate * p.x, by(1) + t * by(4) + t_rate * p.y};
}

double component(Vec2d v, int axis) {
    return axis == 0 ? v.x : v.y;
}

void check_film_points(const LensSystem& lens, const std::vector<LensVariable>& variables, const TestRay& film_ray) {
    const TangentPath path(lens, lens.wavelength_nm, variables);
    const Tangents found = tangents_of(path, lens, film_ray);
    const DualPath truth(lens, LightDirection::to_film, lens.wavelength_nm, variables, ExitFrame::film, false);
    const Vec3d film = film_frame(lens).origin;
    DualPath::Tape tape;
    RayDerivatives ray;
    REQUIRE(truth.trace(found.origin + film, -found.direction, tape) == RayStatus::ok);
    truth.derivatives(tape, ray);
    const Vec3d o = ray.origin, p = ray.direction;
    CHECK(o.x - o.z / p.z * p.x == doctest::Approx(film_ray.x).epsilon(1e-10));
    CHECK(o.y - o.z / p.z * p.y == doctest::Approx(film_ray.y).epsilon(1e-10));
    const auto pose = [&](int axis) { return found.by[axis].by_pose; };
    double largest = 0;
    for (std::size_t v = 0; v < variables.size(); ++v) {
        CAPTURE(static_cast<int>(variables[v].quantity));
        CAPTURE(variables[v].surface);
        CAPTURE(variables[v].number);
        const Vec2d wanted =
            landing_rate(o, p, [&](int i) { return ray.by_variable[7 * v + static_cast<std::size_t>(i)]; });
        const Vec3d motion = film_motion(lens, variables[v]);
        const double size = std::max(1e-6, std::hypot(wanted.x, wanted.y));
        for (int axis = 0; axis < 2; ++axis) {
            const auto by_pose = pose(axis);
            const double in_lens_frame =
                found.by[axis].by_variable[v] + by_pose[0] * motion.x + by_pose[1] * motion.y + by_pose[2] * motion.z;
            CHECK(std::fabs(in_lens_frame - component(wanted, axis)) < kPathTolerance * size);
        }
        largest = std::max(largest, size);
    }
    CHECK(largest > 1e-3);
    // A motion of the camera moves the scene ray the other way.
    const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < 6; ++i) {
        CAPTURE(i);
        const Vec3d e = axes[i % 3];
        const Vec3d o_rate = i < 3 ? -e : -cross(e, found.origin),
                    p_rate = i < 3 ? Vec3d{0, 0, 0} : cross(e, found.direction);
        const double rates[6] = {o_rate.x, o_rate.y, o_rate.z, p_rate.x, p_rate.y, p_rate.z};
        const Vec2d wanted = landing_rate(o, p, [&](int number) {
            double sum = 0;
            for (int j = 0; j < 6; ++j) sum += ray.by_start[number][j] * rates[j];
            return sum;
        });
        for (int axis = 0; axis < 2; ++axis)
            CHECK(std::fabs(pose(axis)[i] - component(wanted, axis)) <
                  kPathTolerance * std::max(1.0, std::hypot(wanted.x, wanted.y)));
    }
    // The film's own motions, in closed form: the point of the ray on a plane that is moved or rotated by e.
    const double slope[2] = {p.x / p.z, p.y / p.z}, at[2] = {film_ray.x, film_ray.y};
    for (int axis = 0; axis < 2; ++axis) {
        const auto& by = found.by[axis].by_film;
        const double wanted[6] = {axis == 0 ? -1.0 : 0.0, axis == 1 ? -1.0 : 0.0, slope[axis],
                                  at[1] * slope[axis],    -at[0] * slope[axis],   axis == 0 ? at[1] : -at[0]};
        for (std::size_t i = 0; i < 6; ++i) {
            CAPTURE(i);
            CHECK(std::fabs(by[i] - wanted[i]) < kPathTolerance * std::max(1.0, std::fabs(wanted[i])));
        }
    }
}

/// Derivatives of the distance between a scene ray's point on the plane of a rim and the rim. `surface`: index in the
/// lens.
void check_rim(const LensSystem& lens, const std::vector<LensVariable>& variables, const TestRay& film_ray,
               int surface) {
    const TangentPath path(lens, lens.wavelength_nm, variables);
    const Tangents film = tangents_of(path, lens, film_ray);
    const int k = path.surface_count() - 1 - surface;  // on the path towards the scene
    const auto here = static_cast<std::size_t>(k);
    const Vec3d at = film.at[here], p = -film.behind[here];  // of the light, in front of the surface
    const double radius = std::hypot(at.x, at.y);
    const Vec3d outwards = {at.x / radius, at.y / radius, 0};
    TangentPath::Rays rays = start_rays(lens, film_ray, {0, 0});
    TangentPath::Sums sums(path);
    std::array<int, TangentPath::kLanes> starts;
    starts.fill(k);
    std::array<Vec3d, TangentPath::kLanes> tangents{};
    tangents[kLane] = {outwards.x, outwards.y, dot(outwards, p) / -p.z};
    path.trace(rays, sums, starts.data(), tangents.data());
    const CameraDerivatives found = path.derivatives(sums);
    const DualPath truth(lens, LightDirection::to_film, lens.wavelength_nm, variables, ExitFrame::film, false);
    DualPath::Tape tape;
    RayDerivatives ray;
    REQUIRE(truth.trace(film.origin + film_frame(lens).origin, -film.direction, tape, surface + 1) == RayStatus::ok);
    truth.derivatives_behind(tape, surface + 1, ray);
    CHECK(length(ray.origin - at) < 1e-9 * radius);
    for (std::size_t v = 0; v < variables.size(); ++v) {
        CAPTURE(static_cast<int>(variables[v].quantity));
        CAPTURE(variables[v].surface);
        const double* by = &ray.by_variable[7 * v];
        double sag = 0;  // rate of the rim's z
        if (variables[v].surface == surface && variables[v].quantity == LensQuantity::curvature) {
            const Surface& s = lens.surfaces[static_cast<std::size_t>(surface)];
            sag = 0.5 * radius * radius / std::sqrt(1 - (1 + s.conic) * s.curvature * s.curvature * radius * radius);
            const double height = s.curvature * radius * radius /
                                  (1 + std::sqrt(1 - (1 + s.conic) * s.curvature * s.curvature * radius * radius));
            sag += 0.5 * (1 + s.conic) * height * height /
                   std::sqrt(1 - (1 + s.conic) * s.curvature * s.curvature * radius * radius);
        }
        const double rise = by[2] - sag;
        const double wanted = -(outwards.x * (by[0] - p.x / p.z * rise) + outwards.y * (by[1] - p.y / p.z * rise));
        const Vec3d motion = film_motion(lens, variables[v]);
        const double in_lens_frame = found.by_variable[v] + found.by_pose[0] * motion.x + found.by_pose[1] * motion.y +
                                     found.by_pose[2] * motion.z;
        CHECK(std::fabs(in_lens_frame - wanted) < kPathTolerance * std::max(1.0, std::fabs(wanted)));
    }
}

/// mixed_lens() with a film.
LensSystem lens_with_film() {
    LensSystem lens = mixed_lens();
    lens.film_distance = 25;
    return lens;
}

/// All variables of lens_with_film().
std::vector<LensVariable> all_variables() {
    std::vector<LensVariable> list = shape_variables();
    for (const int s : {0, 1, 2, 4, 5})
        for (const LensVariable& v : tilts_and_decentres(s)) list.push_back(v);
    list.push_back({LensQuantity::film_distance});
    return list;
}

/// `sums` of trace_tangents_to_scene for one ray, as a GPU traces it: only numbers that derivatives depend on are
/// added, in lane 0.
struct SumsOfOneRay {
    TangentPath::Sums& to;
    std::vector<std::uint32_t> used;
    AdjointStep<1> step{};
    Lanes<double, 1> of_pose[6]{};

    AdjointStep<1>& surface(int) { return step; }
    AdjointStep<1>& film() { return step; }
    NoFreeforms forms(int) const { return {}; }
    Lanes<double, 1>& pose(int i) { return of_pose[i]; }
    void finish(int k, const LensRays<double, 1>&) {
        AdjointStep<TangentPath::kLanes>& sum = k == kStartOnFilm ? to.film : to.surfaces[static_cast<std::size_t>(k)];
        for (int number = 0; number < kSurfaceNumbers; ++number) {
            if (k == kStartOnFilm || (used[static_cast<std::size_t>(k)] >> number & 1u) != 0)
                sum.sums[number][0] += step.sums[number][0];
            step.sums[number][0] = 0;
        }
    }
};

/// Traces a lane of a block of rays alone. `start`, `tangent`: see TangentPath::trace; null: on the film.
template <int M>
CameraDerivatives alone(const TangentPath& path, const TangentRays<TangentPath::kLanes, M>& block, const int* start,
                        const Vec3d* tangent) {
    TangentPath::Sums sums(path);
    SumsOfOneRay of_ray{sums, path.numbers_in_use()};
    TangentRays<1, M> ray;
    ray.origin.set(0, block.origin[kLane]);
    ray.direction.set(0, block.direction[kLane]);
    for (int m = 0; m < M; ++m) ray.tangents[m].direction.set(0, block.tangents[m].direction[kLane]);
    ray.status[0] = 0;
    trace_tangents_to_scene(path.view(), [](int) { return OneWavelength{}; }, ray, start, tangent, of_ray);
    for (int i = 0; i < 6; ++i) sums.pose[i][0] = of_ray.of_pose[i][0];
    return path.derivatives(sums);
}

/// Both within the roundings of vector code, which contracts products and sums in other places.
void check_equal(const CameraDerivatives& a, const CameraDerivatives& b) {
    const auto check = [](const auto& some, const auto& other) {
        REQUIRE(some.size() == other.size());
        double largest = 0;
        for (const double v : other) largest = std::max(largest, std::fabs(v));
        for (std::size_t i = 0; i < some.size(); ++i) CHECK(std::fabs(some[i] - other[i]) <= 1e-12 * largest);
    };
    check(a.by_variable, b.by_variable);
    check(a.by_film, b.by_film);
    check(a.by_pose, b.by_pose);
}

const std::vector<TestRay> kFilmRays = {{0, 0, 0.05, 0.02}, {5, -3, -0.2, 0.15}, {-6, 1, 0.25, 0.02}};

}  // namespace

TEST_CASE("film points of fixed scene rays move by Hamiltonians: spheres, conics, aspheres") {
    for (const TestRay& ray : kFilmRays) check_film_points(lens_with_film(), all_variables(), ray);
}

TEST_CASE("film points of fixed scene rays through tilted and decentred surfaces and film") {
    LensSystem lens = lens_with_film();
    lens.surfaces[1].placement = {{0.3, -0.2, 0.1}, {3, -2, 10}, false};
    lens.surfaces[4].placement = {{0, 0.5, 0}, {0, 5, 0}, true};
    lens.film_placement = {{0.2, 0.1, 0}, {2, -1, 0}, false};
    for (const TestRay& ray : kFilmRays) check_film_points(lens, all_variables(), ray);
}

TEST_CASE("film points of fixed scene rays through a dispersing lens, at three wavelengths") {
    for (const double nm : {430.0, 546.1, 680.0}) {
        LensSystem lens = io::read_lens("double-gauss-50mm");
        lens.wavelength_nm = nm;
        std::vector<LensVariable> variables;
        for (int s = 0; s < static_cast<int>(lens.surfaces.size()); ++s) {
            if (!lens.surfaces[static_cast<std::size_t>(s)].bends_light()) continue;
            variables.push_back({LensQuantity::curvature, s});
            if (lens.surfaces[static_cast<std::size_t>(s)].type == SurfaceType::refracting)
                variables.push_back({LensQuantity::index, s});
            if (s + 1 < static_cast<int>(lens.surfaces.size())) variables.push_back({LensQuantity::thickness, s});
        }
        check_film_points(lens, variables, {3, -2, 0.1, 0.12});
    }
}

TEST_CASE("film points of fixed scene rays through freeforms, by their terms") {
    SurfaceForm toroid, bent, zernike;
    toroid.base = BaseForm::toroid;
    toroid.curvature_x = 1 / 60.0;
    bent.xy = {{1, 0, 0.03}, {0, 3, -3e-4}, {2, 2, 5e-6}};
    zernike.zernike = ZernikeTerms{ZernikeOrder::noll, 11, {0, 0.1, -0.2, 0.05, 0.04, -0.06, 0.02, 0.01}};
    const std::vector<LensVariable> shared = {{LensQuantity::curvature, 0},
                                              {LensQuantity::tilt, 0, 1},
                                              {LensQuantity::thickness, 0},
                                              {LensQuantity::aspheric, 0, 4}};
    const auto check = [&](const SurfaceForm& form, std::vector<LensVariable> variables) {
        LensSystem lens = lens_with_film();
        lens.surfaces[0].form = form;
        variables.insert(variables.end(), shared.begin(), shared.end());
        check_film_points(lens, variables, {2, 1, -0.1, 0.12});
    };
    check(toroid, {{LensQuantity::curvature_x, 0}});
    check(bent, {{LensQuantity::xy, 0, 1, 0}, {LensQuantity::xy, 0, 2, 2}, {LensQuantity::xy, 0, 3, 3}});
    check(zernike, {{LensQuantity::terms, 0, 2, 0, 0}, {LensQuantity::terms, 0, 5, 0, 0}});
}

TEST_CASE("rims move at fixed scene rays: the stop, and rims of curved and of tilted surfaces") {
    LensSystem tilted = lens_with_film();
    tilted.surfaces[1].placement = {{0.3, -0.2, 0.1}, {3, -2, 10}, false};
    std::vector<LensVariable> variables;
    for (const LensVariable& v : all_variables())
        if (v.quantity != LensQuantity::aspheric && v.quantity != LensQuantity::conic) variables.push_back(v);
    for (const LensSystem& lens : {lens_with_film(), tilted})
        for (const int surface : {0, 1, 3, 4, 5})
            for (const TestRay& ray : kFilmRays) {
                CAPTURE(surface);
                check_rim(lens, variables, ray, surface);
            }
}

TEST_CASE("a ray that is traced alone, as on GPUs, has the derivatives of a block of rays") {
    LensSystem tilted = lens_with_film();
    tilted.surfaces[1].placement = {{0.3, -0.2, 0.1}, {3, -2, 10}, false};
    tilted.film_placement = {{0.2, 0.1, 0}, {2, -1, 0}, false};
    const std::vector<LensVariable> few = {{LensQuantity::thickness, 1}, {LensQuantity::index, 2}};
    for (const LensSystem& lens : {lens_with_film(), tilted})
        for (const std::vector<LensVariable>& variables : {few, all_variables()})
            for (const TestRay& film_ray : kFilmRays) {
                const TangentPath path(lens, lens.wavelength_nm, variables);
                const TangentPath::Rays start = start_rays(lens, film_ray, {0.3, -0.7});
                TangentPath::Rays rays = start;
                TangentPath::Sums sums(path);
                path.trace(rays, sums);
                check_equal(alone(path, start, nullptr, nullptr), path.derivatives(sums));
                for (int k = 0; k < path.surface_count(); ++k) {
                    rays = start;
                    sums.clear();
                    std::array<int, TangentPath::kLanes> starts;
                    starts.fill(k);
                    std::array<Vec3d, TangentPath::kLanes> tangents{};
                    tangents[kLane] = {0.6, 0.8, 0.1};
                    path.trace(rays, sums, starts.data(), tangents.data());
                    check_equal(alone(path, start, &k, &tangents[kLane]), path.derivatives(sums));
                }
            }
}

TEST_CASE("a ray with two tangents has the derivatives by the pose along the second, and all others along the first") {
    LensSystem tilted = lens_with_film();
    tilted.surfaces[1].placement = {{0.3, -0.2, 0.1}, {3, -2, 10}, false};
    for (const LensSystem& lens : {lens_with_film(), tilted})
        for (const TestRay& film_ray : kFilmRays) {
            const TangentPath path(lens, lens.wavelength_nm, all_variables());
            const TangentPath::Rays starts[2] = {start_rays(lens, film_ray, {0.3, -0.7}),
                                                 start_rays(lens, film_ray, {-0.4, 0.2})};
            TangentRays<TangentPath::kLanes, 2> start;
            static_cast<LensRays<double, TangentPath::kLanes>&>(start) = starts[0];
            for (int m = 0; m < 2; ++m) start.tangents[m] = starts[m].tangents[0];
            // `surface`: rim on which the tangents start; null: on the film.
            const auto check = [&](const int* surface) {
                std::array<int, TangentPath::kLanes> rims;
                rims.fill(surface ? *surface : 0);
                const Vec3d rim_tangents[2] = {{0.6, 0.8, 0.1}, {-0.3, 0.5, 0.2}};
                CameraDerivatives wanted;
                for (int m = 1; m >= 0; --m) {
                    std::array<Vec3d, TangentPath::kLanes> tangents{};
                    tangents[kLane] = rim_tangents[m];
                    TangentPath::Rays rays = starts[m];
                    TangentPath::Sums sums(path);
                    path.trace(rays, sums, surface ? rims.data() : nullptr, tangents.data());
                    const CameraDerivatives along = path.derivatives(sums);
                    if (m == 0) wanted.by_variable = along.by_variable, wanted.by_film = along.by_film;
                    if (m == 1) wanted.by_pose = along.by_pose;
                }
                std::array<Vec3d, 2 * TangentPath::kLanes> tangents{};
                std::copy_n(rim_tangents, 2, tangents.begin() + 2 * kLane);
                TangentRays<TangentPath::kLanes, 2> rays = start;
                TangentPath::Sums sums(path);
                path.trace(rays, sums, surface ? rims.data() : nullptr, tangents.data());
                check_equal(path.derivatives(sums), wanted);
                check_equal(alone(path, start, surface, rim_tangents), wanted);
            };
            check(nullptr);
            for (int k = 0; k < path.surface_count(); ++k) check(&k);
        }
}

TEST_CASE("points of the pupil's outline that are searched on one line are those of a block of lines") {
    const LensSystem lens = stopped_down(io::read_lens("double-gauss-50mm"), 4);
    const TangentPath path(lens, lens.wavelength_nm, {});
    const OutlineRays outline(lens, lens.wavelength_nm);
    DirectionLine lines[OutlineRays::kLanes];
    for (int i = 0; i < OutlineRays::kLanes; ++i) {
        const double angle = 2 * std::numbers::pi * i / OutlineRays::kLanes, step = 0.2;
        lines[i] = {{0.9 * i, -0.5 * i}, {-0.012 * i, 0.007 * i}, {step * std::cos(angle), step * std::sin(angle)}};
    }
    OutlinePoint points[OutlineRays::kMostPoints][OutlineRays::kLanes];
    outline.find(path, lines, 1.6, nullptr, points);
    int found = 0;
    for (int i = 0; i < OutlineRays::kLanes; ++i) {
        const DirectionLine line[1] = {lines[i]};
        OutlinePoint own[kMostOutlinePoints][1];
        find_outline(
            outline.view(), line, 1.6,
            [&](const DirectionLine(&on)[1], const double (&t)[1], int (&passes)[1]) {
                TangentRays<1> rays = outline.view().start(on, t);
                trace_lens(outline.view().lens, static_cast<LensRays<double, 1>&>(rays));
                passes[0] = rays.status[0] == 0;
            },
            [&](const DirectionLine(&on)[1], const double (&t)[1], double (&clearance)[1]) {
                measure_clearance<LensKind::any>(
                    outline.view(), path.view(), [](int) { return OneWavelength{}; }, on, t, clearance);
            },
            [&](TangentRays<1>& rays, auto&& visit) {
                TangentPath::Sums sums(path);
                struct Visited : SumsOfOneRay {
                    std::vector<TangentRays<1>> rays;
                    void finish(int k, const TangentRays<1>& behind) {
                        if (k != kStartOnFilm) rays.push_back(behind);
                    }
                } visited{{sums, {}}, {}};
                trace_tangents_to_scene(
                    path.view(), [](int) { return OneWavelength{}; }, rays, nullptr, nullptr, visited);
                for (int k = 0; const TangentRays<1>& behind : visited.rays)
                    visit(k++, behind.origin, behind.direction, behind.tangents[0].origin);
            },
            own);
        for (int n = 0; n < OutlineRays::kMostPoints; ++n) {
            const OutlinePoint &a = own[n][0], &b = points[n][i];
            // An edge is found to 1.6 / 6 of 2^-26 of the line.
            REQUIRE(a.t == doctest::Approx(b.t).epsilon(1e-8));
            if (!(b.t > 0)) continue;
            ++found;
            CHECK(a.surface == b.surface);
            CHECK(a.stop_rate == doctest::Approx(b.stop_rate).epsilon(1e-12));
            CHECK(a.rim_rate == doctest::Approx(b.rim_rate).epsilon(1e-6));
            CHECK(length(a.tangent - b.tangent) < 1e-7 * length(b.tangent));
            CHECK(a.inverse_speed == doctest::Approx(b.inverse_speed).epsilon(1e-6));
            CHECK(length(a.direction - b.direction) < 1e-7);
        }
    }
    CHECK(found >= OutlineRays::kLanes / 2);
}

TEST_CASE("derivatives of pictures on a curved film are refused") {
    LensSystem lens = lens_with_film();
    lens.name = "bent";
    lens.film_radius_of_curvature = -50;
    CHECK(message_of([&] { TangentPath(lens, 587.6, {}); }).find("of lens \"bent\" is curved") != std::string::npos);
}
