#include "material.hpp"

#include <pybind11/numpy.h>

#include "../../io/files/regular_file.hpp"
#include "../../scene/scene_checks.hpp"
#include "arrays.hpp"
#include "value_compare.hpp"

namespace realcam::bindings {

namespace {

/// Returns the index of a texture in the list, to which it is appended if the list does not contain it.
std::int32_t find_or_append(std::vector<Texture>& textures, const Texture& texture) {
    for (std::size_t i = 0; i < textures.size(); ++i)
        if (equal(textures[i], texture)) return static_cast<std::int32_t>(i);
    textures.push_back(texture);
    return static_cast<std::int32_t>(textures.size()) - 1;
}

void drop_unused_textures(Scene& scene) {
    std::vector<Texture> all = std::move(scene.textures);
    std::vector<std::int32_t> indices(all.size(), -1);
    scene.textures.clear();
    for (Material& material : scene.materials)
        for (const auto member : kMaterialTextures) {
            std::int32_t& index = (material.*member).texture;
            if (index < 0) continue;
            const auto from = static_cast<std::size_t>(index);
            if (indices[from] < 0) {
                indices[from] = static_cast<std::int32_t>(scene.textures.size());
                scene.textures.push_back(std::move(all[from]));
            }
            index = indices[from];
        }
}

/// Returns true for floats, whose range is 0 to 1, and false for integers, whose range is 0 to 255. Throws InputError
/// for other types.
bool holds_fractions(const py::array& pixels) {
    const char kind = pixels.dtype().kind();
    if (kind != 'i' && kind != 'u' && kind != 'f')
        throw InputError("a texture must hold integers from 0 to 255 or floats from 0 to 1");
    return kind == 'f';
}

void check_range(const py::array& pixels) {
    const bool are_fractions = holds_fractions(pixels);
    const double minimum = pixels.attr("min")().cast<double>(), maximum = pixels.attr("max")().cast<double>();
    if (minimum >= 0 && maximum <= (are_fractions ? 1 : 255)) return;
    const auto text = [](double v) { return py::repr(py::float_(v)).cast<std::string>(); };
    throw InputError(
        "the texture's numbers lie between " + text(minimum) + " and " + text(maximum) +
        (are_fractions ? "; expected floats from 0 (black) to 1 (white)" : "; expected integers from 0 to 255"));
}

/// Appends rows of an array of shape (H, W) or (H, W, C) to `rgba` as red, green, blue and alpha. Colours are converted
/// by `decode(value)`, alpha is not; `white` is the alpha of textures without one.
template <class Value, class Decode>
void append_rgba(std::vector<Value>& rgba, const py::array& band, py::ssize_t channels, Value white, io::TextureUse use,
                 Decode&& decode) {
    const InputArray<Value> values(band);
    for (py::ssize_t i = 0; i < values.size(); i += channels) {
        const Value* p = values.data() + i;
        const Value r = p[0], g = p[channels < 3 ? 0 : 1], b = p[channels < 3 ? 0 : 2];
        const auto mean = static_cast<Value>((r + g + b) / 3);
        const Value alpha = channels == 4 ? p[3] : use == io::TextureUse::opacity ? mean : white;
        rgba.insert(rgba.end(), {decode(r), decode(g), decode(b), alpha});
    }
}

}  // namespace

void validate(const PythonMaterial& material) {
    for (const auto& texture : material.textures)
        if (texture) validate(*texture);
    for (const auto member : kMaterialTextures)
        if ((material.values.*member).texture != -1)
            throw InputError("a material outside of a scene must not have texture indices");
}

PythonMaterial material_of(const std::shared_ptr<const Scene>& scene, std::size_t index) {
    PythonMaterial material{
        index < scene->material_names.size() ? scene->material_names[index] : "", scene->materials[index], {}};
    for (std::size_t i = 0; i < kMaterialTextures.size(); ++i) {
        std::int32_t& texture = (material.values.*kMaterialTextures[i]).texture;
        if (texture >= 0)
            material.textures[i] =
                std::shared_ptr<const Texture>(scene, &scene->textures[static_cast<std::size_t>(texture)]);
        texture = -1;
    }
    return material;
}

void set_material(Scene& scene, std::size_t index, const PythonMaterial& material) {
    if (index >= scene.materials.size()) scene.materials.resize(index + 1);
    scene.material_names.resize(scene.materials.size());
    if (scene.material_names[index].empty()) scene.material_names[index] = material.name;
    scene.materials[index] = material.values;
    for (std::size_t i = 0; i < kMaterialTextures.size(); ++i)
        if (material.textures[i])
            (scene.materials[index].*kMaterialTextures[i]).texture =
                find_or_append(scene.textures, *material.textures[i]);
    drop_unused_textures(scene);
}

std::shared_ptr<const Texture> texture_from(const py::object& object, io::TextureUse use) {
    constexpr const char* kShapes = "a texture must be an array of shape (H, W), (H, W, 3) or (H, W, 4)";
    const py::array pixels = py::array::ensure(object);
    if (!pixels) {
        PyErr_Clear();
        throw InputError(kShapes);
    }
    const py::ssize_t channels = pixels.ndim() == 3 ? pixels.shape(2) : pixels.ndim() == 2 ? 1 : 0;
    if ((channels != 1 && channels != 3 && channels != 4) || pixels.size() == 0) throw InputError(kShapes);
    const auto texels = static_cast<std::size_t>(pixels.size() / channels);
    const bool is_float = holds_fractions(pixels);
    const std::string size =
        "a texture of " + std::to_string(pixels.shape(1)) + " x " + std::to_string(pixels.shape(0)) + " pixels ";
    if (texels > io::kMaxTexturePixels)
        throw InputError(size + "is too large; at most " + std::to_string(io::kMaxTexturePixels >> 20) +
                         " million pixels are allowed");
    const std::size_t count = 4 * texels;
    if (const std::string why = io::too_much_memory(count * (is_float ? sizeof(float) : 1)); !why.empty())
        throw InputError(size + "takes " + why);
    auto texture = std::make_shared<Texture>();
    texture->encoding = use == io::TextureUse::colour ? TextureEncoding::srgb : TextureEncoding::linear;
    texture->width = static_cast<std::int32_t>(pixels.shape(1));
    texture->height = static_cast<std::int32_t>(pixels.shape(0));
    const bool is_encoded = is_float && use == io::TextureUse::colour;
    if (is_float)
        texture->linear_rgba.reserve(count);
    else
        texture->rgba.reserve(count);
    // Converts bands of about a million numbers, to limit memory and to check for Ctrl-C in between.
    const py::ssize_t rows = std::max<py::ssize_t>(1, (py::ssize_t{1} << 20) / (channels * pixels.shape(1)));
    for (py::ssize_t row = 0; row < pixels.shape(0); row += rows) {
        heed_signals();
        const py::array band = pixels[py::slice(row, std::min(row + rows, pixels.shape(0)), 1)];
        check_range(band);
        if (is_float)
            append_rgba<float>(texture->linear_rgba, band, channels, 1.0f, use,
                               [&](float v) { return is_encoded ? io::linear_of_srgb(v) : v; });
        else
            append_rgba<std::uint8_t>(texture->rgba, band, channels, 255, use, [](std::uint8_t v) { return v; });
    }
    return texture;
}

}  // namespace realcam::bindings
