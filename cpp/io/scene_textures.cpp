#include "scene_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

namespace realcam::io {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// "my%20wood.png", as an address in a glTF file spells it.
std::string percent_decoded(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
            out += static_cast<char>(16 * hex_digit(text[i + 1]) + hex_digit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

// Files from other machines name pictures with backslashes, and by paths that exist only there; the picture then
// mostly lies beside the scene.
std::optional<std::string> find_file(const std::string& scene_path, const std::string& name) {
    const fs::path folder = fs::path(scene_path).parent_path();
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    for (const std::string& spelling : {name, slashes, percent_decoded(slashes)}) {
        for (const fs::path& candidate : {folder / spelling, folder / fs::path(spelling).filename()}) {
            std::error_code error;
            if (fs::is_regular_file(candidate, error)) return candidate.string();
        }
    }
    return std::nullopt;
}

DecodedImage from_texels(const aiTexture& texture) {
    DecodedImage image{static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), {}};
    const std::size_t count = std::size_t{texture.mWidth} * texture.mHeight;
    image.rgba.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const aiTexel& t = texture.pcData[i];
        image.rgba.insert(image.rgba.end(), {t.r, t.g, t.b, t.a});
    }
    return image;
}

bool is_whole(const DecodedImage& image) {
    return image.width > 0 && image.height > 0 &&
           image.rgba.size() ==
               std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

DecodedImage checker() {
    constexpr int size = 32, square = 4;
    DecodedImage image{size, size, {}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const std::uint8_t on = (x / square + y / square) % 2 ? 0 : 255;
            image.rgba.insert(image.rgba.end(), {on, 0, on, 255});
        }
    }
    return image;
}

Vec3f mean_of(const DecodedImage& image, bool is_colour) {
    std::array<double, 256> value{};
    for (int i = 0; i < 256; ++i) {
        const double v = i / 255.0;
        const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        value[static_cast<std::size_t>(i)] = is_colour ? linear : v;
    }
    Vec3d sum = {0, 0, 0};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        sum += Vec3d{value[image.rgba[i]], value[image.rgba[i + 1]], value[image.rgba[i + 2]]};
    }
    return static_cast<Vec3f>((4.0 / static_cast<double>(image.rgba.size())) * sum);
}

}  // namespace

SceneTextures::SceneTextures(Scene& scene, const aiScene* content, const std::string& path,
                             const ImageReader& read_image)
    : scene_(scene), content_(content), path_(path), read_image_(read_image) {}

std::optional<DecodedImage> SceneTextures::decode(const std::string& name) {
    std::optional<DecodedImage> image;
    if (const aiTexture* embedded = content_ ? content_->GetEmbeddedTexture(name.c_str()) : nullptr) {
        if (embedded->mHeight > 0) {
            image = from_texels(*embedded);
        } else if (read_image_) {
            image = read_image_({}, {reinterpret_cast<const std::uint8_t*>(embedded->pcData), embedded->mWidth});
        }
    } else if (const std::optional<std::string> picture = find_file(path_, name)) {
        if (read_image_) image = read_image_(*picture, {});
    } else {
        scene_.warnings.push_back(path_ + ": texture " + name + ": no such file beside the scene");
        return std::nullopt;
    }
    if (image && is_whole(*image)) return image;
    scene_.warnings.push_back(path_ + ": texture " + (name.starts_with('*') ? name.substr(1) + " inside it" : name) +
                              ": cannot be read as a picture");
    return std::nullopt;
}

SceneTextures::Found SceneTextures::find(const std::string& name) {
    if (const auto known = found_.find(name); known != found_.end()) return known->second;
    std::optional<DecodedImage> image = decode(name);
    const Found found{static_cast<std::int32_t>(scene_.textures.size()), !image};
    if (!image) {
        scene_.warnings.back() += "; a checker in magenta and black stands in";
        image = checker();
    }
    scene_.textures.push_back({name, image->width, image->height, std::move(image->rgba)});
    return found_[name] = found;
}

std::optional<Vec3f> SceneTextures::mean(const std::string& name, bool is_colour) {
    const auto key = std::make_pair(name, is_colour);
    if (const auto known = means_.find(key); known != means_.end()) return known->second;
    const std::optional<DecodedImage> image = decode(name);
    return means_[key] = image ? std::optional(mean_of(*image, is_colour)) : std::nullopt;
}

std::optional<Vec3f> SceneTextures::mean_value(const std::string& name) {
    return mean(name, false);
}
std::optional<Vec3f> SceneTextures::mean_colour(const std::string& name) {
    return mean(name, true);
}

}  // namespace realcam::io
