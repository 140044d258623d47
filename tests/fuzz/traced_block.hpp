#pragma once
// A block of fuzz rays through a lens, as the backends trace it, and surface by surface.

#include "embree/kernels.hpp"
#include "optics/trace/lens_path.hpp"
#include "optics/trace/trace_request.hpp"
#include "surface_laws.hpp"

namespace realcam::fuzz {

inline constexpr int kRays = 256;

struct RayBlock {
    Vec3d origin[kRays], direction[kRays];  ///< lens frame
};

struct BlockResult {
    Vec3d origin[kRays], direction[kRays];
    double path[kRays];
    int status[kRays], surface_index[kRays];
};

/// The kernels' function of a number type.
inline auto recorded(const realcam_kernels& kernels, double) {
    return kernels.trace_f64;
}
inline auto recorded(const realcam_kernels& kernels, float) {
    return kernels.trace_f32;
}

/// A trace with its record, by the kernels of one instruction set.
struct KernelTrace {
    double entry_position, exit_position, entry_index, entry_reach;

    template <class T>
    void operator()(const realcam_kernels& kernels, const LensView<T>& view, const RayBlock& rays,
                    BlockResult& out) const {
        const TraceRequest<T> request{
            view,     entry_position,    exit_position,        entry_index,      entry_reach,
            kRays,    &rays.origin[0].x, &rays.direction[0].x, &out.origin[0].x, &out.direction[0].x,
            out.path, out.status,        out.surface_index};
        recorded(kernels, T())(&request);
    }
};

/// Enters rays into the lens as the backends do. Writes through memory: gcc 12 takes (double)(float)x of two adjacent
/// values for x.
template <class T>
__attribute__((noinline)) void enter(const RayBlock& rays, const KernelTrace& trace, LensRays<T, kRays>& out) {
    for (int i = 0; i < kRays; ++i) {
        Vec3d o = rays.origin[i];
        o.z -= trace.entry_position;
        const LensEntry entry = enter_lens(o, rays.direction[i], trace.entry_index, trace.entry_reach);
        out.origin.set(i, static_cast<Vec3<T>>(entry.origin));
        out.direction.set(i, static_cast<Vec3<T>>(entry.direction));
        out.status[i] = static_cast<int>(entry.status);
    }
}

/// True if ray i of a block, in which other rays may need more iterations, ends exactly as if traced alone, as on a
/// GPU.
template <class T>
bool same_alone(const LensPath<T>& path, const LensRays<T, kRays>& start, const LensRays<T, kRays>& end, int i) {
    LensRays<T, 1> ray;
    PathRecord<T, 1> record{};
    ray.origin.set(0, start.origin[i]);
    ray.direction.set(0, start.direction[i]);
    ray.status[0] = start.status[i];
    trace_lens(path.view(), ray, record);
    return ray.status[0] == end.status[i] && length(ray.origin[0] - end.origin[i]) == 0 &&
           length(ray.direction[0] - end.direction[i]) == 0;
}

/// Traces a block surface by surface and checks the laws at each. The numbers between surfaces are those of a whole
/// trace.
template <class T>
void check_surfaces(const LensPath<T>& path, LensRays<T, kRays>& rays) {
    const LensView<T> lens = path.view();
    LensRays<T, kRays> before;
    PathRecord<T, kRays> record;
    for (int k = 0; k < lens.count; ++k) {
        const SurfaceLaws<T> laws(lens.surfaces[k], lens.iris);
        before = rays;
        int alive = 0;
        for (int i = 0; i < kRays; ++i) {
            record.optical_path[i] = 0;
            alive += rays.status[i] == 0;
        }
        if (alive == 0) return;
        trace_lens(LensView<T>{lens.surfaces + k, 1, LensKind::rotational, lens.iris}, rays, record);
        for (int i = 0; i < kRays; ++i) {
            if (before.status[i] != 0) continue;
            Vec3<T> o = before.origin[i];
            o.z -= lens.surfaces[k].shift;
            laws.check({static_cast<Vec3d>(o), static_cast<Vec3d>(before.direction[i]),
                        static_cast<Vec3d>(rays.origin[i]), static_cast<Vec3d>(rays.direction[i]),
                        static_cast<double>(record.optical_path[i]), static_cast<RayStatus>(rays.status[i])});
        }
    }
}

/// check_surfaces with the kernels, which trace each surface as a separate lens and return unit directions.
template <class T>
void check_surfaces(const realcam_kernels& kernels, const LensPath<T>& path, const LensRays<T, kRays>& start) {
    const LensView<T> lens = path.view();
    RayBlock rays;
    BlockResult out;
    LensRays<T, kRays> before;
    bool ended[kRays];
    for (int i = 0; i < kRays; ++i) {
        rays.origin[i] = static_cast<Vec3d>(start.origin[i]);
        rays.direction[i] = static_cast<Vec3d>(start.direction[i]);
        ended[i] = start.status[i] != 0;
    }
    double index = path.entry_index;
    for (int k = 0; k < lens.count; ++k) {
        const SurfaceView<T>& step = lens.surfaces[k];
        const SurfaceLaws<T> laws(step, lens.iris);
        const KernelTrace trace{0, 0, index, std::numeric_limits<double>::infinity()};
        enter(rays, trace, before);
        trace(kernels, LensView<T>{&step, 1, LensKind::rotational, lens.iris}, rays, out);
        int alive = 0;
        for (int i = 0; i < kRays; ++i) {
            ended[i] |= before.status[i] != 0;  // by now too far away to be taken in
            if (ended[i]) continue;
            Vec3<T> o = before.origin[i];
            o.z -= step.shift;
            const Vec3d along = static_cast<Vec3d>(before.direction[i]);
            const bool passed = out.status[i] == 0;
            const double size =
                length(along) * (passed ? std::sqrt(1 + static_cast<double>(step.squared_index_change)) : 1);
            laws.check({static_cast<Vec3d>(o), along, out.origin[i], size * out.direction[i], out.path[i],
                        static_cast<RayStatus>(out.status[i])});
            ended[i] = !passed;
            alive += passed;
            rays.origin[i] = out.origin[i];
            rays.direction[i] = out.direction[i];
        }
        if (alive == 0) return;
        index *= std::sqrt(1 + static_cast<double>(step.squared_index_change));
    }
}

}  // namespace realcam::fuzz
