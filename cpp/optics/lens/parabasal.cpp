#include "parabasal.hpp"

#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

/// Coordinate system whose z axis is the chief ray at one point.
struct ChiefRayFrame {
    Vec3d origin, x, y, z;

    /// The y axis lies in the plane of the y axis of the film or camera frame and the ray.
    ChiefRayFrame(Vec3d origin, Vec3d direction) : origin(origin), z(direction) {
        x = normalized(cross(std::fabs(z.y) < 0.9999999 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -z.y}, z));
        y = cross(z, x);
    }

    /// Returns a ray's coordinates: x and y of its intersection with the plane through the origin, then x and y of its
    /// direction.
    std::array<double, 4> coordinates_of(Vec3d point, Vec3d direction) const {
        const Vec3d offset = point - (dot(point - origin, z) / dot(direction, z)) * direction - origin;
        return {dot(offset, x), dot(offset, y), dot(direction, x), dot(direction, y)};
    }
};

// Derivatives by the four inputs (x and y of position and direction) with central differences of the fourth order in
// the step: offsets in steps, and their weights.
constexpr int kInputs = 4, kOffsets = 4;
constexpr double kOffset[kOffsets] = {-2, -1, 1, 2};
constexpr double kWeight[kOffsets] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
using FilmFan = LensRays<double, kInputs * kOffsets>;

/// Returns rays about the chief ray at the film, displaced by each offset in each input. `steps`: step of each input;
/// mm and optical directions.
FilmFan fan_about_chief_ray(const RaysFromFilm& rays, const ChiefRayFrame& film,
                            const std::array<double, kInputs>& steps) {
    const double n = rays.film_index();
    FilmFan fan;
    for (int i = 0; i < kInputs; ++i)
        for (int k = 0; k < kOffsets; ++k) {
            const double offset = kOffset[k] * steps[static_cast<std::size_t>(i)];
            const Vec3d position = (i == 0 ? offset : 0.0) * film.x + (i == 1 ? offset : 0.0) * film.y;
            const double px = i == 2 ? offset : 0.0, py = i == 3 ? offset : 0.0;
            const int lane = kOffsets * i + k;
            fan.origin.set(lane, film.origin + position);
            fan.direction.set(lane, -(px * film.x + py * film.y + std::sqrt(n * n - px * px - py * py) * film.z));
            fan.status[lane] = 0;
        }
    return fan;
}

/// Derivatives of a vector by the position and by the direction at the film. `value(lane)` returns the vector of a ray
/// of the fan.
struct FilmDerivatives {
    Matrix2 position, direction;

    template <class Value>
    FilmDerivatives(const std::array<double, kInputs>& steps, Value&& value) {
        Vec2<double> columns[kInputs];
        for (int i = 0; i < kInputs; ++i) {
            columns[i] = {0, 0};
            for (int k = 0; k < kOffsets; ++k) {
                const Vec2<double> v = value(kOffsets * i + k);
                const double weight = kWeight[k] / steps[static_cast<std::size_t>(i)];
                columns[i] = {columns[i].x + weight * v.x, columns[i].y + weight * v.y};
            }
        }
        position = {{columns[0].x, columns[1].x}, {columns[0].y, columns[1].y}};
        direction = {{columns[2].x, columns[3].x}, {columns[2].y, columns[3].y}};
    }
};

/// Throws InputError: there are no rays about a chief ray.
[[noreturn]] void fail(const LensSystem& lens) {
    throw InputError(
        "lens \"" + lens.name +
        "\" has no first-order data: no ray is found from the centre of the film to the centre of the stop "
        "and out of the lens");
}

/// Returns the length of the longer column.
double longer_column(const Matrix2& m) {
    return std::max(hypotenuse(m.first.x, m.second.x), hypotenuse(m.first.y, m.second.y));
}

}  // namespace

ParabasalRays parabasal_rays(const LensSystem& lens, double wavelength_nm, Vec2<double> film_point) {
    const RaysFromFilm rays(lens, wavelength_nm);
    const std::optional<ChiefRay> chief = chief_ray_of_film_point(rays, film_point);
    if (!chief) fail(lens);
    return parabasal_rays(lens, rays, *chief);
}

ParabasalRays parabasal_rays(const LensSystem& lens, const RaysFromFilm& rays, const ChiefRay& chief) {
    const ChiefRayFrame film(chief.film, chief.film_direction), scene(chief.scene, chief.scene_direction);
    // The first pass has tiny steps, to find how far a ray moves on the stop. The second has steps that move it by a
    // thousandth of the stop's clear semi-diameter.
    std::array<double, kInputs> steps{1e-6, 1e-6, 1e-6, 1e-6};
    ParabasalRays found{chief, {}, {}, {}, {}, {}, {}, {}, {}};
    for (int pass = 0; pass < 2; ++pass) {
        FilmFan at_stop = fan_about_chief_ray(rays, film, steps);
        rays.to_stop(at_stop);
        for (const int status : at_stop.status)
            if (status != 0) fail(lens);
        const FilmDerivatives stop(
            steps, [&](int lane) { return Vec2<double>{at_stop.origin.x[lane], at_stop.origin.y[lane]}; });
        found.stop_by_film_position = stop.position;
        found.stop_by_film_direction = stop.direction;
        const double displacement = 1e-3 * lens.stop().clear_semi_diameter;
        const double position = displacement / longer_column(stop.position),
                     direction = displacement / longer_column(stop.direction);
        if (pass == 0) steps = {std::min(position, 1.0), std::min(position, 1.0), direction, direction};
    }
    FilmFan in_scene = fan_about_chief_ray(rays, film, steps);
    rays.to_scene(in_scene);
    std::array<std::array<double, 4>, kInputs * kOffsets> coordinates;
    for (int lane = 0; lane < kInputs * kOffsets; ++lane) {
        if (in_scene.status[lane] != 0) fail(lens);
        coordinates[static_cast<std::size_t>(lane)] =
            scene.coordinates_of(in_scene.origin[lane], -in_scene.direction[lane]);
    }
    // Derivatives of two consecutive coordinates.
    const auto derivatives_of = [&](std::size_t first) {
        return FilmDerivatives(steps, [&](int lane) {
            const auto& ray = coordinates[static_cast<std::size_t>(lane)];
            return Vec2<double>{ray[first], ray[first + 1]};
        });
    };
    // The map from scene to film is the inverse, which follows by transposition because ray transfer is symplectic: it
    // conserves etendue, the area in position and direction.
    const FilmDerivatives position = derivatives_of(0), direction = derivatives_of(2);
    found.position_by_position = direction.direction.transposed();
    found.position_by_direction = -1 * position.direction.transposed();
    found.direction_by_position = -1 * direction.position.transposed();
    found.direction_by_direction = position.position.transposed();
    found.stop_by_position = found.stop_by_film_position * found.position_by_position +
                             found.stop_by_film_direction * found.direction_by_position;
    found.stop_by_direction = found.stop_by_film_position * found.position_by_direction +
                              found.stop_by_film_direction * found.direction_by_direction;
    return found;
}

Vec3d entrance_pupil_centre(const ParabasalRays& rays, double index) {
    const double distance = index * 0.5 * (rays.stop_by_position.inverse() * rays.stop_by_direction).trace();
    return rays.chief.scene + distance * rays.chief.scene_direction;
}

double exit_pupil_distance(const LensSystem& lens, double wavelength_nm, Vec2<double> film) {
    const ParabasalRays rays = parabasal_rays(lens, wavelength_nm, film);
    return -0.5 * lens.indices(wavelength_nm).back() *
           (rays.stop_by_film_position.inverse() * rays.stop_by_film_direction).trace();
}

ParabasalData parabasal_data(const LensSystem& lens, double wavelength_nm) {
    const ParabasalRays rays = parabasal_rays(lens, wavelength_nm);
    const std::vector<double> index = lens.indices(wavelength_nm);
    const double before = index.front(), behind = index.back();
    const double radius = lens.open_stop_radius();
    const SingularValues power = singular_values(rays.direction_by_position);
    // Rounding error of the difference quotients, 1/mm: a smaller power counts as 0.
    const double rounding = std::max(1e-10 * power.larger, 1e-12);
    const bool is_round = power.larger - std::fabs(power.smaller) < 1e-9 * power.larger;
    // A converging lens bends parallel rays against their offsets: from `right` to `left` the matrix rotates by about
    // 180 degrees. If it also reflects, as its negative determinant shows, there is no such sign, and the lens counts
    // as converging.
    const bool has_reflection = power.smaller < 0;
    const double sign = !has_reflection && std::cos(power.left - power.right) > 0 ? -1 : 1;
    const auto focal_length_of = [&](double p) { return std::fabs(p) < rounding ? kInfinity : sign / std::fabs(p); };
    // Position of a ray of parallel light at the front surface, by its point in the stop.
    const Matrix2 pupil = rays.stop_by_position.inverse();

    // `angle`, `image_angle`: azimuths of the meridian in front of the lens and at the film, rad; `p`: power, 1/mm.
    const auto meridian = [&](double angle, double image_angle, double p) {
        const Vec2<double> v{std::cos(angle), std::sin(angle)}, u{std::cos(image_angle), std::sin(image_angle)};
        const Vec2<double> width = pupil.transposed() * v;
        Meridian m{};
        m.azimuth_deg = std::remainder(angle * 180 / std::numbers::pi, 180) + 0.0;
        if (m.azimuth_deg < -90 + 1e-9) m.azimuth_deg += 180;
        m.focal_length = focal_length_of(p);
        m.entrance_pupil_diameter = 2 * radius * hypotenuse(width.x, width.y);
        m.f_number = std::fabs(m.focal_length) / m.entrance_pupil_diameter;
        // Focus of this meridian: rays that are parallel and offset along v in front of the lens meet in their
        // component along u.
        const Vec2<double> position = rays.position_by_position * v, direction = rays.direction_by_position * v;
        const double along = std::isinf(m.focal_length) ? kInfinity
                                                        : -behind * (position.x * u.x + position.y * u.y) /
                                                              (direction.x * u.x + direction.y * u.y);
        m.back_focal_distance = lens.film_distance + along;
        return m;
    };
    const double right = is_round ? 0.0 : power.right, left = is_round ? power.left - power.right : power.left;
    const double quarter = 0.5 * std::numbers::pi;
    Meridian first = meridian(right, left, power.larger),
             second = meridian(right + quarter, left + quarter, power.smaller);
    if (std::fabs(first.azimuth_deg) > 45) std::swap(first, second);

    FirstOrder mean{};
    const double ratio = std::fabs(rays.stop_by_position.determinant());
    mean.effective_focal_length = std::isinf(first.focal_length) || std::isinf(second.focal_length)
                                      ? kInfinity
                                      : sign * std::sqrt(std::fabs(first.focal_length * second.focal_length));
    mean.back_focal_distance = 0.5 * (first.back_focal_distance + second.back_focal_distance);
    mean.entrance_pupil_diameter = 2 * radius / std::sqrt(ratio);
    mean.f_number = std::fabs(mean.effective_focal_length) / mean.entrance_pupil_diameter;
    // Chief rays cross where their offsets in the reference plane and their directions cancel.
    const double front = rays.chief.scene.z, at_film = lens.film_position();
    mean.entrance_pupil_position = entrance_pupil_centre(rays, before).z;
    const Matrix2 exit = rays.stop_by_film_position.inverse();
    mean.exit_pupil_position =
        at_film + rays.chief.film_direction.z * behind * 0.5 * (exit * rays.stop_by_film_direction).trace();
    mean.exit_pupil_diameter = 2 * radius * std::sqrt(std::fabs(exit.determinant()));
    // Rays that leave parallel have C q + D p = 0, and cross at q + t p / n = 0, the front focus.
    mean.front_focal_distance =
        std::isinf(mean.effective_focal_length)
            ? -kInfinity
            : front + rays.chief.scene_direction.z * before * 0.5 *
                          (rays.direction_by_position.inverse() * rays.direction_by_direction).trace();
    mean.film_distance = lens.film_distance;
    mean.image_index = behind;
    return {{first, second}, second.focal_length / first.focal_length, mean};
}

}  // namespace realcam
