#include "psf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace psf_detail {

namespace {

/// Limits of the number of waves: the first takes some seconds, and only callers who specify the number of rays may
/// exceed it.
constexpr double kMostWavesUnasked = 1 << 20, kMostWaves = 1 << 24;

/// Default pitch, um: a quarter of wavelength x f-number, half the Nyquist pitch of the image; for a spot that is
/// larger than the window, up to the Nyquist pitch.
double psf_pitch(const PointBundle& bundle, int size) {
    const double across = std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    const double detail = 2e3 * std::numbers::pi / (bundle.wave_number * across);
    const double spot = 2e3 * std::max(bundle.spot.x, bundle.spot.y) + 8 * detail;
    return std::clamp(spot / size, 0.25 * detail, 0.5 * detail);
}

/// Irradiance per um^2 for a squared sum of waves of 1.
double scale_of(const Part& part) {
    const double per_mm2 = part.bundle.wave_number / (2 * std::numbers::pi);
    return 1e-6 * part.weight * per_mm2 * per_mm2 / part.light.energy;
}

/// Largest value of the same light without aberrations: all waves in phase, all colours at one point.
double ideal_peak(const std::vector<Part>& parts) {
    double ideal = 0;
    for (const Part& part : parts) {
        double amplitude = 0;
        for (const PlaneWave& wave : part.light.waves) amplitude += wave.amplitude;
        ideal += scale_of(part) * amplitude * amplitude;
    }
    return ideal;
}

/// Largest value near the array's maximum, found between its points on finer and finer grids.
double peak_near(const std::vector<Part>& parts, const Psf& psf, const RayLoop& loop) {
    const auto largest = [](const std::vector<double>& values, FilmGrid grid) {
        const auto at = static_cast<int>(std::max_element(values.begin(), values.end()) - values.begin());
        return Vec2<double>{grid.centre.x + grid.offset(at % grid.size), grid.centre.y + grid.offset(at / grid.size)};
    };
    FilmGrid grid{psf.size, 1e-3 * psf.pitch_um, {0, 0}};
    std::vector<double> values = psf.values;
    double peak = *std::max_element(values.begin(), values.end());
    Vec2<double> brightest = largest(values, grid);
    for (int i = 0; i < 6; ++i) {
        grid = {5, 1e-3 * psf.pitch_um * std::pow(0.5, i + 1), brightest};
        add_waves(parts, grid, values, loop);
        peak = std::max(peak, *std::max_element(values.begin(), values.end()));
        brightest = largest(values, grid);
    }
    return peak;
}

/// Geometric PSF: adds the energy of each ray to the grid point nearest to its film point.
void add_rays(const Part& part, Psf& psf, std::int64_t rays, const RayLoop& loop) {
    const auto points_across = [&](double spot) { return 1 + 2e3 * spot / psf.pitch_um; };
    const double enough = 16 * points_across(part.bundle.spot.x) * points_across(part.bundle.spot.y);
    const double count = rays ? static_cast<double>(rays) : std::clamp(enough, 0x1p16, 0x1p22);
    const double arms = 2 * std::sqrt(count);
    const std::vector<EntryPart> parts =
        entry_parts(part.bundle, {static_cast<int>(std::ceil(arms)), static_cast<int>(std::ceil(arms / 4))}, loop);
    std::vector<Vec2<double>> points;
    loop.append_all(points, parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const PointBundle::Entry entries[1] = {parts[i].entry};
            FilmRay found[1];
            part.bundle.trace(entries, found);
            points[i] = found[0].at;
        }
    });
    const auto nearest = [&](double mm) { return std::floor(1e3 * mm / psf.pitch_um + psf.size / 2 + 0.5); };
    double energy = 0;
    std::vector<double> values(psf.values.size());
    const auto add = [&](Vec2<double> at, double share) {
        const double x = nearest(at.x - part.centre.x), y = nearest(at.y - part.centre.y);
        energy += share;
        if (x >= 0 && y >= 0 && x < psf.size && y < psf.size)
            values[static_cast<std::size_t>(y * psf.size + x)] += share;
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double share = parts[i].area * part.bundle.energy(parts[i].entry);
        add(points[i], part.bundle.mirrored ? 0.5 * share : share);
        if (part.bundle.mirrored) add({-points[i].x, points[i].y}, 0.5 * share);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        psf.values[i] += part.weight / (energy * psf.pitch_um * psf.pitch_um) * values[i];
    psf.rays += static_cast<std::int64_t>(parts.size());
}

}  // namespace

BundleSampling checked_sampling(const Part& part, const Psf& psf, std::int64_t rays) {
    const double half = 0.5e-3 * psf.size * psf.pitch_um, phase = largest_phase(part.bundle, part.centre, half);
    const auto count = [](BundleSampling s) { return static_cast<double>(s.arms) * s.nodes; };
    if (!(phase < 1e5) || count(sampling_for(phase)) > (rays ? kMostWaves : kMostWavesUnasked))
        throw InputError("psf: the light's phase differs by " + std::to_string(std::lround(phase / std::numbers::pi)) +
                         " waves on the array, too many for a sum of rays; give a smaller array, another "
                         "film_distance_mm, the number of rays (at most 16777216) or the method \"geometric\"");
    BundleSampling sampling = sampling_for(phase);
    if (rays == 0) return sampling;
    const double least = phase * (0.25 * phase + 1);
    if (static_cast<double>(rays) < least)
        throw InputError("psf: " + std::to_string(rays) +
                         " rays cannot follow the wavefront over the array: at least " +
                         std::to_string(static_cast<std::int64_t>(least) + 1) + " are required, " +
                         std::to_string(static_cast<std::int64_t>(count(sampling))) + " are recommended");
    const double more = std::sqrt(static_cast<double>(rays) / count(sampling));
    return {static_cast<int>(std::ceil(more * sampling.arms)), static_cast<int>(std::ceil(more * sampling.nodes))};
}

void add_waves(const std::vector<Part>& parts, FilmGrid grid, std::vector<double>& values, const RayLoop& loop) {
    values.assign(static_cast<std::size_t>(grid.size) * static_cast<std::size_t>(grid.size), 0);
    for (const Part& part : parts) {
        FilmGrid own = grid;
        own.centre = {grid.centre.x + part.centre.x, grid.centre.y + part.centre.y};
        PlaneWaveSum sum(own, part.bundle.wave_number);
        if (part.light.mirrored && own.centre.x != 0)
            sum.add(with_mirror_images(part.light), loop);
        else
            sum.add(part.light, loop);
        const double scale = scale_of(part);
        for (int y = 0; y < grid.size; ++y)
            for (int x = 0; x < grid.size; ++x)
                values[static_cast<std::size_t>(y * grid.size + x)] += scale * std::norm(sum(x, y));
    }
}

Start start(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop) {
    if (request.colours.empty()) throw InputError("psf: no wavelength is given");
    if (!(request.size >= 2 && request.size <= 4096)) throw InputError("psf: size must lie between 2 and 4096");
    if (!(request.pitch_um >= 0 && request.pitch_um < 1e6)) throw InputError("psf: pitch_um must be a positive length");
    if (!(request.rays >= 0 && static_cast<double>(request.rays) <= kMostWaves))
        throw InputError("psf: rays must be a positive number, at most 16777216");
    double sum = 0;
    for (const PsfColour& colour : request.colours) {
        if (!(colour.weight > 0 && colour.weight < kInfinity))
            throw InputError("psf: weights must be positive numbers");
        sum += colour.weight;
    }
    Start made;
    Psf& psf = made.psf;
    psf = {request.size, request.pitch_um, {0, 0}, request.colours, {}, std::numeric_limits<double>::quiet_NaN(), 0};
    for (PsfColour& colour : psf.colours) {
        colour.weight /= sum;
        made.parts.push_back(
            {PointBundle(lens, colour.wavelength_nm, request.field, request.film_distance, loop), colour.weight});
    }
    if (request.centre == PsfCentre::chief) psf.centre_mm = made.parts[0].bundle.chief;
    for (const Part& part : made.parts) {
        const PointBundle& bundle = part.bundle;
        if (request.centre == PsfCentre::centroid)
            psf.centre_mm = {psf.centre_mm.x + part.weight * (bundle.chief.x + bundle.centroid.x),
                             psf.centre_mm.y + part.weight * (bundle.chief.y + bundle.centroid.y)};
        if (request.pitch_um == 0) {
            const double pitch = psf_pitch(bundle, psf.size);
            psf.pitch_um = psf.pitch_um == 0 ? pitch : std::min(psf.pitch_um, pitch);
        }
    }
    for (Part& part : made.parts)
        part.centre = {psf.centre_mm.x - part.bundle.chief.x, psf.centre_mm.y - part.bundle.chief.y};
    psf.values.assign(static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size), 0);
    return made;
}

}  // namespace psf_detail

Psf psf_of(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop) {
    using namespace psf_detail;
    auto [parts, psf] = start(lens, request, loop);
    if (request.method == PsfMethod::geometric) {
        for (const Part& part : parts) add_rays(part, psf, request.rays, loop);
        return std::move(psf);
    }
    for (Part& part : parts) {
        part.light = plane_waves(part.bundle, checked_sampling(part, psf, request.rays), loop);
        psf.rays += static_cast<std::int64_t>(part.light.waves.size());
    }
    add_waves(parts, {psf.size, 1e-3 * psf.pitch_um, {0, 0}}, psf.values, loop);
    psf.strehl = peak_near(parts, psf, loop) / ideal_peak(parts);
    return std::move(psf);
}

double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um) {
    constexpr int kParts = 16;
    const double reach = radius_um / psf.pitch_um;
    double sum = 0;
    for (int row = 0; row < psf.size; ++row)
        for (int column = 0; column < psf.size; ++column) {
            const double x = column - psf.size / 2 - about_um.x / psf.pitch_um;
            const double y = row - psf.size / 2 - about_um.y / psf.pitch_um, distance = hypotenuse(x, y);
            if (distance > reach + 0.8) continue;
            int inside = kParts * kParts;
            for (int i = 0; distance > reach - 0.8 && i < kParts * kParts; ++i)
                inside -=
                    hypotenuse(x + (i % kParts + 0.5) / kParts - 0.5, y + (i / kParts + 0.5) / kParts - 0.5) > reach;
            sum += psf.values[static_cast<std::size_t>(row * psf.size + column)] * inside / (kParts * kParts);
        }
    return sum * psf.pitch_um * psf.pitch_um;
}

double modulation(const Psf& psf, double frequency_per_mm, bool tangential) {
    if (frequency_per_mm == 0) return 1;
    std::complex<double> sum = 0;
    for (int i = 0; i < psf.size; ++i) {
        double line = 0;
        for (int k = 0; k < psf.size; ++k)
            line += psf.values[static_cast<std::size_t>(tangential ? i * psf.size + k : k * psf.size + i)];
        sum += std::polar(line, -2e-3 * std::numbers::pi * frequency_per_mm * (i - psf.size / 2) * psf.pitch_um);
    }
    return std::abs(sum) * psf.pitch_um * psf.pitch_um;
}

}  // namespace realcam
