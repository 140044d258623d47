#pragma once
#include <optional>

#include "bundle_quadrature.hpp"
#include "point_bundle.hpp"

namespace REALCAM_NAMESPACE {

/// amplitude exp(i k (path + slope . q)) at a place q of the film, mm from the chief ray; k the wave number.
struct PlaneWave {
    Vec2<double> slope;
    double path, amplitude;
};

/// Light of a bundle, sampled. |sum of the plane waves|^2 times (k / 2 pi)^2 over `energy` is irradiance: its integral
/// over the film is 1.
struct PlaneWaves {
    std::vector<PlaneWave> waves;
    double energy;
    bool mirrored;  ///< each wave is half its own and half its mirror image's, of slope.x the other way
};

inline PlaneWaves with_mirror_images(const PlaneWaves& light) {
    PlaneWaves all{{}, light.energy, false};
    for (PlaneWave wave : light.waves) {
        wave.amplitude *= 0.5;
        all.waves.push_back(wave);
        wave.slope.x = -wave.slope.x;
        all.waves.push_back(wave);
    }
    return all;
}

/// Phase, in radians, by which the plane waves of a bundle differ on a window of the film: from the middle of what
/// passes to its edge, at the place where they differ most. `centre` and half the window's side are in mm, from the
/// chief ray.
inline double largest_phase(const PointBundle& bundle, Vec2<double> centre, double half_window) {
    const auto part = [&](double low, double high, double from_chief, double spot) {
        return 0.5 * (high - low) * (std::fabs(from_chief) + half_window + spot);
    };
    return bundle.wave_number * std::hypot(part(bundle.slope_low.x, bundle.slope_high.x, centre.x, bundle.spot.x),
                                           part(bundle.slope_low.y, bundle.slope_high.y, centre.y, bundle.spot.y));
}

/// Enough for a phase of z: on a spoke Gauss's rule needs z / 4 nodes, about the spokes the trapezoid rule z of them;
/// the errors fall off within some cube roots of z beyond (as Bessel functions of an order beyond their argument do).
/// The least number is for edges with corners, at which the trapezoid rule has an error of second order.
inline BundleSampling sampling_for(double phase) {
    const double more = std::cbrt(phase);
    return {std::max(160, static_cast<int>(phase + 8 * more + 16)), static_cast<int>(0.25 * phase + 4 * more + 8)};
}

/// The plane wave of the light about a place of the entry plane, and how its slope depends on the place.
struct LocalWave {
    PointBundle::Entry entry;
    WaveRay wave;
    Vec2<double> by_x, by_y;  ///< derivatives of the slope, 1/mm
    Vec2<double>
        at;  ///< where the ray lands, mm from the chief ray: less the derivative of the wave's path by its slope

    double determinant() const { return by_x.x * by_y.y - by_x.y * by_y.x; }
    /// The place that has this slope, as far as the derivatives tell.
    PointBundle::Entry entry_at(Vec2<double> slope) const {
        const double dx = slope.x - wave.slope.x, dy = slope.y - wave.slope.y;
        return {entry.x + (dx * by_y.y - dy * by_y.x) / determinant(),
                entry.y + (dy * by_x.x - dx * by_x.y) / determinant()};
    }
    double path_at(Vec2<double> slope) const {
        return wave.path - at.x * (slope.x - wave.slope.x) - at.y * (slope.y - wave.slope.y);
    }
};

/// Nothing where no ray comes through, even without rims.
inline std::optional<LocalWave> local_wave(const PointBundle& bundle, PointBundle::Entry entry) {
    const double step = 1e-6 * std::max(bundle.reach.x, bundle.reach.y);
    const PointBundle::Entry entries[3] = {entry, {entry.x + step, entry.y}, {entry.x, entry.y + step}};
    FilmRay rays[3];
    bundle.trace(entries, rays);
    if (!rays[0].passes || !rays[1].passes || !rays[2].passes) return {};
    const WaveRay wave = bundle.as_wave(rays[0]);
    const auto derivative = [&](const FilmRay& ray) {
        const Vec2<double> slope = bundle.as_wave(ray).slope;
        return Vec2<double>{(slope.x - wave.slope.x) / step, (slope.y - wave.slope.y) / step};
    };
    return LocalWave{entry, wave, derivative(rays[1]), derivative(rays[2]), rays[0].at};
}

/// The bundle's light as plane waves. The amplitude of each is the root of its energy times the range of slopes that it
/// stands for: by Parseval's theorem the sum of the waves then has the energy of the rays, and where the wavefront is
/// steep it is the rays' density on the film.
inline PlaneWaves plane_waves(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {}) {
    const std::vector<EntryPart> parts = entry_parts(bundle, sampling, loop);
    PlaneWaves light{{}, 0, bundle.mirrored};
    loop.append_all(light.waves, parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const std::optional<LocalWave> local = local_wave(bundle, parts[i].entry);
            if (!local) continue;
            const double amplitude = std::sqrt(bundle.energy(parts[i].entry) * std::fabs(local->determinant()));
            light.waves[i] = {local->wave.slope, local->wave.path, parts[i].area * amplitude};
        }
    });
    for (const EntryPart& part : parts) light.energy += bundle.energy(part.entry) * part.area;
    return light;
}

}  // namespace REALCAM_NAMESPACE
