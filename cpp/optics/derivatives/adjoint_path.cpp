#include "adjoint_path.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "../trace/trace_request.hpp"

namespace realcam {

namespace {

/// Returns the frame change without derivatives.
FrameChange<double> value(const DualFrame& frame) {
    return {value(frame.origin), value(frame.x), value(frame.y), value(frame.z), frame.changes};
}

}  // namespace

FreeformSags<Dual8, 1> dual_sags(const DualSurface& surface, const Lanes<Dual8, 1>& x, const Lanes<Dual8, 1>& y) {
    FreeformSags<Dual8, 1> sags;
    freeform_sags<Dual8, 1>(surface.form.front(), x, y, sags);
    return sags;
}

AdjointPath::AdjointPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                         std::vector<LensVariable> variables)
    : path_(lens, direction, wavelength_nm, std::move(variables), ExitFrame::lens) {}

std::vector<double> AdjointPath::gradient(const AdjointRequest& request, const RayLoop& loop) const {
    // Partial sums over blocks of fixed size, added in order, make the result independent of the number of threads.
    constexpr std::size_t kRaysPerPart = 1024;
    const std::size_t width = path_.variable_count(), parts = (request.count + kRaysPerPart - 1) / kRaysPerPart;
    std::vector<double> sums(width * parts), gradient(width);
    loop.for_all(parts, [&](std::size_t first, std::size_t last) {
        for (std::size_t part = first; part < last; ++part) {
            Sums part_sums;
            add_rays(request, kRaysPerPart * part, std::min(request.count, kRaysPerPart * (part + 1)), part_sums);
            add_variables(part_sums, sums.data() + width * part);
        }
    });
    for (std::size_t i = 0; i < sums.size(); ++i) gradient[i % width] += sums[i];
    return gradient;
}

void AdjointPath::add_rays(const AdjointRequest& request, std::size_t first, std::size_t last, Sums& sums) const {
    const std::size_t count = path_.views_.size();
    sums.steps.resize(count + 1);
    sums.forms.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::vector<DualSurface>& duals = path_.duals_[k];
        const DualSurface& shape = duals.front();
        AdjointSurface& surface = sums.surfaces.emplace_back();
        surface.view = path_.views_[k];
        surface.view.kind = shape.view.kind;
        surface.view.inverse_search_squared = shape.view.inverse_search_squared.value;
        surface.before = value(shape.before);
        if (shape.before.changes) surface.view.shift = 0;
        sums.forms[k].resize(shape.form.empty() ? 0 : duals.size());
        surface.duals = duals.data();
        surface.dual_count = static_cast<int>(duals.size());
        surface.form_sums = sums.forms[k].data();
    }
    for (std::size_t ray = first; ray < last; ray += kLanes)
        add_block(request, ray, static_cast<int>(std::min<std::size_t>(kLanes, last - ray)), sums);
}

// target_clones compiles only inlined code for each instruction set, hence `flatten`.
__attribute__((flatten)) REALCAM_CLONES void AdjointPath::add_block(const AdjointRequest& request, std::size_t first,
                                                                    int used, Sums& sums) const {
    const auto data = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    const auto vector = [](const double* numbers, std::size_t i) {
        return Vec3d{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    };
    const auto write = [](double* numbers, std::size_t i, Vec3d v) {
        numbers[3 * i] = v.x, numbers[3 * i + 1] = v.y, numbers[3 * i + 2] = v.z;
    };
    AdjointStep<kLanes>* const steps = sums.steps.data();
    const double index = path_.entry_index_;
    const std::size_t count = path_.views_.size();

    // Forward pass: trace and record the rays.
    LensRays<double, kLanes> rays;
    Vec3d from[kLanes];
    double path_to_entry[kLanes] = {};
    for (int i = 0; i < kLanes; ++i) {
        const std::size_t ray = first + static_cast<std::size_t>(i < used ? i : 0);
        from[i] = vector(request.origins, ray) - Vec3d{0, 0, path_.entry_position_};
        const LensEntry entry = enter_lens(from[i], vector(request.directions, ray), index, path_.entry_reach_);
        rays.origin.set(i, entry.origin);
        rays.direction.set(i, entry.direction);
        rays.status[i] = static_cast<int>(i < used ? entry.status : RayStatus::bad_input);
        path_to_entry[i] = entry.optical_path;
    }
    steps[0].origin = rays.origin, steps[0].direction = rays.direction;
    const AsymmetricParts<double> free{data(path_.frames_), data(path_.freeforms_), data(path_.apertures_)};
    LensView<double> one_surface{nullptr, 1, path_.kind_, path_.iris_};
    for (std::size_t k = 0; k < count; ++k) {
        one_surface.surfaces = &path_.views_[k];
        one_surface.free = free.from(static_cast<int>(k));
        trace_lens(one_surface, rays);
        steps[k + 1].origin = rays.origin, steps[k + 1].direction = rays.direction;
    }

    // Lanes of rays that have ended are filled with a ray that passes, with adjoints of 0.
    int passing = 0;
    while (passing < kLanes && rays.status[passing] != 0) ++passing;
    for (int i = 0; i < used; ++i)
        if (rays.status[i] != 0) {
            write(request.by_origins, first + static_cast<std::size_t>(i), {0, 0, 0});
            write(request.by_directions, first + static_cast<std::size_t>(i), {0, 0, 0});
        }
    if (passing == kLanes) return;
    for (int i = 0; i < kLanes; ++i)
        for (std::size_t k = 0; k <= count && rays.status[i] != 0; ++k) {
            steps[k].origin.set(i, steps[k].origin[passing]);
            steps[k].direction.set(i, steps[k].direction[passing]);
        }

    // Reverse pass: adjoints from the last surface to the first.
    RayAdjoints<kLanes> adjoints;
    const Affine<Dual8>& exit = path_.exits_.front();
    const Vec3d axes[3] = {value(exit.x), value(exit.y), value(exit.z)};
    for (int i = 0; i < kLanes; ++i) {
        adjoints.origin.set(i, {0, 0, 0});
        adjoints.direction.set(i, {0, 0, 0});
        adjoints.path[i] = 0;
        if (rays.status[i] != 0) continue;
        const std::size_t ray = first + static_cast<std::size_t>(i);
        const Vec3d o = steps[count].origin[i], p = steps[count].direction[i];
        const Vec3d of_o = vector(request.of_origins, ray), of_unit = vector(request.of_directions, ray);
        const double inverse = 1 / length(p);
        const Vec3d unit = inverse * (p.x * axes[0] + p.y * axes[1] + p.z * axes[2]);
        // The exit direction is normalised: only the part of its adjoint perpendicular to it has an effect.
        const Vec3d of_p = inverse * (of_unit - dot(of_unit, unit) * unit);
        adjoints.origin.set(i, {dot(axes[0], of_o), dot(axes[1], of_o), dot(axes[2], of_o)});
        adjoints.direction.set(i, {dot(axes[0], of_p), dot(axes[1], of_p), dot(axes[2], of_p)});
        adjoints.path[i] = request.of_paths[ray];
        const Vec3d of_frame[4] = {of_o, o.x * of_o + p.x * of_p, o.y * of_o + p.y * of_p, o.z * of_o + p.z * of_p};
        for (int part = 0; part < 4; ++part) sums.exit[part] += of_frame[part];
    }
    for (std::size_t k = count; k-- > 0;) pull_back_surface(sums.surfaces[k], steps[k], steps[k + 1], adjoints);
    for (int i = 0; i < used; ++i) {
        if (rays.status[i] != 0) continue;
        const std::size_t ray = first + static_cast<std::size_t>(i);
        const Vec3d direction = vector(request.directions, ray), p = steps[0].direction[i];
        const Vec3d of_o = adjoints.origin[i], of_p = adjoints.direction[i];
        const double size = length(direction), of_path = request.of_paths[ray];
        const Vec3d unit = (1 / size) * direction;
        const double distance =
            dot(steps[0].origin[i] - from[i], unit) / size;  // to the start of the trace, in lengths of `direction`
        // The given direction determines the optical direction, index * unit, and the point at which the trace starts,
        // from[i] + distance * direction.
        write(request.by_origins, ray, of_o);
        write(request.by_directions, ray,
              (index / size) * (of_p - dot(of_p, unit) * unit) + distance * of_o + index * distance * of_path * unit);
        sums.entry_position -= of_o.z;
        sums.entry_index += (dot(of_p, p) + of_path * path_to_entry[i]) / index;
    }
}

void AdjointPath::add_variables(const Sums& sums, double* by) const {
    for (std::size_t k = 0; k < path_.duals_.size(); ++k) {
        double adjoints[kSurfaceNumbers];
        for (int number = 0; number < kSurfaceNumbers; ++number) {
            const auto& lanes = sums.steps[k + 1].sums[number];
            adjoints[number] = std::accumulate(lanes, lanes + kLanes, 0.0);
        }
        for (std::size_t d = 0; d < path_.duals_[k].size(); ++d) {
            const DualSurface& surface = path_.duals_[k][d];
            for (std::size_t lane = 0; lane < kDualLanes; ++lane) {
                if (surface.variables[lane] < 0) continue;
                double& derivative = by[surface.variables[lane]];
                derivative += sum_of_surface(adjoints, surface, lane);
                if (!surface.form.empty()) derivative += sums.forms[k][d].by[lane];
            }
        }
    }
    for (std::size_t v = 0; v < path_.variable_count(); ++v) {
        const std::size_t block = v / kDualLanes, lane = v % kDualLanes;
        by[v] += sum_of_frame(sums.exit, path_.exits_[block], lane) +
                 sums.entry_position * path_.entry_positions_[block].by[lane] +
                 sums.entry_index * path_.entry_indices_[block].by[lane];
    }
}

}  // namespace realcam
