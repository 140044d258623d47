#pragma once
#include "glass_resonances.hpp"
#include "wavefront.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of one object point where it meets the film plane.
struct FilmRay {
    bool passes;
    Vec2<double> at;  ///< mm from the chief ray
    Vec3d direction;  ///< unit
    double path;  ///< optical path to there less that of the chief ray, over the index behind the lens, mm
};

/// A ray as a plane wave on the film, beside the sphere that runs from the exit pupil to the chief ray's film point.
struct WaveRay {
    Vec2<double> slope;  ///< of its path along the film: its direction cosines less those of the sphere
    double path;  ///< at the chief ray's film point, mm
};

/// All light of one object point at one wavelength, by where its rays cross the entry plane (ObjectPoint::Entry): there
/// it is even, and the lens maps what passes to the film.
class PointBundle {
public:
    using Entry = ObjectPoint::Entry;

    bool mirrored;  ///< whether x and -x are alike, as all is round; blades need not be
    ObjectPoint object;
    Entry chief_entry;  ///< of the chief ray
    Vec2<double> chief;  ///< where the chief ray meets the film, mm from the axis
    double index;  ///< behind the lens
    double wave_number;  ///< 2 pi index / wavelength, 1/mm
    Entry middle, reach;  ///< of a rectangle in the entry plane that what passes lies in, or hardly beyond
    Vec2<double> centroid;  ///< of the spot, mm from the chief ray
    Vec2<double> spot;  ///< half the sides of the rectangle about the chief ray that holds the spot, mm
    Vec2<double> slope_low, slope_high;  ///< of the rays that pass

    static constexpr int kLook = 40;

    /// `look`: rays across the stop by which the bundle is found, of which those that pass are to be enough to say
    /// where the light is. Throws InputError for a field point or wavelength that makes no sense, and where no light
    /// reaches the film.
    PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                const RayLoop& loop = {}, int look = kLook)
        : mirrored(lens.iris.blades == 0 || lens.is_wide_open()),
          object(in_known_glass(lens, wavelength_nm), wavelength_nm, field),
          path_(lens, LightDirection::to_film, wavelength_nm),
          open_(AimingPath::open(path_)),
          real_(AimingPath::real(path_)),
          film_distance_(film_distance) {
        index = lens.indices(wavelength_nm).back();
        wave_number = 2e6 * std::numbers::pi * index / wavelength_nm;
        const FieldRays rays = look_for(lens, wavelength_nm, field, look, loop);
        chief_entry = rays.chief.entry;
        const FilmRay at_chief = on_film(rays.chief.origin, rays.chief.direction, rays.chief.path);
        chief = {mirrored ? 0 : at_chief.at.x, at_chief.at.y};
        chief_path_ = at_chief.path;
        chief_direction_ = at_chief.direction;
        curvature_ = wavefront_detail::reference_curvature(lens, wavelength_nm, rays, film_distance, ExitPupil::real);
        if (!std::isfinite(curvature_))
            throw InputError("psf: the exit pupil of lens \"" + lens.name + "\" lies in the film plane");
        measure(rays, look);
    }

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        trace_lens(real_.view(), rays, PathRecord<double, N>{});
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Rays through the lens without its rims, so that a ray's neighbours are there too.
    template <int N>
    void trace(const Entry (&entries)[N], FilmRay (&found)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        PathRecord<double, N> record{};
        trace_lens(open_.view(), rays, record);
        for (int i = 0; i < N; ++i)
            found[i] = from_chief(rays.status[i] == 0, rays.origin[i], rays.direction[i],
                                  record.optical_path[i] + path_.entry_index * object.path_difference(entries[i]));
    }

    /// The plane wave that has the ray's path and direction where the ray lands. There the sphere's own path is taken
    /// off: its curvature on the film changes no intensity, and taken off it leaves the rays' differences, which are
    /// small, and of which the curvature of each is negligible as long as the film is far from the exit pupil.
    WaveRay as_wave(const FilmRay& ray) const {
        const Vec2<double> q = ray.at;
        const double tilt = chief_direction_.x * q.x + chief_direction_.y * q.y, square = q.x * q.x + q.y * q.y;
        // |q + R d| - R and its gradient, d the chief ray's direction, in a form that holds for R = infinity too.
        const double root = std::sqrt(1 + curvature_ * (2 * tilt + curvature_ * square));
        const double sphere = (2 * tilt + curvature_ * square) / (1 + root);
        const Vec2<double> slope = {ray.direction.x - (chief_direction_.x + curvature_ * q.x) / root,
                                    ray.direction.y - (chief_direction_.y + curvature_ * q.y) / root};
        return {slope, ray.path - sphere - slope.x * q.x - slope.y * q.y};
    }

    /// Energy of the light for each area of the entry plane, over that in its middle: even in solid angle.
    double energy(Entry entry) const {
        const double d = object.inverse_distance;
        return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * d * d, -1.5);
    }

private:
    static constexpr int kCloseLook = 200;

    /// A twentieth of the rays over the whole stop, and not so few that they do not tell where the light is.
    static std::size_t few(int look) { return static_cast<std::size_t>(std::max(3 * look * look / 80, 20)); }

    static const LensSystem& in_known_glass(const LensSystem& lens, double wavelength_nm) {
        check_wavelength_in_glasses(lens, wavelength_nm, "psf");
        return lens;
    }

    /// Rays over the whole stop; more of them where the lens lets few pass.
    static FieldRays look_for(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, int look,
                              const RayLoop& loop) {
        try {
            FieldRays rays = field_rays(lens, wavelength_nm, field, square_grid(look, loop), loop);
            std::size_t passing = 0;
            for (std::size_t i = 0; i < rays.rays.size(); ++i) passing += rays.passes(i);
            if (passing >= few(look)) return rays;
        } catch (const InputError&) {
            // Also thrown where it makes no sense to look closer; then it is thrown again.
        }
        return field_rays(lens, wavelength_nm, field, square_grid(kCloseLook, loop), loop);
    }

    void measure(const FieldRays& rays, int look) {
        Entry low = {kInfinity, kInfinity}, high = {-kInfinity, -kInfinity};
        slope_low = low, slope_high = high;
        spot = centroid = {0, 0};
        double weight = 0;
        for (std::size_t i = 0; i < rays.rays.size(); ++i) {
            if (!rays.passes(i)) continue;
            const AimedRay& ray = rays.rays[i];
            const auto widen = [](Vec2<double>& least, Vec2<double>& most, Vec2<double> v) {
                least = {std::min(least.x, v.x), std::min(least.y, v.y)};
                most = {std::max(most.x, v.x), std::max(most.y, v.y)};
            };
            widen(low, high, ray.entry);
            const FilmRay found = from_chief(true, ray.origin, ray.direction, ray.path);
            widen(slope_low, slope_high, as_wave(found).slope);
            spot = {std::max(spot.x, std::fabs(found.at.x)), std::max(spot.y, std::fabs(found.at.y))};
            centroid = {centroid.x + found.at.x, centroid.y + found.at.y};
            weight += 1;
        }
        centroid = {centroid.x / weight, centroid.y / weight};
        middle = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
        // What lies beyond the outermost rays: half a cell on either side, and a hair where all are in one line.
        const double beyond = 1 + 2.0 / look, hair = 1e-3 * std::hypot(high.x - low.x, high.y - low.y);
        if (mirrored) middle.x = centroid.x = 0;
        reach = {beyond * 0.5 * (high.x - low.x) + hair, beyond * 0.5 * (high.y - low.y) + hair};
    }

    template <int N>
    void start(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            rays.origin.set(i, object.at(entries[i]) - Vec3d{0, 0, path_.entry_position});
            rays.direction.set(i, path_.entry_index * object.direction(entries[i]));
            rays.status[i] = 0;
        }
    }

    FilmRay on_film(Vec3d origin, Vec3d direction, double path) const {
        const double parameter = (film_distance_ - origin.z) / direction.z, n = length(direction);
        const Vec3d at = origin + parameter * direction;
        return {true, {at.x, at.y}, (1 / n) * direction, path / index + parameter * n};
    }
    FilmRay from_chief(bool passes, Vec3d origin, Vec3d direction, double path) const {
        FilmRay ray = on_film(origin, direction, path);
        ray.passes = passes;
        ray.at = {ray.at.x - chief.x, ray.at.y - chief.y};
        ray.path -= chief_path_;
        return ray;
    }

    LensPath<double> path_;
    AimingPath open_, real_;
    double film_distance_;
    double chief_path_, curvature_;  ///< 1 / distance from the exit pupil to the chief ray's film point
    Vec3d chief_direction_;
};

}  // namespace REALCAM_NAMESPACE
