#include "layer_film.hpp"

#include <limits>
#include <map>
#include <string>
#include <utility>

#include "../../scene/scene.hpp"

namespace realcam {

namespace {

/// Returns a weighted mean from its sums; 0 if the weight is 0.
float mean(double sum, double weight) {
    return weight > 0 ? static_cast<float>(sum / weight) : 0.0f;
}

}  // namespace

std::vector<LayerImage> developed_layers(const LayerFilm& film, LayerSet requested, const SurfaceIds& ids,
                                         Vec3d origin_m) {
    using namespace layer_film_detail;
    std::vector<LayerImage> images;
    const auto add = [&](Layer layer, auto&& make) {
        if (requested.has(layer)) images.push_back(make(layer));
    };
    add(Layer::normal, [&](Layer layer) {
        return make_image(layer, film.sums, [](const LayerSum& sum, float* out) {
            for (int c = 0; c < 3; ++c) out[c] = mean(sum.normal[c], sum.met);
        });
    });
    add(Layer::albedo, [&](Layer layer) {
        return make_image(layer, film.sums, [](const LayerSum& sum, float* out) {
            for (int c = 0; c < 3; ++c) out[c] = mean(sum.albedo[c], sum.met);
        });
    });
    add(Layer::circle_of_confusion_mm, [&](Layer layer) {
        return make_image(layer, film.sums, [](const LayerSum& sum, float* out) {
            *out = sum.weight > 0 ? mean(sum.circle_mm, sum.weight) : std::numeric_limits<float>::quiet_NaN();
        });
    });
    add(Layer::depth_middle, [&](Layer layer) {
        return make_image(layer, film.pixel_centres,
                          [](const PixelCentreSurface& surface, float* out) { *out = surface.depth; });
    });
    add(Layer::normal_middle, [&](Layer layer) {
        return make_image(layer, film.pixel_centres, [](const PixelCentreSurface& surface, float* out) {
            out[0] = surface.normal.x;
            out[1] = surface.normal.y;
            out[2] = surface.normal.z;
        });
    });
    add(Layer::object_id, [&](Layer layer) {
        return make_id_image(layer, film.pixel_centres,
                             [&](const PixelCentreSurface& surface) { return ids.object(surface); });
    });
    add(Layer::material_id, [&](Layer layer) {
        return make_id_image(layer, film.pixel_centres,
                             [&](const PixelCentreSurface& surface) { return ids.material(surface); });
    });
    add(Layer::position_middle, [&](Layer layer) {
        return make_image(layer, film.pixel_centres, [&](const PixelCentreSurface& surface, float* out) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            const bool is_surface = surface.triangle != kNoTriangle;
            const Vec3d position =
                is_surface ? static_cast<Vec3d>(surface.position) + origin_m : Vec3d{kNone, kNone, kNone};
            out[0] = static_cast<float>(position.x);
            out[1] = static_cast<float>(position.y);
            out[2] = static_cast<float>(position.z);
        });
    });
    return images;
}

SurfaceIds::SurfaceIds(const Assembly& assembly) : objects_{"", "static geometry"}, materials_{""} {
    std::map<const Scene*, std::uint32_t> first;
    const auto first_of = [&](const Scene& scene) {
        // Objects that several instances share have one range of ids.
        const auto [entry, is_new] = first.try_emplace(&scene, static_cast<std::uint32_t>(materials_.size()));
        if (is_new)
            for (std::string& name : material_names(scene)) materials_.push_back(std::move(name));
        return entry->second;
    };
    first_material_.push_back(first_of(*assembly.static_geometry));
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
        const Instance& instance = assembly.instances[i];
        objects_.push_back(instance.name.empty() ? "instance " + std::to_string(i) : instance.name);
        first_material_.push_back(first_of(*instance.object));
    }
}

}  // namespace realcam
