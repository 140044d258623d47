#include "exposure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../coating/coated_surface.hpp"
#include "../trace/film_frame.hpp"
#include "../trace/lens_path.hpp"

namespace realcam {

namespace {

/// Returns for each optical sine (index times sine of the angle to the axis): true if the meridional ray from the
/// film's centre at this angle passes the lens.
std::vector<bool> passing(const LensPath<double>& path, double film_distance, const std::vector<double>& sines) {
    constexpr std::size_t kBlock = 64;
    const double n = path.entry_index;
    std::vector<bool> passes;
    for (std::size_t first = 0; first < sines.size(); first += kBlock) {
        LensRays<double, kBlock> rays;
        for (std::size_t i = 0; i < kBlock; ++i) {
            const double sine = sines[std::min(first + i, sines.size() - 1)];
            const int lane = static_cast<int>(i);
            rays.origin.set(lane, {0, 0, film_distance});
            rays.direction.set(lane, {sine, 0, -std::sqrt(n * n - sine * sine)});
            rays.status[lane] = 0;
        }
        trace_lens(path.view(), rays);
        for (std::size_t i = 0; i < kBlock && first + i < sines.size(); ++i) passes.push_back(rays.status[i] == 0);
    }
    return passes;
}

}  // namespace

double axis_irradiance(LensSystem lens) {
    if (!has_axis(lens) || !lens.film_placement.is_in_place())
        lens.require_rotational("the irradiance at the centre of the film");
    lens.iris.blades = 0;
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm,
                                film_path_ends(lens, LightDirection::to_scene));
    const Surface& last = lens.surfaces.back();
    const double n = path.entry_index, rim = last.clear_semi_diameter;
    // Optical sine of the steepest ray that can hit the last surface, whose rim may bulge towards the film. The film of
    // a single mirror lies in front of it.
    const double sag = lens.film_distance < 0 ? -last.sag(rim) : last.sag(rim);
    const double rim_distance = std::fabs(lens.film_distance) - std::max(sag, 0.0);
    const double max_sine = rim_distance > 0 ? n * std::sin(std::atan(1.02 * rim / rim_distance)) : n;
    // Linear steps find obstructions; geometric steps find the smallest stop.
    constexpr int kLinear = 1024, kGeometric = 512;
    const double ratio = std::exp2(-0.125);
    std::vector<double> sines;
    for (int i = 0; i < kLinear; ++i) sines.push_back(max_sine * (i + 0.5) / kLinear);
    double sine = sines.front();
    for (int i = 0; i < kGeometric; ++i) sines.push_back(sine *= ratio);
    std::sort(sines.begin(), sines.end());
    const std::vector<bool> passes = passing(path, lens.film_distance, sines);

    // Edges of the light, bisected to the last digit: sines on both sides of each edge, at which rays pass and are
    // blocked, and 1 if the light lies below the edge, -1 if above.
    constexpr int kHalvings = 52;
    std::vector<double> open, shut, sign;
    for (std::size_t i = 1; i < sines.size(); ++i) {
        if (passes[i] == passes[i - 1]) continue;
        open.push_back(passes[i] ? sines[i] : sines[i - 1]);
        shut.push_back(passes[i] ? sines[i - 1] : sines[i]);
        sign.push_back(passes[i] ? -1 : 1);
    }
    for (int k = 0; k < kHalvings && !open.empty(); ++k) {
        std::vector<double> middle;
        for (std::size_t e = 0; e < open.size(); ++e) middle.push_back(0.5 * (open[e] + shut[e]));
        const std::vector<bool> middle_passes = passing(path, lens.film_distance, middle);
        for (std::size_t e = 0; e < open.size(); ++e) (middle_passes[e] ? open : shut)[e] = middle[e];
    }
    double squares = passes.back() ? max_sine * max_sine : 0.0;
    for (std::size_t e = 0; e < open.size(); ++e) squares += sign[e] * open[e] * open[e];
    return std::numbers::pi * squares;
}

AxialTransmittance::AxialTransmittance(const LensSystem& lens, double wavelength_nm) {
    const std::vector<double> indices = lens.indices(wavelength_nm);
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        std::array<Face, 2> faces;
        if (lens.surfaces[i].bends_light())
            for (const bool in_order : {false, true}) {
                const CoatedSurface surface = coated_surface(
                    lens, i, wavelength_nm, in_order ? LightDirection::to_film : LightDirection::to_scene, indices);
                const PolarisedResponse response = surface.at(1);
                faces[in_order] = {response.mean_reflectance(),
                                   surface.is_mirror() ? response.mean_reflectance() : response.mean_transmittance()};
            }
        surfaces_.push_back(faces);
    }
}

double AxialTransmittance::operator()(const std::vector<Crossing>& crossings) const {
    double transmittance = 1;
    for (const Crossing& crossing : crossings) {
        const Face& face = surfaces_[static_cast<std::size_t>(crossing.surface)][crossing.in_order];
        transmittance *= crossing.is_reflected ? face.reflectance : face.direct;
    }
    return transmittance;
}

}  // namespace realcam
