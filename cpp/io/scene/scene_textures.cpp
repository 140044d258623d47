#include "scene_textures.hpp"

#include <string>
#include <utility>
#include <vector>

#include "../../error.hpp"
#include "../files/regular_file.hpp"
#include "../files/uri.hpp"
#include "../text/printable.hpp"
#include "made_textures.hpp"

namespace realcam::io {
namespace {

/// Returns a checker pattern in magenta and black, which stands for a picture that cannot be read.
DecodedImage checker() {
    constexpr int size = 32, square = 4;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const std::uint8_t magenta = (x / square + y / square) % 2 ? 0 : 255;
            rgba.insert(rgba.end(), {magenta, 0, magenta, 255});
        }
    }
    return {size, size, std::move(rgba)};
}

/// Returns a picture's name for warnings: in one line, and shortened, because a file may have a name of a megabyte.
std::string short_name(const FilePicture& picture) {
    const std::string name = in_quotes(picture.name);
    return name.substr(1, name.size() - 2);
}

}  // namespace

SceneTextures::SceneTextures(Scene& scene, const FileScene& file, const ImageReader& read_image, Checkpoint& checkpoint)
    : scene_(scene), file_(file), read_image_(read_image), checkpoint_(checkpoint) {}

std::optional<DecodedImage> SceneTextures::decode(std::int32_t index) {
    const FilePicture& picture = file_.pictures[static_cast<std::size_t>(index)];
    const std::string label = file_.path + ": texture " + short_name(picture);
    std::optional<DecodedImage> image;
    std::string reason;
    checkpoint_.pass();
    const auto read = [&](const std::string& path, std::span<const std::uint8_t> bytes) {
        try {
            image = read_image_(path, bytes);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            reason = ": " + one_line(error.what());
        }
    };
    if (picture.is_embedded) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(picture.bytes.data());
        if (read_image_ && !picture.bytes.empty()) read({}, {bytes, picture.bytes.size()});
    } else if (const std::optional<std::string> path = find_beside(file_.path, picture.name)) {
        if (read_image_) read(*path, {});
    } else {
        scene_.warnings.push_back(label + ": no such file beside the scene");
        return std::nullopt;
    }
    if (image && is_whole(*image)) return image;
    scene_.warnings.push_back(label + ": cannot be read as a picture" + reason);
    return std::nullopt;
}

SceneTextures::Found SceneTextures::find(const FileTexture& texture, TextureUse use) {
    const Added added = add(texture.picture, use);
    return {texture.reference(added.texture), added.is_stand_in};
}

SceneTextures::Added SceneTextures::add(std::int32_t picture, TextureUse use) {
    const auto key = std::make_pair(picture, use);
    if (const auto known = added_.find(key); known != added_.end()) return known->second;
    std::optional<DecodedImage> image = decode(picture);
    const Added added{static_cast<std::int32_t>(scene_.textures.size()), !image};
    if (!image) {
        scene_.warnings.back() += "; a checker in magenta and black stands in";
        image = checker();
    }
    append(texture_of(std::move(*image), use, name_of(picture)));
    return added_[key] = added;
}

std::string SceneTextures::name_of(std::int32_t picture) const {
    return printable(file_.pictures[static_cast<std::size_t>(picture)].name);
}

std::int32_t SceneTextures::append(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    const Texture& added = scene_.textures.back();
    check_memory(added.rgba.size() + sizeof(float) * added.linear_rgba.size());
    return static_cast<std::int32_t>(scene_.textures.size()) - 1;
}

template <class Make>
std::optional<std::int32_t> SceneTextures::find_made(const MadeKey& key, Make&& make) {
    if (const auto known = made_.find(key); known != made_.end()) return known->second;
    std::optional<DecodedImage> images[2];
    const std::int32_t pictures[2] = {std::get<1>(key), std::get<2>(key)};
    std::optional<std::int32_t>& out = made_[key];
    for (const std::size_t i : {0, 1}) {
        if (pictures[i] < 0) continue;
        images[i] = decode(pictures[i]);
        if (images[i]) continue;
        scene_.warnings.back() += "; it is left out";
        return out;
    }
    return out = append(make(images[0] ? &*images[0] : nullptr, images[1] ? &*images[1] : nullptr));
}

std::optional<TextureReference> SceneTextures::find_heights(const FileTexture& texture, float scale) {
    const TextureSampler& sampler = texture.sampler;
    const bool repeats = sampler.u == TextureWrap::repeat && sampler.v == TextureWrap::repeat;
    const auto index =
        find_made({Made::normals, texture.picture, -1, scale, repeats}, [&](const DecodedImage* heights, auto) {
            return normals_of_heights(*heights, scale, repeats, name_of(texture.picture));
        });
    return index ? std::optional(texture.reference(*index)) : std::nullopt;
}

std::optional<TextureReference> SceneTextures::find_roughness_and_metallic(const FileTexture& roughness,
                                                                           const FileTexture& metallic) {
    const FileTexture& first = roughness ? roughness : metallic;
    const auto index = find_made({Made::roughness_and_metallic, roughness.picture, metallic.picture, 0, true},
                                 [&](const DecodedImage* r, const DecodedImage* m) {
                                     return roughness_and_metallic(r, m, name_of(first.picture));
                                 });
    return index ? std::optional(first.reference(*index)) : std::nullopt;
}

std::optional<TextureReference> SceneTextures::find_glossiness(const FileTexture& texture, float factor) {
    const auto index =
        find_made({Made::roughness, texture.picture, -1, factor, true}, [&](const DecodedImage* image, auto) {
            return roughness_of_glossiness(*image, factor, name_of(texture.picture));
        });
    return index ? std::optional(texture.reference(*index)) : std::nullopt;
}

// A picture of 33 kB may be decoded to a gigabyte. Rendering needs another copy of the textures, in its copy of the
// scene.
void SceneTextures::check_memory(std::size_t added) {
    constexpr std::size_t kUncheckedBytes = std::size_t{1} << 24;
    bytes_ += added;
    if (bytes_ - checked_bytes_ < kUncheckedBytes) return;
    checked_bytes_ = bytes_;
    if (const std::string why = too_much_memory(bytes_); !why.empty())
        throw SceneFileError(file_.path + ": its first " + std::to_string(scene_.textures.size()) +
                             " textures are in memory, and a render needs as much again, " + why);
}

}  // namespace realcam::io
