// Fuzz target: any lens that validate() accepts, any rays, both directions, both number types, with and without a
// record. Every ray ends in a status and with finite numbers; at each surface it obeys the laws of surface_laws.hpp.

#include <cstring>

#include "draw_lens.hpp"
#include "draw_rays.hpp"
#include "target.hpp"
#include "traced_block.hpp"

namespace realcam::fuzz {
namespace {

const char* name_of(float) {
    return "float32";
}
const char* name_of(double) {
    return "float64";
}

bool finite(Vec3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// By the words of trace_rays, not by the code of enter_lens.
bool is_bad(Vec3d origin, Vec3d direction, double entry_position) {
    origin.z -= entry_position;
    if (!finite(origin) || !finite(direction)) return true;
    if (direction.x == 0 && direction.y == 0 && direction.z == 0) return true;
    for (const double v : {origin.x, origin.y, origin.z})
        if (v > kFarthestOrigin || v < -kFarthestOrigin) return true;
    return false;
}

struct Case {
    const LensSystem& lens;
    LightDirection way;
    const RayBlock& rays;
    const realcam_kernels& kernels;
    bool valid;  ///< false for a lens that cannot be built; then the trace only has to end
};

template <class T>
void say(const char* what, const Case& test, const BlockResult& out, int i, double value) {
    const Vec3d o = test.rays.origin[i], d = test.rays.direction[i], a = out.origin[i], b = out.direction[i];
    report(what,
           "%s %s, %zu surfaces, %s; o (%.17g %.17g %.17g), d (%.17g %.17g %.17g) -> (%.9g %.9g %.9g), (%.9g %.9g "
           "%.9g), path %.9g, status %d, surface %d: %.9g",
           name_of(T()), test.kernels.instruction_set, test.lens.surfaces.size(),
           test.way == LightDirection::to_film ? "to film" : "to scene", o.x, o.y, o.z, d.x, d.y, d.z, a.x, a.y, a.z,
           b.x, b.y, b.z, out.path[i], out.status[i], out.surface_index[i], value);
}

template <class T>
void check_results(const Case& test, const LensPath<T>& path, const BlockResult& out) {
    const int surfaces = static_cast<int>(test.lens.surfaces.size());
    for (int i = 0; i < kRays; ++i) {
        const int status = out.status[i];
        findings().passed += status == 0;
        if (status < 0 || status > static_cast<int>(RayStatus::bad_input)) say<T>("no status", test, out, i, status);
        const bool bad = is_bad(test.rays.origin[i], test.rays.direction[i], path.entry_position);
        if (bad != (status == static_cast<int>(RayStatus::bad_input)))
            say<T>("bad input is not told", test, out, i, bad);
        const int last = test.way == LightDirection::to_film ? surfaces - 1 : 0;
        const int index = out.surface_index[i];
        if (index < (bad ? -1 : 0) || index >= surfaces || (status == 0 && index != last))
            say<T>("a ray ends at no surface", test, out, i, index);
        if (!finite(out.origin[i]) || !finite(out.direction[i]) || !std::isfinite(out.path[i]))
            say<T>("a number is not finite", test, out, i, 0);
        // The backends make it a unit vector in double.
        const double size = length(out.direction[i]);
        if (!(bad ? size == 0 : std::fabs(size - 1) < 1e-15 * 4))
            say<T>("a direction is not a unit vector", test, out, i, size - 1);
    }
}

/// Without a record a ray passes exactly where it passes with one, and leaves with the same numbers.
template <class T>
void check_no_record(const Case& test, const LensPath<T>& path, const BlockResult& out,
                     const LensRays<T, kRays>& no_record) {
    for (int i = 0; i < kRays; ++i) {
        const bool passed = no_record.status[i] == 0;
        Vec3d from = test.rays.origin[i];
        from.z -= path.entry_position;
        // Farther origins are first moved near the lens, which each instruction set rounds differently.
        if (!(length(from) <= path.entry_reach)) continue;
        if (passed != (out.status[i] == 0)) {
            say<T>("a record changes whether a ray passes", test, out, i, no_record.status[i]);
        } else if (passed) {
            Vec3d o = static_cast<Vec3d>(no_record.origin[i]), d = static_cast<Vec3d>(no_record.direction[i]);
            o.z += path.exit_position;
            d = (1 / length(d)) * d;
            const double moved = length(o - out.origin[i]), turned = length(d - out.direction[i]);
            // Fused products are fused as the compiler sees fit.
            const double same = test.kernels.instruction_set == std::string("x86-64-v2") ? 0 : 1e-4;
            if (!(moved <= same * (length(o) + std::sqrt(static_cast<double>(path.view().surfaces[0].rim_squared)))))
                say<T>("a record moves a ray", test, out, i, moved);
            if (!(turned <= same)) say<T>("a record turns a ray", test, out, i, turned);
        }
    }
}

/// Uses the kernels of the same instruction set, because each instruction set rounds differently.
void trace_without_record(const Case& test, const LensPath<float>& path, LensRays<float, kRays>& rays, BlockResult&) {
    const LensView<float> view = path.view();
    test.kernels.trace_block(&view, &rays);
}
void trace_without_record(const Case& test, const LensPath<double>& path, LensRays<double, kRays>& rays,
                          BlockResult& out) {
    const LensRays<double, kRays> start = rays;
    LensRays<double, kRays> recorded = rays;
    PathRecord<double, kRays> record{};
    trace_lens(path.view(), recorded, record);
    trace_lens(path.view(), rays);
    for (int i = 0; i < kRays; ++i) {
        out.origin[i] = recorded.origin[i];
        out.origin[i].z += path.exit_position;
        out.direction[i] = (1 / length(recorded.direction[i])) * recorded.direction[i];
        out.status[i] = recorded.status[i];
        if (i % 32 == 0 && start.status[i] == 0 && !same_alone(path, start, recorded, i))
            say<double>("a ray ends otherwise when it is alone", test, out, i, 0);
    }
}

template <class T>
void check_trace(const Case& test, bool by_kernels) {
    const LensPath<T> path(test.lens, test.way, test.lens.wavelength_nm);
    BlockResult out;
    LensRays<T, kRays> rays;
    const KernelTrace trace{path.entry_position, path.exit_position, path.entry_index, path.entry_reach};
    trace(test.kernels, path.view(), test.rays, out);
    findings().rays += kRays;
    if (!test.valid) return;
    check_results(test, path, out);
    enter(test.rays, trace, rays);
    trace_without_record(test, path, rays, out);
    check_no_record(test, path, out, rays);
    enter(test.rays, trace, rays);
    if (by_kernels) {
        check_surfaces(test.kernels, path, rays);
    } else {
        check_surfaces(path, rays);
    }
}

bool passes_validation(const LensSystem& lens) {
    try {
        validate(lens);
        return true;
    } catch (const LensFileError&) {
        return false;
    }
}

/// True if the lens meets LensPath's preconditions.
bool can_be_traced(const LensSystem& lens) {
    try {
        lens.indices(lens.wavelength_nm);
        return lens.stop_index() >= 0;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

int fuzz_lens_trace(const std::uint8_t* data, std::size_t size) {
    static const std::vector<const realcam_kernels*> kernels = available_kernels();
    Bytes in(data, size);
    const LensSystem lens = draw_lens(in);
    const bool valid = passes_validation(lens);
    if (!valid && !can_be_traced(lens)) return 0;
    const realcam_kernels& chosen = *kernels[static_cast<std::size_t>(in.below(static_cast<int>(kernels.size())))];
    const bool by_kernels = in.chance(128);
    RayBlock rays;
    for (const LightDirection way : {LightDirection::to_film, LightDirection::to_scene}) {
        const LensPath<double> path(lens, way, lens.wavelength_nm);
        RayDrawer draw(in, lens, path);
        for (int i = 0; i < kRays; ++i) {
            const DrawnRay ray = draw();
            rays.origin[i] = ray.origin;
            rays.direction[i] = ray.direction;
        }
        const Case test{lens, way, rays, chosen, valid};
        check_trace<double>(test, by_kernels);
        check_trace<float>(test, by_kernels);
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_lens_trace)
