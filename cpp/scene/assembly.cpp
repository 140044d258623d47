#include "assembly.hpp"

#include <cmath>
#include <utility>

namespace realcam {

void Instance::put(const AnimatedTransform& placement) {
    scene_from_object = placement.scene_from_object;
    motion = placement.motion;
}

bool Assembly::has_light() const {
    if (static_geometry->has_light()) return true;
    for (const Instance& instance : instances)
        if (instance.object->has_local_light()) return true;
    return false;
}

std::size_t Assembly::triangle_count() const {
    std::size_t count = static_geometry->triangles.size();
    for (const Instance& instance : instances) count += instance.object->triangles.size();
    return count;
}

bool same_parts(const Assembly& a, const Assembly& b) {
    if (a.static_geometry != b.static_geometry || a.instances.size() != b.instances.size()) return false;
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].object != b.instances[i].object) return false;
    return true;
}

bool same_placement(const Instance& a, const Instance& b) {
    const bool same_motion = a.motion == b.motion || (a.motion && b.motion && *a.motion == *b.motion);
    return a.scene_from_object == b.scene_from_object && same_motion;
}

bool same_transforms(const Assembly& a, const Assembly& b) {
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (!same_placement(a.instances[i], b.instances[i])) return false;
    return true;
}

std::string label(const Assembly& assembly, std::size_t instance) {
    const std::string& name = assembly.instances[instance].name;
    return "instance " + std::to_string(instance) + (name.empty() ? "" : " (\"" + name + "\")");
}

std::string transform_error(const Affine<double>& map) {
    // Well within float's range, and beyond any real scene.
    constexpr double kFarthest_m = 1e12, kMost = 1e6, kLeast = 1e-6;
    // Least determinant relative to that of orthogonal axes of the same lengths; below it the inverse loses too many
    // digits.
    constexpr double kLeastVolume = 1e-4;
    const auto within = [](double v) { return v >= kLeast && v <= kMost; };
    const double x = length(map.x), y = length(map.y), z = length(map.z);
    if (x == 0 || y == 0 || z == 0) return "a transform must keep three directions; this one makes the object flat";
    if (!within(x) || !within(y) || !within(z) || !(length(map.origin) <= kFarthest_m))
        return "a transform must be finite and scale each axis by 1e-6 to 1e6, to within 1e12 m";
    if (!(std::fabs(map.determinant()) > kLeastVolume * x * y * z))
        return "a transform must keep three directions; this one makes the object flat";
    return "";
}

std::string motion_error(const Motion& motion) {
    const std::size_t keys = motion.times_s.size();
    if (keys == 0 || keys != motion.transforms.size())
        return "a motion wants as many transforms as times, one at least";
    for (std::size_t k = 0; k < keys; ++k) {
        const std::string key = "key " + std::to_string(k) + " of its motion: ";
        const std::string time = key_time_error(motion.times_s[k], k > 0 ? &motion.times_s[k - 1] : nullptr);
        if (!time.empty()) return key + time;
        if (const std::string why = transform_error(motion.transforms[k]); !why.empty()) return key + why;
        if ((motion.transforms[0].determinant() < 0) != (motion.transforms[k].determinant() < 0))
            return key + "all keys must mirror the object, or none; between them it would be flat";
    }
    return "";
}

void validate_transforms(const Assembly& assembly) {
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
        const Instance& instance = assembly.instances[i];
        const std::string why =
            instance.motion ? motion_error(*instance.motion) : transform_error(instance.scene_from_object);
        if (!why.empty()) throw InputError(label(assembly, i) + ": " + why);
    }
}

void validate(const Assembly& assembly) {
    if (!assembly.static_geometry || assembly.triangle_count() == 0)
        throw InputError("the scene is empty; expected at least one triangle");
    constexpr std::size_t kMostInstances = std::size_t{1} << 28;
    if (assembly.instances.size() > kMostInstances)
        throw InputError("a scene holds at most " + std::to_string(kMostInstances) + " instances");
    validate_transforms(assembly);
}

Assembly standing_at(Assembly assembly, double time_s) {
    for (Instance& instance : assembly.instances) {
        instance.scene_from_object = instance.transform_at(time_s);
        instance.motion = nullptr;
    }
    return assembly;
}

namespace {

/// Transform of a part relative to the instance it belongs to.
Affine<double> whole_from_part(const Affine<double>& scene_from_whole, const Affine<double>& scene_from_part) {
    const InverseAffine<double> back = scene_from_whole.inverse();
    return {back.direction(scene_from_part.x), back.direction(scene_from_part.y), back.direction(scene_from_part.z),
            back.point(scene_from_part.origin)};
}

}  // namespace

bool are_close(const Affine<double>& a, const Affine<double>& b) {
    constexpr double kRoundings = 1e-9;
    const double size = length(a.x) + length(a.y) + length(a.z);
    return length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z) <= kRoundings * size &&
           length(a.origin - b.origin) <= kRoundings * (size + length(a.origin));
}

std::vector<double> all_times(std::initializer_list<const Motion*> motions) {
    std::vector<double> times;
    for (const Motion* motion : motions)
        if (motion) times.insert(times.end(), motion->times_s.begin(), motion->times_s.end());
    return sorted_once(std::move(times));
}

void move(Assembly& assembly, std::size_t instance, const AnimatedTransform& placement) {
    const Instance whole = assembly.instances[instance];
    std::vector<bool> moves(assembly.instances.size(), false);
    moves[instance] = true;
    for (std::size_t i = instance + 1; i < assembly.instances.size(); ++i) {
        Instance& part = assembly.instances[i];
        if (part.part_of == Instance::kNoWhole || !moves[static_cast<std::size_t>(part.part_of)]) continue;
        moves[i] = true;
        const auto within = [&](double time) {
            return whole_from_part(whole.transform_at(time), part.transform_at(time));
        };
        // A part that is rigidly attached to its whole has no keys of its own to preserve.
        const std::vector<double> own = all_times({whole.motion.get(), part.motion.get()});
        const Affine<double> first = within(own.empty() ? 0.0 : own.front());
        const bool is_fixed =
            std::all_of(own.begin(), own.end(), [&](double time) { return are_close(within(time), first); });
        const std::vector<double> times =
            is_fixed ? all_times({placement.motion.get()})
                     : all_times({placement.motion.get(), whole.motion.get(), part.motion.get()});
        part.put(animated_transform(
            times, [&](double time) { return placement.at(time) * (is_fixed ? first : within(time)); }));
    }
    assembly.instances[instance].put(placement);
}

std::string DistinctNames::take(const std::string& name) {
    if (name.empty() || taken_.insert(name).second) return name;
    // Counts on from the last number, because a file may hold a name a million times.
    int& number = numbers_.try_emplace(name, 1).first->second;
    std::string free;
    do free = name + '.' + std::to_string(++number);
    while (!taken_.insert(free).second);
    return free;
}

void make_names_distinct(Assembly& assembly) {
    DistinctNames names;
    for (Instance& instance : assembly.instances) instance.name = names.take(instance.name);
}

void add(Assembly& assembly, const Assembly& object, const AnimatedTransform& placement, const std::string& name,
         DistinctNames& names) {
    const std::vector<Instance> parts = object.instances;  // a copy, because the object may be the assembly itself
    const std::string own = names.take(name);
    std::ptrdiff_t whole = Instance::kNoWhole;
    if (!object.static_geometry->triangles.empty() || !object.static_geometry->points.empty()) {
        whole = std::ssize(assembly.instances);
        assembly.instances.push_back({object.static_geometry, placement.scene_from_object, own});
        assembly.instances.back().motion = placement.motion;
    }
    const std::ptrdiff_t first = std::ssize(assembly.instances);
    for (const Instance& part : parts) {
        Instance placed = part;
        placed.put(animated_transform(all_times({placement.motion.get(), part.motion.get()}),
                                      [&](double time) { return placement.at(time) * part.transform_at(time); }));
        placed.name = names.take(own + (own.empty() || part.name.empty() ? "" : "/") + part.name);
        placed.part_of = part.part_of == Instance::kNoWhole ? whole : first + part.part_of;
        assembly.instances.push_back(std::move(placed));
    }
}

}  // namespace realcam
