#include "assembly.hpp"

#include <cmath>
#include <utility>

namespace realcam {

void Instance::set_transform(const AnimatedTransform& transform) {
    scene_from_object = transform.scene_from_object;
    motion = transform.motion;
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

bool same_transform(const Instance& a, const Instance& b) {
    const bool same_motion = a.motion == b.motion || (a.motion && b.motion && *a.motion == *b.motion);
    return a.scene_from_object == b.scene_from_object && same_motion;
}

bool same_transforms(const Assembly& a, const Assembly& b) {
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (!same_transform(a.instances[i], b.instances[i])) return false;
    return true;
}

std::string label(const Assembly& assembly, std::size_t instance) {
    const std::string& name = assembly.instances[instance].name;
    return "instance " + std::to_string(instance) + (name.empty() ? "" : " (\"" + name + "\")");
}

std::string transform_error(const Affine<double>& map) {
    // Well within float's range, and beyond any real scene.
    constexpr double kMaxDistance_m = 1e12, kMaxScale = 1e6, kMinScale = 1e-6;
    // Least determinant relative to that of orthogonal axes of the same lengths; below it the inverse loses too many
    // digits.
    constexpr double kMinVolume = 1e-4;
    const auto is_valid_scale = [](double v) { return v >= kMinScale && v <= kMaxScale; };
    const double x = length(map.x), y = length(map.y), z = length(map.z);
    if (x == 0 || y == 0 || z == 0) return "a transform must keep three directions; this one makes the object flat";
    if (!is_valid_scale(x) || !is_valid_scale(y) || !is_valid_scale(z) || !(length(map.origin) <= kMaxDistance_m))
        return "a transform must be finite and scale each axis by 1e-6 to 1e6, to within 1e12 m";
    if (!(std::fabs(map.determinant()) > kMinVolume * x * y * z))
        return "a transform must keep three directions; this one makes the object flat";
    return "";
}

std::string motion_error(const Motion& motion) {
    const std::size_t keys = motion.times_s.size();
    if (keys == 0 || keys != motion.transforms.size())
        return "a motion must have as many transforms as times, at least one";
    for (std::size_t k = 0; k < keys; ++k) {
        const std::string key = "key " + std::to_string(k) + " of its motion: ";
        const std::string time = key_time_error(motion.times_s[k], k > 0 ? &motion.times_s[k - 1] : nullptr);
        if (!time.empty()) return key + time;
        if (const std::string why = transform_error(motion.transforms[k]); !why.empty()) return key + why;
        if ((motion.transforms[0].determinant() < 0) != (motion.transforms[k].determinant() < 0))
            return key + "all keys must mirror the object, or none of them; otherwise it would be flat in between";
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
    constexpr std::size_t kMaxInstances = std::size_t{1} << 28;
    if (assembly.instances.size() > kMaxInstances)
        throw InputError("a scene holds at most " + std::to_string(kMaxInstances) + " instances");
    validate_transforms(assembly);
}

Assembly frozen_at(Assembly assembly, double time_s) {
    Shapes shapes;
    assembly = with_shapes_at(std::move(assembly), time_s, shapes);
    for (Instance& instance : assembly.instances) {
        instance.scene_from_object = instance.transform_at(time_s);
        instance.motion = nullptr;
    }
    return assembly;
}

namespace {

/// Returns the transform of a part relative to its parent instance.
Affine<double> parent_from_part(const Affine<double>& scene_from_parent, const Affine<double>& scene_from_part) {
    const InverseAffine<double> parent_from_scene = scene_from_parent.inverse();
    return {parent_from_scene.direction(scene_from_part.x), parent_from_scene.direction(scene_from_part.y),
            parent_from_scene.direction(scene_from_part.z), parent_from_scene.point(scene_from_part.origin)};
}

}  // namespace

bool are_close(const Affine<double>& a, const Affine<double>& b) {
    constexpr double kRoundings = 1e-9;  // relative
    const double size = length(a.x) + length(a.y) + length(a.z);
    return length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z) <= kRoundings * size &&
           length(a.origin - b.origin) <= kRoundings * (size + length(a.origin));
}

std::vector<double> all_times(std::initializer_list<const Motion*> motions) {
    std::vector<double> times;
    for (const Motion* motion : motions)
        if (motion) times.insert(times.end(), motion->times_s.begin(), motion->times_s.end());
    return sorted_unique(std::move(times));
}

void move(Assembly& assembly, std::size_t instance, const AnimatedTransform& transform) {
    const Instance parent = assembly.instances[instance];
    std::vector<bool> moves(assembly.instances.size(), false);
    moves[instance] = true;
    for (std::size_t i = instance + 1; i < assembly.instances.size(); ++i) {
        Instance& part = assembly.instances[i];
        if (part.part_of == Instance::kNoParentInstance || !moves[static_cast<std::size_t>(part.part_of)]) continue;
        moves[i] = true;
        const auto relative_at = [&](double time) {
            return parent_from_part(parent.transform_at(time), part.transform_at(time));
        };
        // A part that is rigidly attached to its parent has no keys of its own to preserve.
        const std::vector<double> old_times = all_times({parent.motion.get(), part.motion.get()});
        const Affine<double> first = relative_at(old_times.empty() ? 0.0 : old_times.front());
        const bool is_rigid = std::all_of(old_times.begin(), old_times.end(),
                                          [&](double time) { return are_close(relative_at(time), first); });
        const std::vector<double> times =
            is_rigid ? all_times({transform.motion.get()})
                     : all_times({transform.motion.get(), parent.motion.get(), part.motion.get()});
        part.set_transform(animated_transform(
            times, [&](double time) { return transform.at(time) * (is_rigid ? first : relative_at(time)); }));
    }
    assembly.instances[instance].set_transform(transform);
}

std::string DistinctNames::take(const std::string& name) {
    if (name.empty() || taken_.insert(name).second) return name;
    // Continues from the last number of this name, because a file may hold a name a million times.
    int& number = numbers_.try_emplace(name, 1).first->second;
    std::string unused;
    do unused = name + '.' + std::to_string(++number);
    while (!taken_.insert(unused).second);
    return unused;
}

void make_names_distinct(Assembly& assembly) {
    DistinctNames names;
    for (Instance& instance : assembly.instances) instance.name = names.take(instance.name);
}

void add(Assembly& assembly, const Assembly& object, const AnimatedTransform& transform, const std::string& name,
         DistinctNames& names) {
    const std::vector<Instance> parts = object.instances;  // a copy, because the object may be the assembly itself
    const std::string unique_name = names.take(name);
    std::ptrdiff_t parent = Instance::kNoParentInstance;
    if (!object.static_geometry->triangles.empty() || !object.static_geometry->points.empty()) {
        parent = std::ssize(assembly.instances);
        assembly.instances.push_back({object.static_geometry, transform.scene_from_object, unique_name});
        assembly.instances.back().motion = transform.motion;
    }
    const std::ptrdiff_t first_part = std::ssize(assembly.instances);
    for (const Instance& part : parts) {
        Instance added = part;
        added.set_transform(
            animated_transform(all_times({transform.motion.get(), part.motion.get()}),
                               [&](double time) { return transform.at(time) * part.transform_at(time); }));
        added.name = names.take(unique_name + (unique_name.empty() || part.name.empty() ? "" : "/") + part.name);
        added.part_of = part.part_of == Instance::kNoParentInstance ? parent : first_part + part.part_of;
        assembly.instances.push_back(std::move(added));
    }
}

}  // namespace realcam
