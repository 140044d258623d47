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

/// Limits of the number of waves. Up to the first, a PSF takes some seconds; more are computed only if the caller
/// specifies the number of rays.
constexpr double kMaxDefaultWaves = 1 << 20, kMaxWaves = 1 << 24;

/// Returns the default pitch, um: a quarter of wavelength times f-number, which is half the Nyquist pitch of the image.
/// If the spot is larger than the window, it is up to the Nyquist pitch.
double psf_pitch(const PointBundle& bundle, int size) {
    const double slope_range =
        std::max(bundle.slope_high.x - bundle.slope_low.x, bundle.slope_high.y - bundle.slope_low.y);
    // Wavelength times f-number.
    const double resolution_um = 2e3 * std::numbers::pi / (bundle.wave_number * slope_range);
    const double spot = 2e3 * std::max(bundle.spot.x, bundle.spot.y) + 8 * resolution_um;
    return std::clamp(spot / size, 0.25 * resolution_um, 0.5 * resolution_um);
}

/// Returns the irradiance, per um^2, of a colour for a squared magnitude of 1 of its sum of waves.
double scale_of(const ColourPart& part) {
    const double per_mm2 = part.bundle.wave_number / (2 * std::numbers::pi);
    return 1e-6 * part.weight * per_mm2 * per_mm2 / part.light.energy;
}

/// Returns the largest value of the PSF without aberrations: all waves in phase, and all colours at one point.
double ideal_peak(const std::vector<ColourPart>& parts) {
    double ideal = 0;
    for (const ColourPart& part : parts) {
        double amplitude = 0;
        for (const PlaneWave& wave : part.light.waves) amplitude += wave.amplitude;
        ideal += scale_of(part) * amplitude * amplitude;
    }
    return ideal;
}

/// Returns the largest value near the maximum of the array, by a search between its points on finer and finer grids.
double peak_near(const std::vector<ColourPart>& parts, const Psf& psf, const RayLoop& loop) {
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
void add_rays(const ColourPart& part, Psf& psf, std::int64_t rays, const RayLoop& loop) {
    const auto points_across = [&](double spot) { return 1 + 2e3 * spot / psf.pitch_um; };
    const double rays_needed = 16 * points_across(part.bundle.spot.x) * points_across(part.bundle.spot.y);
    const double count = rays ? static_cast<double>(rays) : std::clamp(rays_needed, 0x1p16, 0x1p22);
    const double arms = 2 * std::sqrt(count);
    const std::vector<QuadratureRay> parts =
        quadrature_rays(part.bundle, {static_cast<int>(std::ceil(arms)), static_cast<int>(std::ceil(arms / 4))}, loop);
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
    const auto add = [&](Vec2<double> at, double fraction) {
        const double x = nearest(at.x - part.centre.x), y = nearest(at.y - part.centre.y);
        energy += fraction;
        if (x >= 0 && y >= 0 && x < psf.size && y < psf.size)
            values[static_cast<std::size_t>(y * psf.size + x)] += fraction;
    };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double fraction = parts[i].area * part.bundle.energy(parts[i].entry);
        add(points[i], part.bundle.mirrored ? 0.5 * fraction : fraction);
        if (part.bundle.mirrored) add({-points[i].x, points[i].y}, 0.5 * fraction);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        psf.values[i] += part.weight / (energy * psf.pitch_um * psf.pitch_um) * values[i];
    psf.rays += static_cast<std::int64_t>(parts.size());
}

}  // namespace

BundleSampling checked_sampling(const ColourPart& part, const Psf& psf, std::int64_t rays) {
    const double half = 0.5e-3 * psf.size * psf.pitch_um, phase = largest_phase(part.bundle, part.centre, half);
    const auto count = [](BundleSampling s) { return static_cast<double>(s.arms) * s.nodes; };
    if (!(phase < 1e5) || count(sampling_for(phase)) > (rays ? kMaxWaves : kMaxDefaultWaves))
        throw InputError("psf: the light's phase differs by " + std::to_string(std::lround(phase / std::numbers::pi)) +
                         " waves on the array, too many for a sum of rays; use a smaller array, another "
                         "film_distance_mm, the number of rays (at most 16777216) or the method \"geometric\"");
    BundleSampling sampling = sampling_for(phase);
    if (rays == 0) return sampling;
    const double min_rays = phase * (0.25 * phase + 1);
    if (static_cast<double>(rays) < min_rays)
        throw InputError("psf: " + std::to_string(rays) +
                         " rays cannot follow the wavefront over the array: at least " +
                         std::to_string(static_cast<std::int64_t>(min_rays) + 1) + " are required, " +
                         std::to_string(static_cast<std::int64_t>(count(sampling))) + " are recommended");
    const double factor = std::sqrt(static_cast<double>(rays) / count(sampling));
    return {static_cast<int>(std::ceil(factor * sampling.arms)), static_cast<int>(std::ceil(factor * sampling.nodes))};
}

void add_waves(const std::vector<ColourPart>& parts, FilmGrid grid, std::vector<double>& values, const RayLoop& loop) {
    values.assign(static_cast<std::size_t>(grid.size) * static_cast<std::size_t>(grid.size), 0);
    for (const ColourPart& part : parts) {
        FilmGrid shifted = grid;
        shifted.centre = {grid.centre.x + part.centre.x, grid.centre.y + part.centre.y};
        PlaneWaveSum sum(shifted, part.bundle.wave_number);
        if (part.light.mirrored && shifted.centre.x != 0)
            sum.add(with_mirror_images(part.light), loop);
        else
            sum.add(part.light, loop);
        const double scale = scale_of(part);
        for (int y = 0; y < grid.size; ++y)
            for (int x = 0; x < grid.size; ++x)
                values[static_cast<std::size_t>(y * grid.size + x)] += scale * std::norm(sum(x, y));
    }
}

PreparedPsf prepare(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop) {
    if (request.colours.empty()) throw InputError("psf: expected at least one wavelength");
    if (!(request.size >= 2 && request.size <= 4096)) throw InputError("psf: size must lie between 2 and 4096");
    if (!(request.pitch_um >= 0 && request.pitch_um < 1e6)) throw InputError("psf: pitch_um must be a positive length");
    if (!(request.rays >= 0 && static_cast<double>(request.rays) <= kMaxWaves))
        throw InputError("psf: rays must be a positive number, at most 16777216");
    double sum = 0;
    for (const PsfColour& colour : request.colours) {
        if (!(colour.weight > 0 && colour.weight < kInfinity))
            throw InputError("psf: weights must be positive numbers");
        sum += colour.weight;
    }
    PreparedPsf prepared;
    Psf& psf = prepared.psf;
    psf = {request.size, request.pitch_um, {0, 0}, request.colours, {}, std::numeric_limits<double>::quiet_NaN(), 0};
    for (PsfColour& colour : psf.colours) {
        colour.weight /= sum;
        prepared.parts.push_back(
            {PointBundle(lens, colour.wavelength_nm, request.field, request.film_distance, loop), colour.weight});
    }
    if (request.centre == PsfCentre::chief) psf.centre_mm = prepared.parts[0].bundle.chief;
    for (const ColourPart& part : prepared.parts) {
        const PointBundle& bundle = part.bundle;
        if (request.centre == PsfCentre::centroid)
            psf.centre_mm = {psf.centre_mm.x + part.weight * (bundle.chief.x + bundle.centroid.x),
                             psf.centre_mm.y + part.weight * (bundle.chief.y + bundle.centroid.y)};
        if (request.pitch_um == 0) {
            const double pitch = psf_pitch(bundle, psf.size);
            psf.pitch_um = psf.pitch_um == 0 ? pitch : std::min(psf.pitch_um, pitch);
        }
    }
    for (ColourPart& part : prepared.parts)
        part.centre = {psf.centre_mm.x - part.bundle.chief.x, psf.centre_mm.y - part.bundle.chief.y};
    psf.values.assign(static_cast<std::size_t>(psf.size) * static_cast<std::size_t>(psf.size), 0);
    return prepared;
}

}  // namespace psf_detail

Psf psf_of(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop) {
    using namespace psf_detail;
    auto [parts, psf] = prepare(lens, request, loop);
    if (request.method == PsfMethod::geometric) {
        for (const ColourPart& part : parts) add_rays(part, psf, request.rays, loop);
        return std::move(psf);
    }
    for (ColourPart& part : parts) {
        part.light = plane_waves(part.bundle, checked_sampling(part, psf, request.rays), loop);
        psf.rays += static_cast<std::int64_t>(part.light.waves.size());
    }
    add_waves(parts, {psf.size, 1e-3 * psf.pitch_um, {0, 0}}, psf.values, loop);
    psf.strehl = peak_near(parts, psf, loop) / ideal_peak(parts);
    return std::move(psf);
}

double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um) {
    constexpr int kSubpixels = 16;  // along a side of a pixel that the circle may cut
    const double radius = radius_um / psf.pitch_um;
    double sum = 0;
    for (int row = 0; row < psf.size; ++row)
        for (int column = 0; column < psf.size; ++column) {
            const double x = column - psf.size / 2 - about_um.x / psf.pitch_um;
            const double y = row - psf.size / 2 - about_um.y / psf.pitch_um, distance = hypotenuse(x, y);
            if (distance > radius + 0.8) continue;
            int inside = kSubpixels * kSubpixels;
            for (int i = 0; distance > radius - 0.8 && i < kSubpixels * kSubpixels; ++i)
                inside -= hypotenuse(x + (i % kSubpixels + 0.5) / kSubpixels - 0.5,
                                     y + (i / kSubpixels + 0.5) / kSubpixels - 0.5) > radius;
            sum += psf.values[static_cast<std::size_t>(row * psf.size + column)] * inside / (kSubpixels * kSubpixels);
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
