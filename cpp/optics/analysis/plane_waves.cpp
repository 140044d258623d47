#include "plane_waves.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "psf.hpp"

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
    const auto phase_along = [&](double low, double high, double from_chief, double spot) {
        return 0.5 * (high - low) * (std::fabs(from_chief) + half_window + spot);
    };
    return bundle.wave_number *
           hypotenuse(phase_along(bundle.slope_low.x, bundle.slope_high.x, centre.x, bundle.spot.x),
                      phase_along(bundle.slope_low.y, bundle.slope_high.y, centre.y, bundle.spot.y));
}

BundleSampling sampling_for(double phase) {
    const double margin = std::cbrt(phase);
    return {std::max(160, static_cast<int>(phase + 8 * margin + 16)), static_cast<int>(0.25 * phase + 4 * margin + 8)};
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
    const std::vector<QuadratureRay> parts = quadrature_rays(bundle, sampling, loop);
    PlaneWaves light{{}, 0, bundle.mirrored};
    loop.append_all(light.waves, parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const std::optional<LocalWave> local = local_wave(bundle, parts[i].entry);
            if (!local) continue;
            const double amplitude = std::sqrt(bundle.energy(parts[i].entry) * std::fabs(local->determinant()));
            light.waves[i] = {local->wave.slope, local->wave.path, parts[i].area * amplitude};
        }
    });
    for (const QuadratureRay& part : parts) light.energy += bundle.energy(part.entry) * part.area;
    return light;
}

PlaneWaveSum::PlaneWaveSum(FilmGrid grid, double wave_number)
    : grid_(grid),
      wave_number_(wave_number),
      half_((static_cast<std::size_t>(grid.size) / 2 + 1 + kVectorWidth - 1) / kVectorWidth * kVectorWidth),
      rows_(static_cast<std::size_t>(grid.size)),
      sums_(rows_ * 4 * half_),  // re cos, im cos, re sin, im sin of each row
      cos_(kMaxWaves * half_),
      sin_(kMaxWaves * half_) {}

void PlaneWaveSum::add(const PlaneWaves& light, const RayLoop& loop) {
    const std::vector<PlaneWave>& waves = light.waves;
    // The loop may assign 64 items at a time to a thread. A row counts as 64 items, so that even few rows are divided
    // among the threads.
    constexpr std::size_t kItems = 64;
    const auto row_from = [](std::size_t item) { return (item + kItems - 1) / kItems; };
    for (std::size_t from = 0; from < waves.size(); from += kMaxWaves) {
        const std::size_t count = std::min(kMaxWaves, waves.size() - from);
        tabulate(waves.data() + from, count);
        loop.for_all(rows_ * kItems, [&](std::size_t first, std::size_t last) {
            add_to_rows(waves.data() + from, count, light.mirrored, row_from(first), row_from(last));
        });
    }
}

std::complex<double> PlaneWaveSum::operator()(int x, int y) const {
    const double* sums = sums_.data() + static_cast<std::size_t>(y) * 4 * half_;
    const int from_middle = x - grid_.size / 2;
    const auto a = static_cast<std::size_t>(std::abs(from_middle));
    const double sign = from_middle < 0 ? -1 : 1;
    return {sums[a] - sign * sums[3 * half_ + a], sums[half_ + a] + sign * sums[2 * half_ + a]};
}

void PlaneWaveSum::tabulate(const PlaneWave* waves, std::size_t count) {
    for (std::size_t w = 0; w < count; ++w) {
        const std::complex<double> step = std::polar(1.0, wave_number_ * waves[w].slope.x * grid_.pitch);
        std::complex<double> phase = 1;
        for (std::size_t a = 0; a < half_; ++a) {
            cos_[w * half_ + a] = phase.real();
            sin_[w * half_ + a] = phase.imag();
            phase = {phase.real() * step.real() - phase.imag() * step.imag(),
                     phase.real() * step.imag() + phase.imag() * step.real()};
        }
    }
    // Waves are added in whole groups; the last one is padded with zeros.
    const std::size_t end = (count + kUnroll - 1) / kUnroll * kUnroll;
    std::fill(cos_.begin() + static_cast<std::ptrdiff_t>(count * half_),
              cos_.begin() + static_cast<std::ptrdiff_t>(end * half_), 0.0);
    std::fill(sin_.begin() + static_cast<std::ptrdiff_t>(count * half_),
              sin_.begin() + static_cast<std::ptrdiff_t>(end * half_), 0.0);
}

void PlaneWaveSum::add_to_rows(const PlaneWave* waves, std::size_t count, bool mirrored, std::size_t first,
                               std::size_t last) {
    double re[kMaxWaves] = {}, im[kMaxWaves] = {}, step_re[kMaxWaves] = {}, step_im[kMaxWaves] = {};
    for (std::size_t w = 0; w < count; ++w) {
        step_re[w] = std::cos(wave_number_ * waves[w].slope.y * grid_.pitch);
        step_im[w] = std::sin(wave_number_ * waves[w].slope.y * grid_.pitch);
    }
    // Phases advance from row to row by a rotation, and are recomputed at fixed rows, whatever range of rows is
    // requested: the sums do not depend on the division among threads.
    for (std::size_t row = first / kRowsPerRestart * kRowsPerRestart; row < last; ++row) {
        if (row % kRowsPerRestart == 0) set_phases(waves, count, row, re, im);
        double* sums = sums_.data() + row * 4 * half_;
        for (std::size_t w = 0; row >= first && w < count; w += kUnroll) {
            add_group(re + w, im + w, cos_.data() + w * half_, sums, sums + half_);
            if (!mirrored) add_group(re + w, im + w, sin_.data() + w * half_, sums + 2 * half_, sums + 3 * half_);
        }
        for (std::size_t w = 0; w < kMaxWaves; ++w) {
            const double next_re = re[w] * step_re[w] - im[w] * step_im[w];
            im[w] = re[w] * step_im[w] + im[w] * step_re[w];
            re[w] = next_re;
        }
    }
}

void PlaneWaveSum::set_phases(const PlaneWave* waves, std::size_t count, std::size_t row, double* re,
                              double* im) const {
    const double y = grid_.centre.y + grid_.offset(static_cast<int>(row));
    for (std::size_t w = 0; w < count; ++w) {
        const double path = waves[w].path + waves[w].slope.x * grid_.centre.x + waves[w].slope.y * y;
        re[w] = waves[w].amplitude * std::cos(wave_number_ * path);
        im[w] = waves[w].amplitude * std::sin(wave_number_ * path);
    }
}

void PlaneWaveSum::add_group(const double* re, const double* im, const double* x_factors, double* re_sums,
                             double* im_sums) const {
    const std::size_t half = half_;
    const double r0 = re[0], r1 = re[1], r2 = re[2], r3 = re[3], i0 = im[0], i1 = im[1], i2 = im[2], i3 = im[3];
#pragma omp simd
    for (std::size_t a = 0; a < half; ++a) {
        const double x0 = x_factors[a], x1 = x_factors[half + a], x2 = x_factors[2 * half + a],
                     x3 = x_factors[3 * half + a];
        re_sums[a] += r0 * x0 + r1 * x1 + r2 * x2 + r3 * x3;
        im_sums[a] += i0 * x0 + i1 * x1 + i2 * x2 + i3 * x3;
    }
}

}  // namespace realcam
