#pragma once
// A lens drawn from fuzz bytes: 1 to 100 surfaces; the input decides how many of them are hard cases.

#include <algorithm>

#include "bytes.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "optics/prescription/lens_limits.hpp"

namespace realcam::fuzz {

struct LensStyle {
    double size = 10;  ///< scale of the lens's semi-diameters, mm
    int hard = 0;      ///< out of 256 choices, the number that are hard cases rather than values of usual lenses
};

/// Largest curvature of a conic that reaches the rim: the surface is parallel to the axis there.
inline double hemisphere_curvature(double rim, double conic) {
    return conic > -1 ? 1 / (rim * std::sqrt(1 + conic)) : 1e3 / rim;
}

inline double draw_conic(Bytes& in, const LensStyle& style) {
    if (!in.chance(64 + style.hard / 2)) return 0;
    if (!in.chance(style.hard)) return in.between(-2, 1);
    switch (in.below(5)) {
        case 0: return -1;
        case 1: return in.nudged(-1);
        case 2: return in.sign() * in.decades(-17, 3);
        case 3: return -in.decades(0, 3);
        default: return in.chance(128) ? 1e3 : -1e3;
    }
}

inline double draw_curvature(Bytes& in, const LensStyle& style, double rim, double conic) {
    const double steepest = hemisphere_curvature(rim, conic);
    if (!in.chance(style.hard)) return in.sign() * std::min(steepest, in.between(0, 0.7) / rim);
    switch (in.below(6)) {
        case 0: return 0;
        case 1: return in.sign() * 1e-12;
        case 2: return in.sign() * in.decades(-16, 0) * steepest;
        case 3: return in.sign() * steepest;
        case 4: return in.sign() * steepest * (1 - in.decades(-16, -3));
        default: return in.sign() * std::min(1 / rim, steepest);  // a hemisphere, if it can be one
    }
}

/// Even powers whose terms at the rim are shares of the semi-diameter: more than 0.1 turns the sag back.
inline std::vector<double> draw_polynomial(Bytes& in, const LensStyle& style, double rim) {
    std::vector<double> terms(static_cast<std::size_t>(1 + in.below(kMaxAsphericTerms)), 0.0);
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const double share = in.chance(style.hard) ? in.decades(-12, 1.5) : in.between(0, 0.01);
        if (!in.chance(32)) terms[i] = in.sign() * share * rim * std::pow(rim, -2.0 * static_cast<double>(i + 2));
    }
    return terms;
}

inline double draw_thickness(Bytes& in, const LensStyle& style) {
    if (!in.chance(style.hard)) return in.between(0.05, 1) * style.size;
    switch (in.below(5)) {
        case 0: return 0;
        case 1: return 1e-9;
        case 2: return in.decades(-12, 4) * style.size;
        default: return in.between(0, 0.3) * style.size;  // overlaps where the sags are larger
    }
}

inline Glass draw_glass(Bytes& in, const LensStyle& style) {
    if (in.chance(100)) return Glass::air();
    if (!in.chance(style.hard)) return Glass::constant(in.between(1.4, 2));
    switch (in.below(5)) {
        case 0: return Glass::constant(in.nudged(1));  // below 1 it is refused
        case 1: return Glass::constant(1 + in.decades(-16, -3));
        case 2: return Glass::constant(9.99);
        case 3: return Glass::from_abbe_number(in.between(1.3, 2), in.between(15, 100));
        default: return Glass::constant(in.between(1, 9.9));
    }
}

inline double draw_rim(Bytes& in, const LensStyle& style) {
    return in.chance(style.hard) ? style.size * in.decades(-3, 2) : style.size * in.between(0.5, 2);
}

inline Surface draw_surface(Bytes& in, const LensStyle& style) {
    Surface s;
    s.clear_semi_diameter = draw_rim(in, style);
    s.conic = draw_conic(in, style);
    s.curvature = draw_curvature(in, style, s.clear_semi_diameter, s.conic);
    if (in.chance(24 + style.hard / 4)) s.aspheric = draw_polynomial(in, style, s.clear_semi_diameter);
    s.thickness = draw_thickness(in, style);
    s.material = draw_glass(in, style);
    if (in.chance(16))
        s.inner_semi_diameter = in.chance(128) ? in.unit() * s.clear_semi_diameter : in.nudged(s.clear_semi_diameter);
    return s;
}

inline Surface draw_plane(Bytes& in, const LensStyle& style, SurfaceType type) {
    Surface s;
    s.type = type;
    s.clear_semi_diameter = draw_rim(in, style);
    s.thickness = draw_thickness(in, style);
    if (in.chance(32)) s.inner_semi_diameter = in.unit() * s.clear_semi_diameter;
    return s;
}

inline Glass any_glass(Bytes& in) {
    try {
        if (in.chance(128)) return Glass::cauchy({in.any(), in.any(), in.any()});
        return Glass::from_abbe_number(in.between(1, 2), in.any());
    } catch (const InputError&) {
        return Glass::air();  // refused, as numbers that no glass has are
    }
}

/// One number of the lens becomes any number at all, or one of its rules is broken.
inline void spoil(Bytes& in, LensSystem& lens) {
    Surface& s = lens.surfaces[static_cast<std::size_t>(in.below(256)) % lens.surfaces.size()];
    switch (in.below(12)) {
        case 0: s.curvature = in.any(); break;
        case 1: s.conic = in.any(); break;
        case 2: s.thickness = in.any(); break;
        case 3: s.clear_semi_diameter = in.any(); break;
        case 4: s.inner_semi_diameter = in.any(); break;
        case 5: s.material = Glass::constant(in.any()); break;
        case 6:
        case 7: s.material = any_glass(in); break;
        case 8: s.type = static_cast<SurfaceType>(in.below(4)); break;
        case 9: lens.stop_semi_diameter = in.any(); break;
        case 10: s.aspheric.assign(static_cast<std::size_t>(in.below(kMaxAsphericTerms + 1)), in.any()); break;
        default:
            if (!s.aspheric.empty()) s.aspheric.back() = in.any();
    }
}

/// Most of these lenses pass validate(); those that do not are for whoever traces them all the same.
inline LensSystem draw_lens(Bytes& in) {
    LensStyle style;
    style.hard = in.below(4) * 64 + in.below(64);
    if (in.chance(64)) style.size = in.decades(-3, 4);
    static constexpr int most[] = {1, 2, 3, 4, 6, 12, 30, 100};
    const int limit = most[in.below(8)];
    const int bending = limit <= 4 ? limit : 1 + in.below(limit);

    LensSystem lens;
    lens.allow_overlap = true;  // rays through impossible lenses must end too
    for (int i = 0; i < bending; ++i) lens.surfaces.push_back(draw_surface(in, style));
    if (bending > 1 && in.chance(48)) {
        const int first = in.below(bending - 1), second = first + 1 + in.below(bending - 1 - first);
        for (const int i : {first, second}) {
            Surface& mirror = lens.surfaces[static_cast<std::size_t>(i)];
            mirror.type = SurfaceType::mirror;
            mirror.material = Glass::air();
        }
        for (int i = first; i < second; ++i) lens.surfaces[static_cast<std::size_t>(i)].thickness *= -1;
    }
    if (in.chance(16)) lens.surfaces.push_back(draw_plane(in, style, SurfaceType::aperture));
    const auto place = lens.surfaces.begin() + in.below(static_cast<int>(lens.surfaces.size()) + 1);
    const bool backwards = place != lens.surfaces.begin() && std::prev(place)->thickness < 0;
    Surface stop = draw_plane(in, style, SurfaceType::stop);
    if (backwards) stop.thickness *= -1;
    lens.surfaces.insert(place, stop);
    lens.surfaces.back().thickness = 0;
    lens.film_distance = draw_thickness(in, style) + 1e-3 * style.size;
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter * (in.chance(64) ? in.unit() : 1.0);
    // Rare, because placing the blades takes as long as a thousand rays.
    if (in.chance(1)) lens.iris = {3 + in.below(22), in.unit(), in.between(-10, 10)};
    if (in.chance(8)) spoil(in, lens);
    return lens;
}

}  // namespace realcam::fuzz
