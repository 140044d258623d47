#include "gltf_readers.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "../text/printable.hpp"

namespace realcam::io {
namespace {

/// Range of valid numbers.
struct Range {
    double min, max;
};
constexpr double kLargest = std::numeric_limits<float>::max();
constexpr Range kUnit{0, 1}, kNotNegative{0, kLargest}, kAny{-kLargest, kLargest};

/// Parses the materials of a file. Its read functions leave a value, `out`, unchanged if the JSON element is missing.
class MaterialParser {
public:
    MaterialParser(FileScene& scene, const Json& root) : scene_(scene), root_(root) {}

    /// Parses one element of "materials".
    GltfMaterial parse(const Json& json) {
        GltfMaterial out;
        read_metallic_roughness(out, json["pbrMetallicRoughness"]);
        read_common(out, json);
        const Json& extensions = json["extensions"];
        read_specular_glossiness(out, extensions["KHR_materials_pbrSpecularGlossiness"]);
        read_transmission(out.transmission, extensions["KHR_materials_transmission"]);
        read_volume(out.volume, extensions["KHR_materials_volume"]);
        read_volume_scatter(out.volume, extensions["KHR_materials_volume_scatter"]);
        read_clearcoat(out.clearcoat, extensions["KHR_materials_clearcoat"]);
        read_specular(out.specular, extensions["KHR_materials_specular"]);
        read_ior(out.ior, extensions["KHR_materials_ior"]["ior"]);
        read_unchecked(out.emissive_strength, extensions["KHR_materials_emissive_strength"]["emissiveStrength"]);
        out.unlit = !extensions["KHR_materials_unlit"].is_null();
        has_occlusion_ |= bool(out.occlusion_texture);
        collect_uv_sets(out);
        return out;
    }

    /// Adds warnings for invalid or unsupported values in any of the materials.
    void add_warnings() const {
        const auto warn = [&](std::size_t count, const std::string& text) {
            if (count > 0) scene_.warnings.push_back(std::to_string(count) + ' ' + text);
        };
        warn(out_of_range_, "numbers of its materials are out of their range; the nearest number in the range is used");
        warn(bad_samplers_, "wrap modes or filters of samplers are invalid; REPEAT and LINEAR are used");
        warn(bad_transforms_, "texture transforms are not finite; they are left out");
        if (has_bad_attenuation_)
            scene_.warnings.push_back("an attenuationDistance must be positive; volumes without one absorb no light");
        if (!bad_alpha_mode_.empty())
            scene_.warnings.push_back("an alphaMode must be OPAQUE, MASK or BLEND, not " + bad_alpha_mode_ +
                                      "; OPAQUE is used");
        if (has_scatter_texture_)
            scene_.warnings.push_back("multiscatterColorTexture is not modelled: volumes are homogeneous");
        if (has_occlusion_)
            scene_.warnings.push_back("occlusionTexture is not modelled: path tracing computes the occlusion");
        if (has_third_set_)
            scene_.warnings.push_back(
                "a third set of texture coordinates in one material is not modelled; its textures use the first set");
    }

private:
    void read_metallic_roughness(GltfMaterial& out, const Json& json) {
        read(out.base_color_factor, json["baseColorFactor"], kUnit);
        read(out.alpha, json["baseColorFactor"][3], kUnit);
        read(out.metallic_factor, json["metallicFactor"], kUnit);
        read(out.roughness_factor, json["roughnessFactor"], kUnit);
        read(out.base_color_texture, json["baseColorTexture"]);
        read(out.metallic_roughness_texture, json["metallicRoughnessTexture"]);
    }

    /// Reads the properties of both reflection models.
    void read_common(GltfMaterial& out, const Json& json) {
        read(out.normal_texture, json["normalTexture"]);
        read(out.normal_scale, json["normalTexture"]["scale"], kAny);
        read(out.occlusion_texture, json["occlusionTexture"]);
        read(out.occlusion_strength, json["occlusionTexture"]["strength"], kUnit);
        read_unchecked(out.emissive_factor.x, json["emissiveFactor"][std::size_t{0}]);
        read_unchecked(out.emissive_factor.y, json["emissiveFactor"][1]);
        read_unchecked(out.emissive_factor.z, json["emissiveFactor"][2]);
        read(out.emissive_texture, json["emissiveTexture"]);
        read(out.alpha_mode, json["alphaMode"]);
        read(out.alpha_cutoff, json["alphaCutoff"], kNotNegative);
        out.double_sided = json["doubleSided"].is_true();
    }

    void read_specular_glossiness(GltfMaterial& material, const Json& json) {
        if (json.is_null()) return;
        GltfSpecularGlossiness& out = material.specular_glossiness.emplace();
        read(out.diffuse_factor, json["diffuseFactor"], kUnit);
        read(out.alpha, json["diffuseFactor"][3], kUnit);
        read(out.specular_factor, json["specularFactor"], kUnit);
        read(out.glossiness_factor, json["glossinessFactor"], kUnit);
        read(out.diffuse_texture, json["diffuseTexture"]);
        read(out.specular_glossiness_texture, json["specularGlossinessTexture"]);
    }

    void read_transmission(GltfTransmission& out, const Json& json) {
        read(out.factor, json["transmissionFactor"], kUnit);
        read(out.texture, json["transmissionTexture"]);
    }

    void read_volume(GltfVolume& out, const Json& json) {
        read(out.thickness_factor, json["thicknessFactor"], kNotNegative);
        read(out.thickness_texture, json["thicknessTexture"]);
        read(out.attenuation_color, json["attenuationColor"], kUnit);
        const Json& distance = json["attenuationDistance"];
        // Some programs write 0 for no attenuation; taken literally, no light would pass.
        const bool is_positive = distance.number(1) > 0;
        has_bad_attenuation_ |= !is_positive;
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        if (is_positive) read(out.attenuation_distance, distance, {std::numeric_limits<float>::min(), kInfinity});
    }

    void read_volume_scatter(GltfVolume& out, const Json& json) {
        read(out.multiscatter_color_factor, json["multiscatterColor"], kUnit);  // name in earlier drafts
        read(out.multiscatter_color_factor, json["multiscatterColorFactor"], kUnit);
        read(out.scatter_anisotropy, json["scatterAnisotropy"], {-1, 1});
        has_scatter_texture_ |= !json["multiscatterColorTexture"].is_null();
    }

    void read_clearcoat(GltfClearcoat& out, const Json& json) {
        read(out.factor, json["clearcoatFactor"], kUnit);
        read(out.texture, json["clearcoatTexture"]);
        read(out.roughness_factor, json["clearcoatRoughnessFactor"], kUnit);
        read(out.roughness_texture, json["clearcoatRoughnessTexture"]);
        read(out.normal_texture, json["clearcoatNormalTexture"]);
        read(out.normal_scale, json["clearcoatNormalTexture"]["scale"], kAny);
    }

    void read_specular(GltfSpecular& out, const Json& json) {
        read(out.factor, json["specularFactor"], kUnit);
        read(out.texture, json["specularTexture"]);
        read(out.color_factor, json["specularColorFactor"], kNotNegative);
        read(out.color_texture, json["specularColorTexture"]);
    }

    /// Reads an index of refraction: 0, or at least 1 (GltfMaterial::ior).
    void read_ior(float& out, const Json& json) {
        if (json.number(1) == 0)
            out = 0;
        else
            read(out, json, {1, kLargest});
    }

    void read(float& out, const Json& json, Range range) {
        const double value = json.number(static_cast<double>(out));
        const double clamped = std::clamp(value, range.min, range.max);
        if (clamped != value) ++out_of_range_;
        out = static_cast<float>(clamped);
    }

    void read(Vec3f& out, const Json& json, Range range) {
        read(out.x, json[std::size_t{0}], range);
        read(out.y, json[1], range);
        read(out.z, json[2], range);
    }

    /// Reads a number of any size, which is checked later for all formats.
    static void read_unchecked(float& out, const Json& json) {
        out = static_cast<float>(json.number(static_cast<double>(out)));
    }

    void read(AlphaMode& out, const Json& json) {
        const std::string& name = json.text();
        if (name == "MASK") out = AlphaMode::mask;
        if (name == "BLEND") out = AlphaMode::blend;
        if (json.is_null() || name == "OPAQUE" || name == "MASK" || name == "BLEND") return;
        if (bad_alpha_mode_.empty()) bad_alpha_mode_ = in_quotes(name);
    }

    /// Reads a texture reference. `info`: glTF's textureInfo; null if there is no texture.
    void read(FileTexture& out, const Json& info) {
        if (info.is_null()) return;
        const Json& json_transform = info["extensions"]["KHR_texture_transform"];
        const Json &scale = json_transform["scale"], &offset = json_transform["offset"];
        const Json& set = json_transform["texCoord"].is_number() ? json_transform["texCoord"] : info["texCoord"];
        out.picture = picture_of(info["index"]);
        out.sampler = sampler_of(info["index"]);
        out.uv_set = static_cast<std::uint32_t>(std::min<std::size_t>(set.index(0), 0xffff));
        const TextureTransform transform(scale[std::size_t{0}].number(1), scale[1].number(1),
                                         json_transform["rotation"].number(0), offset[std::size_t{0}].number(0),
                                         offset[1].number(0));
        if (transform.is_finite())
            out.transform = transform;
        else
            ++bad_transforms_;
    }

    /// Returns the wrap modes and the magnification filter of a texture. Minification filters are ignored: the renderer
    /// has its own.
    TextureSampler sampler_of(const Json& texture) {
        const Json& reference = root_["textures"][texture.index(root_["textures"].size())]["sampler"];
        const Json& sampler = root_["samplers"][reference.index(root_["samplers"].size())];
        enum : std::size_t { kNearest = 9728, kLinear = 9729, kClamp = 33071, kMirror = 33648, kRepeat = 10497 };
        const auto wrap = [&](const Json& json) {
            const std::size_t code = json.is_null() ? std::size_t{kRepeat} : json.index(0);
            if (code != kClamp && code != kMirror && code != kRepeat) ++bad_samplers_;
            return code == kClamp ? TextureWrap::clamp : code == kMirror ? TextureWrap::mirror : TextureWrap::repeat;
        };
        const std::size_t filter = sampler["magFilter"].index(kLinear);
        if (filter != kNearest && filter != kLinear) ++bad_samplers_;
        return {wrap(sampler["wrapS"]), wrap(sampler["wrapT"]),
                filter == kNearest ? TextureFilter::nearest : TextureFilter::linear};
    }

    /// Returns the index of a texture's picture. A texture without a picture gets one without bytes, which becomes a
    /// checker pattern with a warning.
    std::int32_t picture_of(const Json& texture) {
        const Json& found = root_["textures"][texture.index(root_["textures"].size())];
        // A KTX2 picture cannot be decoded; the warning about it names it.
        const Json* source = &found["source"];
        for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu"})
            if (source->is_null()) source = &found["extensions"][extension]["source"];
        const std::size_t images = root_["images"].size(), image = source->index(images);
        if (image < images) return first_alike(image);
        if (missing_ < 0) {
            missing_ = static_cast<std::int32_t>(scene_.pictures.size());
            scene_.pictures.push_back({"without a picture", true, {}});
        }
        return missing_;
    }

    /// Returns the first image with the same bytes, so that images which share a bufferView are decoded once.
    std::int32_t first_alike(std::size_t image) {
        const auto index = static_cast<std::int32_t>(image);
        const Json& view = root_["images"][image]["bufferView"];
        return view.is_number() ? first_of_view_.emplace(view.number(0), index).first->second : index;
    }

    /// Lists the sets of texture coordinates that the textures use in `uv_sets`, at most two, and replaces the sets of
    /// the textures by indices in that list.
    void collect_uv_sets(GltfMaterial& material) {
        std::vector<std::uint32_t>& sets = material.uv_sets;
        for (FileTexture* texture : material.textures()) {
            const auto known = std::find(sets.begin(), sets.end(), texture->uv_set);
            const auto index = static_cast<std::uint32_t>(known - sets.begin());
            const bool is_third = known == sets.end() && sets.size() == 2;
            if (known == sets.end() && !is_third) sets.push_back(texture->uv_set);
            texture->uv_set = is_third ? 0 : index;
            has_third_set_ |= is_third;
        }
    }

    FileScene& scene_;
    const Json& root_;
    std::int32_t missing_ = -1;  // index of the picture for textures without one
    std::map<double, std::int32_t> first_of_view_;  // first image of each bufferView
    std::size_t out_of_range_ = 0, bad_transforms_ = 0, bad_samplers_ = 0;
    std::string bad_alpha_mode_;  // the first invalid one, in quotes
    bool has_occlusion_ = false, has_third_set_ = false, has_bad_attenuation_ = false, has_scatter_texture_ = false;
};

}  // namespace

void read_gltf_materials(FileScene& scene, const GltfDocument& document) {
    MaterialParser parser(scene, document.root());
    const Json& materials = document.root()["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
        scene.materials.push_back({materials[i]["name"].text(), parser.parse(materials[i])});
    parser.add_warnings();
}

}  // namespace realcam::io
