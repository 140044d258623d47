#include "tangent_path.hpp"

#include <limits>
#include <numeric>
#include <utility>

#include "../trace/film_frame.hpp"

namespace realcam {

namespace {

/// Returns the derivatives of a frame's motion relative to an origin, in the frame's own axes, as those of its origin
/// and axes. Both are given in the camera's axes.
DualFrame motion_of(const Affine<Dual8>& frame, const Vec3<Dual8>& camera_origin) {
    const Vec3<Dual8> axes[3] = {static_cast<Vec3<Dual8>>(value(frame.x)), static_cast<Vec3<Dual8>>(value(frame.y)),
                                 static_cast<Vec3<Dual8>>(value(frame.z))};
    const auto in_frame = [&](const Vec3<Dual8>& v) {
        return Vec3<Dual8>{dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)};
    };
    return {in_frame(frame.origin - camera_origin), in_frame(frame.x), in_frame(frame.y), in_frame(frame.z), true};
}

/// Returns the film's frame (film_frame) in dual numbers.
Affine<Dual8> film_frame_of(const DualLens& dual, const LensSystem& lens) {
    const Affine<Dual8> film = dual.film(lens), last = dual.frame(lens, static_cast<int>(lens.surfaces.size()) - 1);
    const Affine<Dual8> last_from_film{
        {film.x.x, film.y.x, film.z.x},
        {film.x.y, film.y.y, film.z.y},
        {film.x.z, film.y.z, film.z.z},
        {-dot(film.x, film.origin), -dot(film.y, film.origin), -dot(film.z, film.origin)}};
    return last * last_from_film;
}

/// Returns the derivatives by a translation and a rotation of a frame about its origin, from those by its origin and
/// axes, all along its own axes.
std::array<double, 6> rigid_motion(const double* adjoints) {
    const auto vector = [&](int first) { return Vec3d{adjoints[first], adjoints[first + 1], adjoints[first + 2]}; };
    // A rotation w moves the axis e by w x e, whose product with the adjoint a is w . (e x a).
    const Vec3d turn = cross(Vec3d{1, 0, 0}, vector(kFrameX)) + cross(Vec3d{0, 1, 0}, vector(kFrameY)) +
                       cross(Vec3d{0, 0, 1}, vector(kFrameZ));
    return {adjoints[0], adjoints[1], adjoints[2], turn.x, turn.y, turn.z};
}

}  // namespace

TangentPath::TangentPath(const LensSystem& lens, double wavelength_nm, std::vector<LensVariable> variables)
    : variables_(std::move(variables)) {
    check_variables(lens, variables_);
    if (std::isfinite(lens.film_radius_of_curvature))
        throw InputError("derivatives of pictures need a flat film; that of lens \"" + lens.name + "\" is curved");
    const LensPath<double> path(lens, LightDirection::to_scene, wavelength_nm,
                                film_path_ends(lens, LightDirection::to_scene));
    const LensView<double> view = path.view();
    const auto count = static_cast<std::size_t>(view.count);
    if (view.free.freeforms) freeforms_.assign(view.free.freeforms, view.free.freeforms + count);
    duals_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const int here = view.surfaces[k].surface_index;
        std::vector<LensVariable> own;
        for (const LensVariable& v : variables_)
            if (v.surface == here && v.quantity != LensQuantity::film_distance) own.push_back(v);
        TangentSurface& surface = surfaces_.emplace_back();
        surface.traced = view.surfaces[k];
        surface.traced.rim_squared = std::numeric_limits<double>::max();
        surface.traced.hole_squared = -1;
        surface.traced.has_blades = 0;
        if (view.free.frames) surface.before = view.free.frames[k].before;
        surface.freeform = freeforms_.empty() ? nullptr : &freeforms_[k];
        const DualSurface constant(view.surfaces[k], lens.surfaces[static_cast<std::size_t>(here)], own);
        surface.view = view.surfaces[k];
        surface.view.kind = constant.view.kind;
        surface.view.inverse_search_squared = constant.view.inverse_search_squared.value;
        duals_[k].push_back(constant);
    }
    for (std::size_t first = 0; first < variables_.size() || first == 0; first += kDualLanes) {
        const DualLens dual(lens, wavelength_nm, variables_, first);
        const Affine<Dual8> film = film_frame_of(dual, lens);
        film_frames_.push_back(motion_of(film, film.origin));
        for (std::size_t k = 0; k < count; ++k) {
            const int here = view.surfaces[k].surface_index;
            DualSurface seeded = duals_[k].front();
            for (int lane = 0; lane < kDualLanes && first + static_cast<std::size_t>(lane) < variables_.size();
                 ++lane) {
                const LensVariable& v = variables_[first + static_cast<std::size_t>(lane)];
                if (v.surface == here) seed_shape(seeded, lens.surfaces[static_cast<std::size_t>(here)], v, lane);
            }
            const Dual8 index = dual.indices[static_cast<std::size_t>(here) + 1];
            seeded.view.index_squared = index * index;
            seeded.view.shift = 0;
            seeded.before = motion_of(dual.frame(lens, here), film.origin);
            duals_[k].push_back(std::move(seeded));
        }
    }
    for (std::size_t k = 0; k < count; ++k) {
        surfaces_[k].duals = duals_[k].data();
        surfaces_[k].dual_count = static_cast<int>(duals_[k].size());
    }
    // In the exit frame of film_path_ends the film's centre has x = y = 0.
    exit_ = {{0, 0, camera_film_position(lens) - path.exit_position}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1};
    if (view.free.frames && view.free.frames[count - 1].out.changes) {
        const FrameChange<double>& out = view.free.frames[count - 1].out;
        // The camera's frame in that of the last surface.
        exit_ = {out.origin + exit_.origin.z * out.z, out.x, out.y, out.z, 1};
    }
}

TangentPath::Sums::Sums(const TangentPath& path) : surfaces(path.surfaces_.size()), forms(path.surfaces_.size()) {
    for (std::size_t k = 0; k < forms.size(); ++k)
        if (path.surfaces_[k].view.kind == SurfaceShape::freeform) forms[k].resize(kLanes * path.duals_[k].size());
    clear();
}

void TangentPath::Sums::clear() {
    const auto clear_step = [](AdjointStep<kLanes>& step) {
        for (auto& lanes : step.sums)
            for (double& sum : lanes) sum = 0;
    };
    clear_step(film);
    for (AdjointStep<kLanes>& step : surfaces) clear_step(step);
    for (std::vector<Dual8>& form : forms)
        for (Dual8& sum : form) sum = Dual8(0);
    for (auto& lanes : pose)
        for (double& sum : lanes) sum = 0;
}

inline void TangentPath::trace_surface(std::size_t k, Rays& rays, AdjointStep<kLanes>& step, Dual8* form_sums,
                                       const WavelengthsInDouble* wavelengths) const {
    if (wavelengths)
        trace_tangents(surfaces_[k], WavelengthsInDouble{wavelengths->surfaces + k, wavelengths->variable}, rays, step,
                       form_sums);
    else
        trace_tangents(surfaces_[k], OneWavelength{}, rays, step, form_sums);
}

// target_clones compiles only inlined code for each instruction set, hence `flatten`.
__attribute__((flatten)) REALCAM_CLONES void TangentPath::trace(Rays& rays, Sums& sums, const int* starts,
                                                                const Vec3d* rim_tangents,
                                                                const WavelengthsInDouble* wavelengths) const {
    constexpr int N = kLanes;
    for (int i = 0; i < N; ++i) {
        if (!starts) {
            add_start({rays.origin.x[i], rays.origin.y[i], 0}, rays.direction_tangent[i], sums.film, i);
        } else {
            rays.direction_tangent.set(i, {0, 0, 0});
        }
        rays.origin_tangent.set(i, {0, 0, 0});
    }
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const TangentSurface& surface = surfaces_[k];
        AdjointStep<N>& step = sums.surfaces[k];
        trace_surface(k, rays, step, sums.forms[k].data(), wavelengths);
        step.origin = rays.origin, step.direction = rays.direction;
        if (!starts) continue;
        for_surface_points(surface, rays.origin, sums.forms[k].data(), [&](const auto& point, int i) {
            if (starts[i] != static_cast<int>(k)) return;
            const Vec3d tangent = rim_tangents[i];
            rays.direction_tangent.set(i, tangent);
            add_start(rays.origin[i], tangent, step, i);
            // The rim moves along z with the surface's sag there.
            point.add_numbers(Vec3d{0, 0, 0}, tangent.z / point.gradient().z, step, i);
        });
    }
    change_frame(exit_, static_cast<LensRays<double, N>&>(rays));
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3d o = rays.origin[i], p = rays.direction[i];
        const Vec3d o_tangent = exit_.direction(rays.origin_tangent[i]),
                    p_tangent = exit_.direction(rays.direction_tangent[i]);
        rays.origin_tangent.set(i, o_tangent);
        rays.direction_tangent.set(i, p_tangent);
        const Vec3d moment = cross(o_tangent, p) + cross(o, p_tangent);
        sums.pose[0][i] += p_tangent.x, sums.pose[1][i] += p_tangent.y, sums.pose[2][i] += p_tangent.z;
        sums.pose[3][i] += moment.x, sums.pose[4][i] += moment.y, sums.pose[5][i] += moment.z;
    }
}

__attribute__((flatten)) REALCAM_CLONES void TangentPath::record(Rays& rays, std::vector<Crossing>& crossings,
                                                                 const WavelengthsInDouble* wavelengths) const {
    for (int i = 0; i < kLanes; ++i) rays.origin_tangent.set(i, {0, 0, 0});
    crossings.resize(surfaces_.size());
    AdjointStep<kLanes> unused{};
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        std::vector<Dual8> forms(surfaces_[k].view.kind == SurfaceShape::freeform ? kLanes * duals_[k].size() : 0);
        trace_surface(k, rays, unused, forms.data(), wavelengths);
        crossings[k].origin = rays.origin, crossings[k].direction = rays.direction;
        crossings[k].origin_tangent = rays.origin_tangent;
    }
    change_frame(exit_, static_cast<LensRays<double, kLanes>&>(rays));
}

CameraDerivatives TangentPath::derivatives(const Sums& sums) const {
    const auto lane_sum = [](const auto& lanes) { return std::accumulate(lanes, lanes + kLanes, 0.0); };
    CameraDerivatives result;
    result.by_variable.assign(variables_.size(), 0);
    const auto adjoints_of = [&](const AdjointStep<kLanes>& step, double* adjoints) {
        for (int number = 0; number < kSurfaceNumbers; ++number) adjoints[number] = lane_sum(step.sums[number]);
    };
    double film[kSurfaceNumbers];
    adjoints_of(sums.film, film);
    result.by_film = rigid_motion(film);
    for (std::size_t i = 0; i < 6; ++i) result.by_pose[i] = lane_sum(sums.pose[i]);
    Vec3d of_film[4];
    for (int part = 0; part < 4; ++part) of_film[part] = {film[3 * part], film[3 * part + 1], film[3 * part + 2]};
    for (std::size_t v = 0; v < variables_.size(); ++v)
        result.by_variable[v] = sum_of_frame(of_film, film_frames_[v / kDualLanes], v % kDualLanes);
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        double adjoints[kSurfaceNumbers];
        adjoints_of(sums.surfaces[k], adjoints);
        const std::size_t blocks = duals_[k].size();
        for (std::size_t v = 0; v < variables_.size(); ++v) {
            const std::size_t block = v / kDualLanes + 1, lane = v % kDualLanes;
            result.by_variable[v] += sum_of_surface(adjoints, duals_[k][block], lane);
            if (sums.forms[k].empty()) continue;
            Lanes<double, kLanes> form;
            for (std::size_t i = 0; i < kLanes; ++i) form[i] = sums.forms[k][i * blocks + block].by[lane];
            result.by_variable[v] += lane_sum(form);
        }
    }
    return result;
}

template <class SomeSums, class F>
void TangentPath::for_sums(SomeSums& sums, F&& f) {
    for (auto& lanes : sums.film.sums) f(lanes);
    for (auto& step : sums.surfaces)
        for (auto& lanes : step.sums) f(lanes);
    for (auto& lanes : sums.pose) f(lanes);
}

TangentPath::Coefficients TangentPath::coefficients(const CameraDerivatives& along) const {
    // Derivatives are linear in the sums: a coefficient is the derivative that a sum of 1 alone yields.
    Sums unit(*this);
    Coefficients list;
    const auto add = [&] {
        const CameraDerivatives by = derivatives(unit);
        const auto product = [](const auto& a, const auto& b) {
            return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
        };
        list.push_back(product(by.by_variable, along.by_variable) + product(by.by_film, along.by_film) +
                       product(by.by_pose, along.by_pose));
    };
    for_sums(unit, [&](auto& lanes) {
        lanes[0] = 1;
        add();
        lanes[0] = 0;
    });
    for (std::size_t k = 0; k < surfaces_.size(); ++k)
        for (std::size_t i = 0; i < unit.forms[k].size() / kLanes; ++i)
            for (int lane = 0; lane < kDualLanes; ++lane) {
                unit.forms[k][i].by[lane] = 1;
                add();
                unit.forms[k][i].by[lane] = 0;
            }
    return list;
}

void TangentPath::add_along(const Coefficients& coefficients, const Sums& sums, std::array<double, kLanes>& by) {
    auto coefficient = coefficients.begin();
    for_sums(sums, [&](const auto& lanes) {
        const double factor = *coefficient++;
        if (factor == 0) return;
        for (std::size_t i = 0; i < kLanes; ++i) by[i] += factor * lanes[i];
    });
    for (const std::vector<Dual8>& form : sums.forms) {
        const std::size_t blocks = form.size() / kLanes;
        for (std::size_t block = 0; block < blocks; ++block)
            for (int lane = 0; lane < kDualLanes; ++lane) {
                const double factor = *coefficient++;
                for (std::size_t i = 0; i < kLanes; ++i) by[i] += factor * form[i * blocks + block].by[lane];
            }
    }
}

}  // namespace realcam
