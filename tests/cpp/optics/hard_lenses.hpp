#pragma once
// Lenses that are hard to trace. What they do has a closed form where their makers say so.

#include <cmath>
#include <string>
#include <vector>

#include "optics/lens/paraxial.hpp"
#include "traced_ray.hpp"

namespace realcam::test {

/// The length that errors are compared with, mm.
inline double scale_of(const LensSystem& lens) {
    const double f = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
    return std::max(std::isfinite(f) ? f : 0.0, std::fabs(lens.film_position()));
}

/// All lengths times a factor.
inline LensSystem scaled(LensSystem lens, double factor) {
    for (Surface& s : lens.surfaces) {
        s.curvature /= factor;
        s.thickness *= factor;
        s.clear_semi_diameter *= factor;
        s.inner_semi_diameter *= factor;
        double power = factor * factor * factor;
        for (double& a : s.aspheric) {
            a /= power;
            power *= factor * factor;
        }
    }
    lens.film_distance *= factor;
    lens.film_width *= factor;
    lens.film_height *= factor;
    lens.stop_semi_diameter *= factor;
    lens.focus_distance *= factor;
    lens.focusing.nearest_mm *= factor;
    return lens;
}

inline LensSystem with_film(LensSystem lens, double film_distance, double width) {
    lens.film_distance = film_distance;
    lens.film_width = lens.film_height = width;
    return lens;
}

inline LensSystem in_front(std::vector<Surface> surfaces, LensSystem lens) {
    lens.surfaces.insert(lens.surfaces.begin(), surfaces.begin(), surfaces.end());
    lens.focusing = {};
    lens.allow_overlap = true;  // elements without thickness
    return lens;
}

inline Surface mirror(double radius_of_curvature, double conic, double thickness, double semi_diameter) {
    Surface s = refracting(radius_of_curvature, thickness, Glass::air(), semi_diameter);
    s.type = SurfaceType::mirror;
    s.conic = conic;
    return s;
}

/// The bundled fisheye of 220 degrees behind one more meniscus whose rim is nearly a hemisphere's. Its light comes from
/// up to 148 degrees to the axis, from behind the whole lens.
inline LensSystem fisheye_270() {
    const Surface front = refracting(105, 10, Glass::constant(1.75), 104);
    return focused(in_front({front, refracting(44, 24, Glass::air(), 43.9)}, io::read_lens("fisheye-6mm-220deg")),
                   kInfinity);
}

/// Paraboloid and hyperboloid of 1000 mm, f/10: parallel light meets in one point, exactly, 40 mm behind the hole.
struct Cassegrain {
    static constexpr double kFocalLength = 1000, kBack = 220, kSeparation = 180, kRim = 50, kHole = 16;

    static LensSystem lens() {
        // The primary's focus lies p behind the secondary, which images it to kBack with magnification m = kBack / p;
        // f = m f1 and f1 = separation + p.
        constexpr double p = kSeparation * kBack / (kFocalLength - kBack), m = kBack / p;
        Surface primary = mirror(-2 * (kSeparation + p), -1, -kSeparation, kRim);
        primary.inner_semi_diameter = kHole;
        Surface shadow = stop_plane(kSeparation, kRim);
        shadow.type = SurfaceType::aperture;
        shadow.inner_semi_diameter = kHole;
        const double conic = -std::pow((m + 1) / (m - 1), 2);
        return with_film(
            lens_of({stop_plane(20, kRim), shadow, primary, mirror(-2 * p * m / (m - 1), conic, 0, kHole)}), kBack, 10);
    }
    /// Sine of the image-side angle of a ray that enters at this height: tan(angle / 2) = height / (2 f), because
    /// confocal conics preserve the ratio of these tangents.
    static double sine_behind(double height) { return std::sin(2 * std::atan(height / (2 * kFocalLength))); }
};

/// f/0.7: a plane and a hyperboloid of conic -n^2, which images parallel light in one point, and a meniscus that is
/// aplanatic in front and concentric behind: it makes the sine n times as large, and keeps the point.
struct FastLens {
    static constexpr double kIndex = 1.75, kFocalLength = 50, kStop = kFocalLength / 1.4;
    static constexpr double kLeft = 62;  ///< meniscus to the singlet's focus
    static constexpr double kRadius = kLeft / (kIndex + 1), kThickness = 8;
    static constexpr double kBack = kLeft / kIndex - kThickness;

    static LensSystem lens() {
        const Glass glass = Glass::constant(kIndex);
        Surface hyperboloid = refracting(-kIndex * kFocalLength * (kIndex - 1), kIndex * kFocalLength - kLeft,
                                         Glass::air(), 1.01 * kStop);
        hyperboloid.conic = -kIndex * kIndex;
        return with_film(lens_of({stop_plane(0, kStop), refracting(0, 24, glass, 1.01 * kStop), hyperboloid,
                                  refracting(kRadius, kThickness, glass, 0.99 * kRadius),
                                  refracting(kBack, 0, Glass::air(), 0.9 * kBack)}),
                         kBack, 1);
    }
    /// Behind the hyperboloid in polar form r (n cos - 1) = (n - 1) f, bisected, times n.
    static double sine_behind(double height) {
        const double f = kIndex * kFocalLength;
        double low = 0, high = std::acos(1 / kIndex);
        for (int i = 0; i < 60; ++i) {
            const double angle = 0.5 * (low + high);
            ((kIndex - 1) * f * std::sin(angle) > height * (kIndex * std::cos(angle) - 1) ? high : low) = angle;
        }
        return kIndex * std::sin(low);
    }
};

/// Two elements (a curved face and a plane, without thickness; index 2) of focal lengths 2^7 and -2^6: parallel light
/// leaves them parallel and half as wide, paraxially to the last bit.
inline std::vector<Surface> galilean(double rim, double gap_behind) {
    return {refracting(128, 0, Glass::constant(2), rim), refracting(0, 64, Glass::air(), rim),
            refracting(-64, 0, Glass::constant(2), 0.6 * rim), refracting(0, gap_behind, Glass::air(), 0.6 * rim)};
}
/// The galilean elements reversed: parallel light leaves them parallel and twice as wide.
inline std::vector<Surface> reversed_galilean(double rim, double gap_behind) {
    return {refracting(0, 0, Glass::constant(2), 0.6 * rim), refracting(64, 64, Glass::air(), 0.6 * rim),
            refracting(0, 0, Glass::constant(2), rim), refracting(-128, gap_behind, Glass::air(), rim)};
}

/// `count` plates of glass, as far from each other as they are thick.
inline std::vector<Surface> plates(int count, double thickness, double rim) {
    std::vector<Surface> list;
    for (int i = 0; i < count; ++i) {
        list.push_back(refracting(0, thickness, Glass::constant(i % 2 ? 1.8 : 1.5), rim));
        list.push_back(refracting(0, thickness, Glass::air(), rim));
    }
    return list;
}

/// A chain of equal biconvex lenses, each at twice its focal length from the next.
inline LensSystem relays(int count, double stop) {
    std::vector<Surface> list{stop_plane(100, stop)};
    for (int i = 0; i < count; ++i) {
        list.push_back(refracting(50, 2, Glass::constant(1.5), 6));
        list.push_back(refracting(-50, 98, Glass::air(), 6));
    }
    list.back().thickness = 0;
    return with_film(lens_of(list), 49, 1.4);
}

/// A biconvex lens of about 100 mm whose stop stands before, in, or behind its glass.
inline LensSystem singlet_with_stop(double before, double behind, bool inside = false) {
    const Glass glass = Glass::constant(1.5);
    std::vector<Surface> list;
    if (before > 0) list.push_back(stop_plane(before, 8));
    list.push_back(refracting(100, inside ? 3 : 6, glass, 14));
    if (inside) list.push_back(stop_plane(3, 8));
    list.push_back(refracting(-100, behind, Glass::air(), 14));
    if (behind > 0) list.push_back(stop_plane(0, 8));
    return with_film(focused(lens_of(list), kInfinity), 97 - behind, 20);
}

}  // namespace realcam::test
