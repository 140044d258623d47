#include "polarised_ray.hpp"

#include <cmath>

#include "../trace/lens_trace.hpp"
#include "../trace/trace_request.hpp"

namespace realcam {

PolarisedTrace::PolarisedTrace(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                               int surface_count, const PathEnds& ends)
    : path_(lens, direction, wavelength_nm, ends), surfaces_(coated_surfaces(lens, wavelength_nm, direction)) {
    check_wavelength_in_glasses(lens, wavelength_nm, "transmission");
    if (surface_count >= 0) surfaces_.erase(surfaces_.begin() + surface_count, surfaces_.end());
}

RayTransmittance PolarisedTrace::operator()(Vec3d origin, Vec3d direction) const {
    const LensEntry entry =
        enter_lens(origin - Vec3d{0, 0, path_.entry_position}, direction, path_.entry_index, path_.entry_reach);
    LensRays<double, 1> ray;
    ray.origin.set(0, entry.origin);
    ray.direction.set(0, entry.direction);
    ray.status[0] = static_cast<int>(entry.status);
    const LensView<double> view = path_.view();
    Fields fields;
    double averaged = 1;
    if (entry.status == RayStatus::ok) fields = unpolarised(normalized(entry.direction));
    for (std::size_t i = 0; i < surfaces_.size() && ray.status[0] == 0; ++i) {
        const SurfaceView<double>& surface = view.surfaces[i];
        if (view.free.frames && view.free.frames[i].before.changes)
            change_to_frame(view.free.frames[i].before, ray, fields);
        const Vec3d before = normalized(ray.direction[0]);
        AsymmetricParts<double> free = view.free.from(static_cast<int>(i));
        free.frames = nullptr;  // the frame change would also leave the surface's frame
        trace_lens(LensView<double>{&surface, 1, view.kind, view.iris, free}, ray, PathRecord<double, 1>{});
        if (ray.status[0] != 0 || !surfaces_[i]) continue;
        const Vec3d normal = normal_at(view, static_cast<int>(i), ray.origin[0]);
        const PolarisedResponse response = surfaces_[i]->at(std::fabs(dot(before, normal)));
        const bool is_mirror = surfaces_[i]->is_mirror();
        averaged *= is_mirror ? response.mean_reflectance() : response.mean_transmittance();
        fields = behind_surface(fields, before, normalized(ray.direction[0]), normal,
                                is_mirror ? response.s.r : scaled_to_power(response.s),
                                is_mirror ? response.p.r : scaled_to_power(response.p));
    }
    const auto status = static_cast<RayStatus>(ray.status[0]);
    if (status != RayStatus::ok) return {status, 0, 0};
    return {status, (power(fields.first) + power(fields.second)) / 2, averaged};
}

void PolarisedTrace::change_to_frame(const FrameChange<double>& frame, LensRays<double, 1>& ray, Fields& fields) {
    change_frame(frame, ray);
    for (Field* field : {&fields.first, &fields.second})
        *field = {frame.direction(field->real), frame.direction(field->imaginary)};
}

PolarisedTrace::Complex PolarisedTrace::scaled_to_power(const SurfaceResponse& response) {
    const double size = std::abs(response.t);
    return size > 0 ? response.t * (std::sqrt(response.transmittance) / size) : Complex(0);
}

Vec3d PolarisedTrace::some_perpendicular(Vec3d unit) {
    const Vec3d axis = std::fabs(unit.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    return normalized(cross(axis, unit));
}

PolarisedTrace::Fields PolarisedTrace::unpolarised(Vec3d direction) {
    const Vec3d first = some_perpendicular(direction);
    return {{first, {0, 0, 0}}, {cross(direction, first), {0, 0, 0}}};
}

PolarisedTrace::Fields PolarisedTrace::behind_surface(const Fields& fields, Vec3d before, Vec3d after, Vec3d normal,
                                                      Complex s_coefficient, Complex p_coefficient) {
    const Vec3d across_plane = cross(before, normal);
    // Closer to normal incidence than this, both polarisations behave alike to double precision.
    const bool is_normal_incidence = dot(across_plane, across_plane) < 1e-18;
    const Vec3d s = is_normal_incidence ? some_perpendicular(before) : normalized(across_plane);
    const Vec3d p_before = cross(s, before), p_after = cross(s, after);
    const auto transmitted = [&](const Field& field) {
        const Complex a = s_coefficient * along(field, s), b = p_coefficient * along(field, p_before);
        return Field{a.real() * s + b.real() * p_after, a.imag() * s + b.imag() * p_after};
    };
    return {transmitted(fields.first), transmitted(fields.second)};
}

Vec3d PolarisedTrace::normal_at(const LensView<double>& lens, int index, Vec3d point) {
    const SurfaceView<double>& surface = lens.surfaces[index];
    if (surface.kind == SurfaceShape::freeform) {
        const Lanes<double, 1> x = {point.x}, y = {point.y};
        FreeformSags<double, 1> sag;
        freeform_sags<double, 1>(lens.free.freeforms[index], x, y, sag);
        return normalized(Vec3d{-sag.slope_x[0], -sag.slope_y[0], 1});
    }
    if (surface.kind == SurfaceShape::asphere) {
        const double slope = 2 * asphere_sag(surface, point.x * point.x + point.y * point.y).derivative;
        return normalized(Vec3d{-slope * point.x, -slope * point.y, 1});
    }
    const double c = surface.curvature;
    return normalized(Vec3d{-c * point.x, -c * point.y, 1 - c * surface.conic_factor * point.z});
}

}  // namespace realcam
