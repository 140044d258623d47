#pragma once
// Rays in 50 decimal digits through surfaces of any form in any place, by other ways than the core's: Newton's method
// on the sag alone, whose gradient is a central difference (its error, about 1e-30, is below all that tests ask), and
// matrices from the definition of the tilts. Rays are not asked whether a rim lets them pass.

#include <boost/math/constants/constants.hpp>

#include "../oracle.hpp"

namespace realcam::test {

/// Rows are the axes of the frame, so that times() goes into the frame.
struct RealFrame {
    RealVector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

    RealVector into(const RealVector& d) const { return {dot(x, d), dot(y, d), dot(z, d)}; }
    RealVector out_of(const RealVector& d) const { return d.x * x + d.y * y + d.z * z; }
    RealVector point_into(const RealVector& p) const { return into(p - origin); }
    RealVector point_out_of(const RealVector& p) const { return out_of(p) + origin; }
};

/// `inner` as seen from the frame in which `outer` is given.
inline RealFrame inside(const RealFrame& outer, const RealFrame& inner) {
    return {outer.out_of(inner.x), outer.out_of(inner.y), outer.out_of(inner.z), outer.point_out_of(inner.origin)};
}

inline RealFrame real_frame(const SurfacePlacement& placement) {
    const auto turned = [](const RealVector& axis, const RealVector& v, double degrees) {
        // Rodrigues' rotation.
        const Real a = Real(degrees) * boost::math::constants::pi<Real>() / 180;
        return cos(a) * v + sin(a) * cross(axis, v) + (1 - cos(a)) * dot(axis, v) * axis;
    };
    RealFrame frame;
    frame.origin = exact(placement.decentre);
    const auto turn = [&](RealVector axis, double degrees) {
        frame.x = turned(axis, frame.x, degrees);
        frame.y = turned(axis, frame.y, degrees);
        frame.z = turned(axis, frame.z, degrees);
    };
    turn(frame.x, placement.tilt_deg.x);
    turn(frame.y, placement.tilt_deg.y);
    turn(frame.z, placement.tilt_deg.z);
    return frame;
}

/// The sag by its definition. Of Zernike terms the first eight of Noll's, of Forbes terms the first three.
inline Real real_sag(const Surface& s, const Real& x, const Real& y) {
    const SurfaceForm& form = s.form;
    const Real c(s.curvature), k(s.conic), r2 = x * x + y * y, r = sqrt(r2);
    const auto section = [&](const Real& v2) { return c * v2 / (1 + sqrt(1 - (1 + k) * c * c * v2)); };
    const auto even_terms = [&](const Real& v2) {
        Real sum = 0, power = v2;
        for (const double a : s.aspheric) sum += a * (power *= v2);
        return sum;
    };
    Real z = 0;
    if (form.base == BaseForm::conic) {
        z = section(r2) + even_terms(r2);
    } else if (form.base == BaseForm::biconic) {
        const Real cx(form.curvature_x), kx(form.conic_x);
        z = (cx * x * x + c * y * y) / (1 + sqrt(1 - (1 + kx) * cx * cx * x * x - (1 + k) * c * c * y * y)) +
            even_terms(r2);
    } else {
        const Real cx(form.curvature_x), profile = section(y * y) + even_terms(y * y);
        if (form.curvature_x == 0) return profile;
        const Real radius = 1 / cx, rest = radius - profile;  // of the circle about the line
        z = radius - (radius > 0 ? 1 : -1) * sqrt(rest * rest - x * x);
    }
    Real power = 1;
    for (const double a : form.radial) z += a * (power *= r);
    for (const XyTerm& term : form.xy) z += term.coefficient * pow(x, term.x) * pow(y, term.y);
    if (form.zernike) {
        const Real u = x / form.zernike->radius, v = y / form.zernike->radius, w = u * u + v * v;
        const Real noll[8] = {1,
                              2 * u,
                              2 * v,
                              sqrt(Real(3)) * (2 * w - 1),
                              2 * sqrt(Real(6)) * u * v,
                              sqrt(Real(6)) * (u * u - v * v),
                              sqrt(Real(8)) * (3 * w - 2) * v,
                              sqrt(Real(8)) * (3 * w - 2) * u};
        for (std::size_t i = 0; i < form.zernike->coefficients.size(); ++i)
            z += form.zernike->coefficients[i] * noll[i];
    }
    if (form.forbes) {
        const Real w = r2 / (Real(form.forbes->radius) * form.forbes->radius);
        const Real bfs[3] = {1, (13 - 16 * w) / sqrt(Real(19)), sqrt(Real(2) / 95) * (29 - 4 * w * (25 - 19 * w))};
        const Real con[3] = {1, 6 * w - 5, 15 - 14 * w * (3 - 2 * w)};
        const bool is_bfs = form.forbes->kind == ForbesKind::bfs;
        Real sum = 0;
        for (std::size_t i = 0; i < form.forbes->coefficients.size(); ++i)
            sum += form.forbes->coefficients[i] * (is_bfs ? bfs : con)[i];
        z += (is_bfs ? w * (1 - w) / sqrt(1 - c * c * r2) : w * w) * sum;
    }
    return z;
}

struct FormRay {
    RealVector origin, direction;  ///< lens frame; the direction times the index
    Real path = 0;
};

inline FormRay form_oracle(const LensSystem& lens, LightDirection way, const RealVector& origin,
                           const RealVector& direction) {
    const bool to_film = way == LightDirection::to_film;
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    std::vector<RealFrame> frames;
    RealFrame axis;
    for (const Surface& s : lens.surfaces) {
        frames.push_back(inside(axis, real_frame(s.placement)));
        if (!s.placement.returns) axis = frames.back();
        RealFrame next;
        next.origin = {0, 0, s.thickness};
        axis = inside(axis, next);
    }
    FormRay ray{origin, normalized(direction)};
    const std::size_t count = lens.surfaces.size();
    for (std::size_t step = 0; step < count; ++step) {
        const std::size_t i = to_film ? step : count - 1 - step;
        const Surface& s = lens.surfaces[i];
        const Real before = to_film ? n[i] : n[i + 1], after = to_film ? n[i + 1] : n[i];
        const RealVector o = frames[i].point_into(ray.origin), d = frames[i].into(ray.direction);
        const Real h = 1e-16;
        const auto gradient = [&](const RealVector& at) {
            return RealVector{-(real_sag(s, at.x + h, at.y) - real_sag(s, at.x - h, at.y)) / (2 * h),
                              -(real_sag(s, at.x, at.y + h) - real_sag(s, at.x, at.y - h)) / (2 * h), 1};
        };
        Real t = -o.z / d.z;
        for (int k = 0; k < 12; ++k) {
            const RealVector at = o + t * d;
            t -= (at.z - real_sag(s, at.x, at.y)) / dot(gradient(at), d);
        }
        const RealVector at = o + t * d;
        const auto bent = oracle_refract(d, normalized(gradient(at)), before, after, s.type == SurfaceType::mirror);
        ray.origin = frames[i].point_out_of(at);
        ray.direction = frames[i].out_of(*bent);
        ray.path += before * t;
    }
    ray.direction = Real(to_film ? n.back() : n.front()) * ray.direction;
    return ray;
}

}  // namespace realcam::test
