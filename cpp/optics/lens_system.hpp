#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../error.hpp"
#include "iris_shape.hpp"
#include "surface.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr int kMaxSurfaces = 256;

// Numbers beyond these are no lens's, and their squares, or those of their sums, leave the range of float32.
inline constexpr double kLongest = 1e9;         ///< any length, mm
inline constexpr double kShortestRadius = 1e-6;  ///< of curvature, and clear semi-diameter, mm
inline constexpr double kLargestConic = 1e6;
/// Of an asphere, whatever its unit. Float32 rays need no such limit, but some pictures through lenses past it are NaN.
inline constexpr double kLargestCoefficient = 1e37;

/// How the focusing ring moves the glass.
struct FocusingRule {
    double nearest_mm = 0;  ///< nearest object plane, measured to the film; 0: as near as the optics can
    int group_first = -1;  ///< first and last surface (from 0) of the moving group; -1: the whole lens moves
    int group_last = -1;

    bool moves_group() const { return group_first >= 0; }
    bool operator==(const FocusingRule&) const = default;
};

/// A lens in one state of its rings: a value. Owns its data; LensPath makes the views that kernels use.
/// Lens frame: z along the axis, origin at the front vertex, light from the scene travels to +z. Lengths in mm.
struct LensSystem {
    std::string name;
    std::string title;
    std::string source;
    std::vector<Surface> surfaces;
    double wavelength_nm = kLineD_nm;  ///< design wavelength, used where none is given
    double film_width = 36, film_height = 24;
    double film_distance = 0;  ///< last vertex to film
    double focus_distance = kInfinity;  ///< object plane to film
    double stop_semi_diameter = 0;  ///< radius of the circle that has the diaphragm's open area
    IrisShape iris;
    FocusingRule focusing;

    bool operator==(const LensSystem&) const = default;

    int stop_index() const {
        for (std::size_t i = 0; i < surfaces.size(); ++i)
            if (surfaces[i].type == SurfaceType::stop) return static_cast<int>(i);
        return -1;
    }
    const Surface& stop() const { return surfaces[static_cast<std::size_t>(stop_index())]; }
    bool is_wide_open() const { return stop_semi_diameter >= stop().clear_semi_diameter; }

    /// z of each vertex.
    std::vector<double> vertices() const {
        std::vector<double> z(surfaces.size(), 0.0);
        for (std::size_t i = 1; i < surfaces.size(); ++i) z[i] = z[i - 1] + surfaces[i - 1].thickness;
        return z;
    }
    double last_vertex() const {
        double z = 0;
        for (std::size_t i = 0; i + 1 < surfaces.size(); ++i) z += surfaces[i].thickness;
        return z;
    }
    double film_position() const { return last_vertex() + film_distance; }

    /// Refractive index of the n + 1 media: before the first surface, between the surfaces, behind the last.
    /// Throws InputError at a wavelength where a glass has none: a formula near its resonances gives anything.
    std::vector<double> indices(double wavelength) const {
        std::vector<double> n(surfaces.size() + 1, 1.0);
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const Surface& s = surfaces[i];
            n[i + 1] = s.type == SurfaceType::refracting ? s.material.index(wavelength) : n[i];
            if (!(n[i + 1] > 0.1) || !(n[i + 1] < 100))
                throw InputError("the material of surface " + std::to_string(i + 1) +
                                 (s.material.label.empty() ? "" : " (" + s.material.label + ")") +
                                 " has no refractive index at " + std::to_string(std::lround(wavelength)) + " nm");
        }
        return n;
    }
};

/// Throws LensFileError, with the surface's number, where the prescription cannot be built.
inline void validate(const LensSystem& lens) {
    const auto fail = [](std::size_t index, const std::string& message) {
        throw LensFileError(message, {}, 0, static_cast<int>(index) + 1);
    };
    const auto mm = [](double v) {
        std::string text = std::to_string(v);
        return text.substr(0, text.find_last_not_of('0') + 1) + " mm";
    };
    if (lens.surfaces.empty()) throw LensFileError("the lens has no surfaces; at least one and a stop are wanted");
    if (lens.surfaces.size() > kMaxSurfaces)
        throw LensFileError("the lens has " + std::to_string(lens.surfaces.size()) + " surfaces; at most " +
                            std::to_string(kMaxSurfaces) + " are supported");
    int stops = 0;
    double direction = 1;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& s = lens.surfaces[i];
        if (!std::isfinite(s.curvature) || !std::isfinite(s.conic))
            fail(i, "radius of curvature and conic must be finite numbers (leave the radius out for a plane)");
        if (std::fabs(s.conic) > kLargestConic) fail(i, "the conic must lie between -1e6 and 1e6");
        if (std::fabs(s.curvature) > 1 / kShortestRadius)
            fail(i, "the curvature is larger than that of a radius of 1e-6 mm");
        for (double a : s.aspheric)
            if (!std::isfinite(a)) fail(i, "an aspheric coefficient is not a finite number");
        if (s.aspheric.size() > static_cast<std::size_t>(kMaxAsphericTerms))
            fail(i, "aspheric coefficients go up to r^" + std::to_string(2 * kMaxAsphericTerms + 2));
        if (!(s.clear_semi_diameter > 0) || !std::isfinite(s.clear_semi_diameter))
            fail(i, "the clear semi-diameter is " + mm(s.clear_semi_diameter) + "; a positive length is wanted");
        if (s.clear_semi_diameter < kShortestRadius || s.clear_semi_diameter > kLongest)
            fail(i, "the clear semi-diameter must lie between 1e-6 and 1e9 mm");
        double power = s.clear_semi_diameter * s.clear_semi_diameter;
        for (double a : s.aspheric) {
            power *= s.clear_semi_diameter * s.clear_semi_diameter;
            if (std::fabs(a) > kLargestCoefficient || std::fabs(a) * power > kLongest)
                fail(i, "an aspheric coefficient is too large: it is past 1e37, or its term past 1e9 mm at the rim");
        }
        if (!(s.inner_semi_diameter >= 0) || s.inner_semi_diameter >= s.clear_semi_diameter)
            fail(i, "the inner semi-diameter must be at least 0 and less than the clear semi-diameter");
        if (!std::isfinite(s.thickness)) fail(i, "the thickness is not a finite number");
        if (std::fabs(s.thickness) > kLongest) fail(i, "the thickness is more than 1e9 mm");
        if (s.type == SurfaceType::mirror) direction = -direction;
        if (s.thickness * direction < 0)
            fail(i, direction > 0
                        ? "the thickness is negative; light travels to the film here, so 0 or more is wanted"
                        : "the thickness is positive; light travels back behind a mirror, so 0 or less is wanted");
        const double edge = s.sag(s.clear_semi_diameter);
        if (!std::isfinite(edge)) {
            const double limit = 1 / (std::fabs(s.curvature) * std::sqrt(1 + s.conic));
            fail(i, "the clear semi-diameter of " + mm(s.clear_semi_diameter) +
                        " is larger than the surface, which ends at " + mm(limit) + " from the axis");
        }
        for (double wavelength : {380.0, lens.wavelength_nm, 780.0}) {
            const double n = s.material.index(wavelength);
            if (!(n >= 1) || !(n < 10))
                fail(i, "the refractive index of its material at " + std::to_string(static_cast<int>(wavelength)) +
                            " nm is " + std::to_string(n) + "; 1 to 10 is wanted");
        }
        stops += s.type == SurfaceType::stop;
    }
    if (stops != 1)
        throw LensFileError("the lens has " + std::to_string(stops) +
                            " surfaces of type \"stop\"; exactly one is wanted");
    if (direction < 0)
        throw LensFileError("the lens has an odd number of mirrors, so its light never reaches a film behind it");
    if (lens.iris.blades != 0 && (lens.iris.blades < 3 || lens.iris.blades > kMaxIrisBlades))
        throw LensFileError("the iris has " + std::to_string(lens.iris.blades) + " blades; 0 (round) or 3 to " +
                            std::to_string(kMaxIrisBlades) + " are wanted");
    if (!(lens.iris.rounding >= 0 && lens.iris.rounding <= 1))
        throw LensFileError("the rounding of the iris must lie between 0 (straight blades) and 1 (a circle)");
    if (!std::isfinite(lens.iris.rotation_rad)) throw LensFileError("the rotation of the iris is not a finite number");
    if (!(lens.film_width > 0) || !(lens.film_height > 0) || !(lens.film_width + lens.film_height <= kLongest))
        throw LensFileError("the film's width and height must be positive lengths, of at most 1e9 mm");
    const int n = static_cast<int>(lens.surfaces.size());
    if (lens.focusing.moves_group() &&
        (lens.focusing.group_last < lens.focusing.group_first || lens.focusing.group_last >= n))
        throw LensFileError("the focusing group must be [first, last] with 1 <= first <= last <= " + std::to_string(n));
}

}  // namespace REALCAM_NAMESPACE
