#include "dual_path.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace realcam {

namespace {

constexpr int kRayLanes = 6;  ///< lanes of derivatives by the incoming ray

/// Calls f(number, index) for the six numbers of a ray.
template <class F>
void for_ray_numbers(Vec3<Dual8>& o, Vec3<Dual8>& p, F&& f) {
    f(o.x, 0), f(o.y, 1), f(o.z, 2), f(p.x, 3), f(p.y, 4), f(p.z, 5);
}

/// Sag of a surface and its derivatives by x and y, in dual numbers.
struct SagWithSlopes {
    Dual8 height, slope_x, slope_y;
};

/// Evaluates an asphere or a freeform at x and y of `at`.
REALCAM_INLINE SagWithSlopes sag_at(const DualSurface& surface, const Vec3<Dual8>& at) {
    if (surface.view.kind == SurfaceShape::asphere) {
        const Dual8 r2 = at.x * at.x + at.y * at.y;
        Sag<Dual8> sag = asphere_sag(surface.view, r2);
        for (std::size_t lane = 0; lane < kDualLanes; ++lane) {
            if (surface.powers[lane] == 0) continue;
            const int half = surface.powers[lane] / 2;
            const double power = std::pow(r2.value, half - 1);
            sag.height.by[lane] += power * r2.value;
            sag.derivative.by[lane] += half * power;
        }
        const Dual8 slope = 2.0 * sag.derivative;
        return {sag.height, slope * at.x, slope * at.y};
    }
    const Lanes<Dual8, 1> x = {at.x}, y = {at.y};
    FreeformSags<Dual8, 1> sag;
    freeform_sags<Dual8, 1>(surface.form.front(), x, y, sag);
    return {sag.height[0], sag.slope_x[0], sag.slope_y[0]};
}

/// Returns the ray-surface intersection in dual numbers, given its point `at` in double.
REALCAM_INLINE SurfaceHit<Dual8> hit_of(const DualSurface& surface, const Vec3<Dual8>& o, const Vec3<Dual8>& p,
                                        Vec3d at) {
    const SurfaceView<Dual8>& view = surface.view;
    if (view.kind == SurfaceShape::sphere) return intersect_sphere(o, p, view.curvature, view.direction_sign_in);
    if (view.kind == SurfaceShape::conic) {
        const Dual8 approach = to_vertex_plane(o, p);
        SurfaceHit<Dual8> hit =
            intersect_conic(o + approach * p, p, view.curvature, view.conic_factor, view.direction_sign_in);
        hit.parameter += approach;
        return hit;
    }
    const Vec3d from = value(o), direction = value(p);
    const Dual8 known = dot(at - from, direction) / dot(direction, direction);
    const Vec3<Dual8> near = o + known * p;
    const SagWithSlopes near_sag = sag_at(surface, near);
    const double rise = direction.z - near_sag.slope_x.value * direction.x - near_sag.slope_y.value * direction.y;
    const Dual8 parameter = known - (near.z - near_sag.height) / Dual8(rise);
    const SagWithSlopes sag = sag_at(surface, o + parameter * p);
    return freeform_hit(view.direction_sign_in, p, parameter, sag.slope_x, sag.slope_y, Dual8(1));
}

}  // namespace

DualPath::DualPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                   std::vector<LensVariable> variables, ExitFrame exit, bool has_rims)
    : variables_(std::move(variables)) {
    check_variables(lens, variables_);
    const LensPath<double> path(lens, direction, wavelength_nm);
    const LensView<double> view = path.view();
    views_.assign(view.surfaces, view.surfaces + view.count);
    kind_ = view.kind;
    iris_ = view.iris;
    if (view.free.frames) frames_.assign(view.free.frames, view.free.frames + view.count);
    if (view.free.freeforms) freeforms_.assign(view.free.freeforms, view.free.freeforms + view.count);
    if (view.free.apertures && has_rims) apertures_.assign(view.free.apertures, view.free.apertures + view.count);
    for (FrameChanges<double>& change : frames_) change.out.changes = 0;
    if (!has_rims)
        for (SurfaceView<double>& surface : views_) {
            surface.rim_squared = std::numeric_limits<double>::max();
            surface.hole_squared = -1;
            surface.has_blades = 0;
        }
    if (kind_ == LensKind::plain) kind_ = LensKind::rotational;
    entry_index_ = path.entry_index, entry_position_ = path.entry_position, entry_reach_ = path.entry_reach;
    const bool to_film = direction == LightDirection::to_film;
    std::vector<DualLens> duals;
    for (std::size_t first = 0; first < variables_.size() || first == 0; first += kDualLanes)
        duals.emplace_back(lens, wavelength_nm, variables_, first);
    add_surfaces(lens, duals, to_film);
    leaves_along_axis_ &= exit != ExitFrame::film;
    const int last = views_.back().surface_index;
    for (const DualLens& dual : duals) {
        const auto in_lens = [&]() -> Affine<Dual8> {
            if (leaves_along_axis_) return {.origin = {0.0, 0.0, dual.vertices[static_cast<std::size_t>(last)]}};
            return dual.frame(lens, last);
        };
        exits_.push_back(exit == ExitFrame::lens   ? in_lens()
                         : exit == ExitFrame::film ? dual.film(lens)
                                                   : dual.last_axis(lens));
        entry_positions_.push_back(to_film ? Dual8(0) : dual.vertices[lens.surfaces.size() - 1]);
        entry_indices_.push_back(to_film ? dual.indices.front() : dual.indices.back());
    }
}

void DualPath::add_surfaces(const LensSystem& lens, const std::vector<DualLens>& lenses, bool to_film) {
    bool is_placed = path_frames_detail::has_placements(lens);
    for (const LensVariable& v : variables_)
        is_placed |= v.quantity == LensQuantity::tilt || v.quantity == LensQuantity::decentre;
    leaves_along_axis_ = !is_placed;
    const auto surface = [&](std::size_t k) { return views_[k].surface_index; };
    std::vector<DualSurface> constants;
    for (std::size_t k = 0; k < views_.size(); ++k) {
        std::vector<LensVariable> own;
        for (const LensVariable& v : variables_)
            if (v.surface == surface(k)) own.push_back(v);
        constants.emplace_back(views_[k], lens.surfaces[static_cast<std::size_t>(surface(k))], own);
        duals_.push_back({constants.back()});
    }
    std::vector<int> used_lanes(views_.size(), kRayLanes);  // occupied lanes of each surface's last dual surface
    for (std::size_t first = 0; first < variables_.size() || first == 0; first += kDualLanes) {
        const DualLens& dual = lenses[first / kDualLanes];
        for (std::size_t k = 0; k < views_.size(); ++k) {
            const int here = surface(k), before = k == 0 ? here : surface(k - 1);
            DualSurface seeded = constants[k];
            for (int lane = 0; lane < kDualLanes && first + static_cast<std::size_t>(lane) < variables_.size();
                 ++lane) {
                const std::size_t v = first + static_cast<std::size_t>(lane);
                seeded.variables[static_cast<std::size_t>(lane)] = static_cast<int>(v);
                if (variables_[v].surface == here)
                    seed_shape(seeded, lens.surfaces[static_cast<std::size_t>(here)], variables_[v], lane);
            }
            const auto at = static_cast<std::size_t>(here);
            const Dual8 n = dual.indices[to_film ? at : at + 1], behind = dual.indices[to_film ? at + 1 : at];
            seeded.view.squared_index_change = (behind - n) * (behind + n) / (n * n);
            seeded.view.index_squared = n * n;
            if (is_placed) {
                Affine<Dual8> to = k > 0 ? dual.neighbour(lens, before, here) : dual.frame(lens, here);
                if (k == 0 && !to_film) to.origin.z -= dual.vertices[at];
                seeded.before = {to.origin, to.x, to.y, to.z, true};
                seeded.view.shift = 0;
            } else if (k > 0) {
                seeded.view.shift = dual.vertices[at] - dual.vertices[static_cast<std::size_t>(before)];
            }
            if (first == 0) {
                // Values without derivatives, which all dual surfaces of this surface share.
                constants[k] = seeded;
                constants[k].clear_lanes();
                duals_[k] = {constants[k]};
            }
            for (const int lane : seeded.lanes()) {
                if (used_lanes[k] == kDualLanes) {
                    duals_[k].push_back(constants[k]);
                    used_lanes[k] = 0;
                }
                duals_[k].back().copy_lane(used_lanes[k]++, seeded, lane);
            }
        }
    }
}

RayStatus DualPath::trace(Vec3d origin, Vec3d direction, Tape& tape, int surfaces) const {
    LensRays<double, 1> ray;
    ray.origin.set(0, origin);
    ray.direction.set(0, direction);
    ray.status[0] = 0;
    PathRecord<double, 1> record{};
    tape.start_direction_ = direction;
    tape.steps_.resize(views_.size());
    const auto data = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    const AsymmetricParts<double> free{data(frames_), data(freeforms_), data(apertures_)};
    const std::size_t count = surfaces < 0 ? views_.size() : static_cast<std::size_t>(surfaces);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3d o = ray.origin[0], p = ray.direction[0];
        const LensView<double> one{&views_[k], 1, kind_, iris_, free.from(static_cast<int>(k))};
        trace_lens(one, ray, record);
        tape.status_ = static_cast<RayStatus>(ray.status[0]);
        if (tape.status_ != RayStatus::ok) break;
        Tape::Step& step = tape.steps_[k];
        step.origin = ray.origin[0];
        step.direction = ray.direction[0];
        step.path = record.optical_path[0];
        step.by.resize(duals_[k].size());
        for (std::size_t i = 0; i < duals_[k].size(); ++i)
            differentiate(duals_[k][i], i == 0, o, p, step.origin, step.by[i]);
    }
    return tape.status_;
}

REALCAM_CLONES void DualPath::differentiate(const DualSurface& surface, bool has_ray_lanes, Vec3d from, Vec3d along,
                                            Vec3d at, Tape::Derivatives& by) const {
    Vec3<Dual8> o = static_cast<Vec3<Dual8>>(from), p = static_cast<Vec3<Dual8>>(along);
    if (has_ray_lanes) {
        o.x.by[0] = o.y.by[1] = o.z.by[2] = 1;
        p.x.by[3] = p.y.by[4] = p.z.by[5] = 1;
    }
    if (surface.before.changes) {
        const DualFrame& frame = surface.before;
        o = o - frame.origin;
        o = {dot(frame.x, o), dot(frame.y, o), dot(frame.z, o)};
        p = {dot(frame.x, p), dot(frame.y, p), dot(frame.z, p)};
    } else {
        o.z -= surface.view.shift;
    }
    const SurfaceHit<Dual8> hit = hit_of(surface, o, p, at);
    const Refraction<Dual8> refracted =
        refract(p, hit.normal, hit.along_normal, surface.view.squared_index_change, surface.view.direction_sign_out);
    const Vec3<Dual8> end = o + hit.parameter * p, direction = refracted.direction;
    by.of[0] = end.x.by, by.of[1] = end.y.by, by.of[2] = end.z.by;
    by.of[3] = direction.x.by, by.of[4] = direction.y.by, by.of[5] = direction.z.by;
    by.of[6] = (surface.view.index_squared * hit.parameter).by;
}

REALCAM_CLONES void DualPath::derivatives_behind(const Tape& tape, int surfaces, RayDerivatives& ray) const {
    constexpr std::size_t kNumbers = RayDerivatives::kNumbers;
    // Vectors of eight hold the seven numbers; the last element is unused.
    using Numbers = Dual8::Derivatives;
    const std::size_t count = variables_.size();
    const Tape::Step& last = tape.steps_[static_cast<std::size_t>(surfaces) - 1];
    ray.status = RayStatus::ok;
    ray.origin = last.origin, ray.direction = last.direction, ray.path = last.path;
    ray.by_variable.assign(kNumbers * count, 0);
    // Derivatives of the exit ray by the ray behind surface k.
    Numbers by[kRayLanes] = {};
    for (int i = 0; i < kRayLanes; ++i) by[i][i] = 1;
    for (int k = surfaces - 1; k >= 0; --k) {
        const Tape::Step& step = tape.steps_[static_cast<std::size_t>(k)];
        const std::vector<DualSurface>& duals = duals_[static_cast<std::size_t>(k)];
        for (std::size_t d = 0; d < duals.size(); ++d) {
            const Numbers* change = step.by[d].of;
            for (std::size_t lane = 0; lane < kDualLanes; ++lane) {
                const int v = duals[d].variables[lane];
                if (v < 0) continue;
                Numbers sum = change[0][lane] * by[0];
                for (int i = 1; i < kRayLanes; ++i) sum += change[i][lane] * by[i];
                sum[6] += change[6][lane];
                double* to = &ray.by_variable[kNumbers * static_cast<std::size_t>(v)];
                for (int number = 0; number < RayDerivatives::kNumbers; ++number) to[number] += sum[number];
            }
        }
        const Numbers* by_ray = step.by.front().of;
        Numbers next[kRayLanes];
        for (int j = 0; j < kRayLanes; ++j) {
            next[j] = by_ray[0][j] * by[0];
            for (int i = 1; i < kRayLanes; ++i) next[j] += by_ray[i][j] * by[i];
            next[j][6] += by_ray[6][j];
        }
        for (int j = 0; j < kRayLanes; ++j) by[j] = next[j];
    }
    for (int number = 0; number < RayDerivatives::kNumbers; ++number)
        for (int j = 0; j < kRayLanes; ++j) ray.by_start[number][j] = by[j][number];
    // The start origin is relative to a vertex that may move, and the start direction is as long as an index that may
    // change.
    const Vec3d p = tape.start_direction_;
    for (std::size_t v = 0; v < count; ++v) {
        const double position_rate = entry_positions_[v / kDualLanes].by[v % kDualLanes];
        const double index_rate = entry_indices_[v / kDualLanes].by[v % kDualLanes] / entry_index_;
        if (position_rate == 0 && index_rate == 0) continue;
        const Numbers sum = index_rate * (p.x * by[3] + p.y * by[4] + p.z * by[5]) - position_rate * by[2];
        double* to = &ray.by_variable[kNumbers * v];
        for (int number = 0; number < RayDerivatives::kNumbers; ++number) to[number] += sum[number];
    }
}

void DualPath::derivatives(const Tape& tape, RayDerivatives& ray) const {
    constexpr std::size_t kNumbers = RayDerivatives::kNumbers;
    const std::size_t count = variables_.size();
    derivatives_behind(tape, surface_count(), ray);
    if (leaves_along_axis_) {
        ray.origin.z += exits_.front().origin.z.value;
        for (std::size_t v = 0; v < count; ++v)
            ray.by_variable[kNumbers * v + 2] += exits_[v / kDualLanes].origin.z.by[v % kDualLanes];
        return;
    }
    RayDerivatives transformed = ray;
    for (std::size_t first = 0; first < count || first == 0; first += kDualLanes) {
        const Affine<Dual8>& frame = exits_[first / kDualLanes];
        Vec3<Dual8> o = static_cast<Vec3<Dual8>>(ray.origin), p = static_cast<Vec3<Dual8>>(ray.direction);
        const std::size_t lanes = std::min<std::size_t>(count - first, kDualLanes);
        for_ray_numbers(o, p, [&](Dual8& number, int index) {
            for (std::size_t lane = 0; lane < lanes; ++lane)
                number.by[lane] = ray.by_variable[kNumbers * (first + lane) + static_cast<std::size_t>(index)];
        });
        o = frame.point(o);
        p = frame.direction(p);
        transformed.origin = value(o), transformed.direction = value(p);
        for_ray_numbers(o, p, [&](const Dual8& number, int index) {
            for (std::size_t lane = 0; lane < lanes; ++lane)
                transformed.by_variable[kNumbers * (first + lane) + static_cast<std::size_t>(index)] = number.by[lane];
        });
    }
    const Affine<Dual8>& frame = exits_.front();
    const Vec3d x = value(frame.x), y = value(frame.y), z = value(frame.z);
    for (int j = 0; j < kRayLanes; ++j)
        for (int half : {0, 3}) {
            const Vec3d turn =
                ray.by_start[half][j] * x + ray.by_start[half + 1][j] * y + ray.by_start[half + 2][j] * z;
            transformed.by_start[half][j] = turn.x, transformed.by_start[half + 1][j] = turn.y;
            transformed.by_start[half + 2][j] = turn.z;
        }
    ray = std::move(transformed);
}

}  // namespace realcam
