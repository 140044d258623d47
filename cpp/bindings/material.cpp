#include "material.hpp"

#include <pybind11/numpy.h>

#include "arrays.hpp"
#include "value_compare.hpp"

namespace realcam::bindings {

namespace {

std::int32_t place_of(std::vector<Texture>& textures, const Texture& texture) {
    for (std::size_t i = 0; i < textures.size(); ++i)
        if (equal(textures[i], texture)) return static_cast<std::int32_t>(i);
    textures.push_back(texture);
    return static_cast<std::int32_t>(textures.size()) - 1;
}

void drop_unused_textures(Scene& scene) {
    std::vector<Texture> all = std::move(scene.textures);
    std::vector<std::int32_t> places(all.size(), -1);
    scene.textures.clear();
    for (Material& material : scene.materials)
        for (const auto member : kMaterialTextures) {
            std::int32_t& number = (material.*member).texture;
            if (number < 0) continue;
            const auto from = static_cast<std::size_t>(number);
            if (places[from] < 0) {
                places[from] = static_cast<std::int32_t>(scene.textures.size());
                scene.textures.push_back(std::move(all[from]));
            }
            number = places[from];
        }
}

/// (H, W, C), of bytes.
InputArray<std::uint8_t> codes_from(const py::array& pixels) {
    const char kind = pixels.dtype().kind();
    if (kind != 'i' && kind != 'u' && kind != 'f')
        throw InputError("a texture must hold numbers: whole ones from 0 to 255, or fractions from 0 to 1");
    const double least = pixels.attr("min")().cast<double>(), most = pixels.attr("max")().cast<double>();
    const double white = kind == 'f' ? 1 : 255;
    if (!(least >= 0 && most <= white)) {
        const auto text = [](double v) { return py::repr(py::float_(v)).cast<std::string>(); };
        throw InputError("the texture's numbers lie between " + text(least) + " and " + text(most) +
                         (kind == 'f' ? "; fractions from 0 (black) to 1 (white)" : "; whole numbers from 0 to 255") +
                         " are wanted");
    }
    if (kind != 'f') return InputArray<std::uint8_t>(pixels);
    const py::object scaled = pixels.attr("__mul__")(255);
    return InputArray<std::uint8_t>(scaled.attr("round")());
}

}  // namespace

PythonMaterial material_of(const std::shared_ptr<const Scene>& scene, std::size_t index) {
    PythonMaterial material{
        index < scene->material_names.size() ? scene->material_names[index] : "", scene->materials[index], {}};
    for (std::size_t i = 0; i < kMaterialTextures.size(); ++i) {
        std::int32_t& number = (material.values.*kMaterialTextures[i]).texture;
        if (number >= 0)
            material.textures[i] =
                std::shared_ptr<const Texture>(scene, &scene->textures[static_cast<std::size_t>(number)]);
        number = -1;
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
            (scene.materials[index].*kMaterialTextures[i]).texture = place_of(scene.textures, *material.textures[i]);
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
    auto texture = std::make_shared<Texture>();
    texture->encoding = use == io::TextureUse::colour ? TextureEncoding::srgb : TextureEncoding::linear;
    texture->width = static_cast<std::int32_t>(pixels.shape(1));
    texture->height = static_cast<std::int32_t>(pixels.shape(0));
    texture->rgba.reserve(static_cast<std::size_t>(4 * pixels.size() / channels));
    // Some rows at a time: little memory, and Ctrl-C is heard in between.
    const py::ssize_t rows = std::max<py::ssize_t>(1, (py::ssize_t{1} << 20) / (channels * pixels.shape(1)));
    for (py::ssize_t row = 0; row < pixels.shape(0); row += rows) {
        heed_signals();
        const py::array band = pixels[py::slice(row, std::min(row + rows, pixels.shape(0)), 1)];
        const InputArray<std::uint8_t> codes = codes_from(band);
        for (py::ssize_t i = 0; i < codes.size(); i += channels) {
            const std::uint8_t* p = codes.data() + i;
            const std::uint8_t r = p[0], g = p[channels < 3 ? 0 : 1], b = p[channels < 3 ? 0 : 2];
            const auto mean = static_cast<std::uint8_t>((r + g + b) / 3);
            const std::uint8_t alpha = channels == 4 ? p[3] : use == io::TextureUse::opacity ? mean : 255;
            texture->rgba.insert(texture->rgba.end(), {r, g, b, alpha});
        }
    }
    return texture;
}

}  // namespace realcam::bindings
