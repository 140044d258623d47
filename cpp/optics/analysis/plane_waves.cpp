#include "plane_waves.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/hypotenuse.hpp"

namespace realcam {

PlaneWaves with_mirror_images(const PlaneWaves& light) {
    PlaneWaves all{{}, light.energy, false};
    for (PlaneWave wave : light.waves) {
        wave.amplitude *= 0.5;
        all.waves.push_back(wave);
        wave.slope.x = -wave.slope.x;
        all.waves.push_back(wave);
    }
    return all;
}

double largest_phase(const PointBundle& bundle, Vec2<double> centre, double half_window) {
    const auto part = [&](double low, double high, double from_chief, double spot) {
        return 0.5 * (high - low) * (std::fabs(from_chief) + half_window + spot);
    };
    return bundle.wave_number * hypotenuse(part(bundle.slope_low.x, bundle.slope_high.x, centre.x, bundle.spot.x),
                                           part(bundle.slope_low.y, bundle.slope_high.y, centre.y, bundle.spot.y));
}

BundleSampling sampling_for(double phase) {
    const double more = std::cbrt(phase);
    return {std::max(160, static_cast<int>(phase + 8 * more + 16)), static_cast<int>(0.25 * phase + 4 * more + 8)};
}

PointBundle::Entry LocalWave::entry_at(Vec2<double> slope) const {
    const double dx = slope.x - wave.slope.x, dy = slope.y - wave.slope.y;
    return {entry.x + (dx * by_y.y - dy * by_y.x) / determinant(),
            entry.y + (dy * by_x.x - dx * by_x.y) / determinant()};
}

std::optional<LocalWave> local_wave(const PointBundle& bundle, PointBundle::Entry entry) {
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

PlaneWaves plane_waves(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop) {
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

}  // namespace realcam
