#include "tangent_path.hpp"

#include <algorithm>
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

namespace {

constexpr int kLanes = TangentPath::kLanes;

/// `sums` of trace_tangents_to_scene: the contributions of all numbers.
struct AllSums {
    const TangentPath& path;
    TangentPath::Sums& to;

    AdjointStep<kLanes>& surface(int k) { return to.surfaces[static_cast<std::size_t>(k)]; }
    AdjointStep<kLanes>& film() { return to.film; }
    FreeformTangents forms(int k) { return path.forms(k, to.forms[static_cast<std::size_t>(k)].data()); }
    Lanes<double, kLanes>& pose(int i) { return to.pose[i]; }
    void finish(int k, const LensRays<double, kLanes>& rays) {
        if (k == kStartOnFilm) return;
        surface(k).origin = rays.origin, surface(k).direction = rays.direction;
    }
};

/// `sums` of trace_tangents_to_scene: the crossings of each surface. Contributions are not used.
struct CrossingRecord {
    const TangentPath& path;
    std::vector<TangentPath::Crossing>& crossings;
    std::vector<Dual8> form_sums;
    AdjointStep<kLanes> unused{};
    Lanes<double, kLanes> unused_pose{};

    AdjointStep<kLanes>& surface(int) { return unused; }
    AdjointStep<kLanes>& film() { return unused; }
    FreeformTangents forms(int k) { return path.forms(k, form_sums.data()); }
    Lanes<double, kLanes>& pose(int) { return unused_pose; }
    void finish(int k, const TangentPath::Rays& rays) {
        if (k == kStartOnFilm) return;
        crossings[static_cast<std::size_t>(k)] = {rays.origin, rays.direction, rays.tangents[0].origin};
    }
};

/// trace_tangents_to_scene with the wavelengths of TangentPath::trace.
template <int M, class Sums>
inline void trace_all(const TangentLens& lens, const WavelengthsInDouble* wavelengths, TangentRays<kLanes, M>& rays,
                      const int* starts, const Vec3d* rim_tangents, Sums& sums) {
    if (wavelengths)
        trace_tangents_to_scene(
            lens, [&](int k) { return WavelengthsInDouble{wavelengths->surfaces + k, wavelengths->variable}; }, rays,
            starts, rim_tangents, sums);
    else
        trace_tangents_to_scene(lens, [](int) { return OneWavelength{}; }, rays, starts, rim_tangents, sums);
}

}  // namespace

// target_clones compiles only inlined code for each instruction set, hence `flatten`.
__attribute__((flatten)) REALCAM_CLONES void TangentPath::trace(Rays& rays, Sums& sums, const int* starts,
                                                                const Vec3d* rim_tangents,
                                                                const WavelengthsInDouble* wavelengths) const {
    AllSums all{*this, sums};
    trace_all(view(), wavelengths, rays, starts, rim_tangents, all);
}

__attribute__((flatten)) REALCAM_CLONES void TangentPath::trace(TangentRays<kLanes, 2>& rays, Sums& sums,
                                                                const int* starts, const Vec3d* rim_tangents,
                                                                const WavelengthsInDouble* wavelengths) const {
    AllSums all{*this, sums};
    trace_all(view(), wavelengths, rays, starts, rim_tangents, all);
}

__attribute__((flatten)) REALCAM_CLONES void TangentPath::record(Rays& rays, std::vector<Crossing>& crossings,
                                                                 const WavelengthsInDouble* wavelengths) const {
    crossings.resize(surfaces_.size());
    std::size_t most = 0;
    for (const auto& duals : duals_) most = std::max(most, duals.size());
    CrossingRecord record{*this, crossings, std::vector<Dual8>(freeforms_.empty() ? 0 : kLanes * most)};
    trace_all(view(), wavelengths, rays, nullptr, nullptr, record);
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

std::vector<std::uint32_t> TangentPath::numbers_in_use() const {
    std::vector<std::uint32_t> numbers(surfaces_.size());
    for (std::size_t k = 0; k < surfaces_.size(); ++k)
        for (int number = 0; number < kSurfaceNumbers; ++number) {
            double unit[kSurfaceNumbers] = {};
            unit[number] = 1;
            for (std::size_t v = 0; v < variables_.size(); ++v)
                if (sum_of_surface(unit, duals_[k][v / kDualLanes + 1], v % kDualLanes) != 0)
                    numbers[k] |= 1u << number;
        }
    return numbers;
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
