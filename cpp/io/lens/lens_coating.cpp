#include "lens_coating.hpp"

#include "../../optics/coating/coated_surface.hpp"
#include "../../optics/prescription/coating.hpp"
#include "../../optics/prescription/coating_checks.hpp"
#include "../../optics/prescription/coating_material.hpp"
#include "lens_material.hpp"
#include "lens_text.hpp"

namespace realcam::io {
namespace {

/// Greatest number of coatings in a file: several for each surface.
constexpr std::size_t kMaxCoatings = 1000;

/// Names of the predefined metals.
std::vector<std::string> metal_names() {
    return {aluminium().label, silver().label};
}

/// Reads the key "metal": a name or complex indices.
CoatingMaterial read_metal(const TomlTable& table) {
    const toml::node* node = table.find("metal");
    if (!node->is_string()) return read_complex_index(table, "metal");
    const std::string name = table.text("metal");
    if (auto metal = named_metal(name)) return *metal;
    table.fail("unknown metal " + in_quotes(name) + did_you_mean(name, metal_names()) + "; expected " +
                   quoted_list(metal_names()) + ", [n, k] or [[wavelength in nm, n, k], ...]",
               node);
}

/// Reads the material of a layer: a transparent one, a metal, or complex indices.
CoatingMaterial read_layer_material(const TomlTable& layer, const std::optional<TomlTable>& glasses) {
    const bool is_complex = layer.find("complex_index") != nullptr;
    if (is_complex == (layer.find("material") != nullptr))
        layer.fail("a layer needs exactly one of \"material\" and \"complex_index\"");
    if (is_complex) return read_complex_index(layer, "complex_index");
    if (const toml::node* node = layer.find("material"); node->is_string())
        if (auto metal = named_metal(layer.text("material"))) return *metal;
    return CoatingMaterial::transparent(read_material(layer, glasses));
}

CoatingLayer read_layer(const TomlTable& layer, const std::optional<TomlTable>& glasses,
                        std::optional<double> design_wavelength_nm) {
    layer.allow({"material", "complex_index", "thickness_nm", "thickness_waves", "label"});
    CoatingLayer result{read_layer_material(layer, glasses), 0};
    if (layer.find("label")) result.material.label = layer.line("label");
    const auto nm = layer.number("thickness_nm"), waves = layer.number("thickness_waves");
    if (nm.has_value() == waves.has_value())
        layer.fail("a layer needs exactly one of \"thickness_nm\" and \"thickness_waves\"");
    if (waves && !design_wavelength_nm)
        layer.fail("\"thickness_waves\" counts waves of the coating's \"design_wavelength_nm\", which is missing",
                   layer.find("thickness_waves"));
    try {
        result.thickness_nm = nm ? *nm : thickness_of_waves(result.material, *waves, *design_wavelength_nm);
    } catch (const InputError& error) {
        layer.fail(error.what(), layer.find("thickness_waves"));
    }
    return result;
}

/// Reads the layers of a coating; empty without the key "layers".
std::vector<CoatingLayer> read_layers(const TomlTable& table, const std::optional<TomlTable>& glasses) {
    const auto design = table.number("design_wavelength_nm");
    if (design && !(*design >= 100 && *design <= 20000))
        table.fail("\"design_wavelength_nm\" must lie between 100 and 20000", table.find("design_wavelength_nm"));
    const toml::node* node = table.find("layers");
    std::vector<CoatingLayer> layers;
    if (!node) return layers;
    const toml::array* list = node->as_array();
    if (!list || !list->is_array_of_tables())
        table.fail("\"layers\" must be an array of tables { material = ..., thickness_nm = ... }", node);
    if (list->size() > kMaxCoatingLayers)
        table.fail("the coating has " + std::to_string(list->size()) + " layers; at most " +
                       std::to_string(kMaxCoatingLayers) + " are supported",
                   node);
    std::size_t indices = 0;
    for (const toml::node& layer : *list) {
        layers.push_back(read_layer(TomlTable(*layer.as_table(), table.file()), glasses, design));
        const CoatingMaterial& material = layers.back().material;
        indices += material.points.size() + material.glass.parts().points.size();
        if (indices > kMaxFileIndices)
            table.fail("the materials of the coating have more than " + std::to_string(kMaxFileIndices) + " indices",
                       &layer);
    }
    return layers;
}

/// Reads a table [coating.NAME].
Coating read_coating(const TomlTable& table, const std::string& name, const std::optional<TomlTable>& glasses) {
    table.allow({"layers", "design_wavelength_nm", "metal", "metal_label", "reflectance", "label"});
    const bool has_layers = table.find("layers") != nullptr, has_metal = table.find("metal") != nullptr;
    const auto reflectance = table.number("reflectance");
    if (reflectance ? has_layers || has_metal : !(has_layers || has_metal))
        table.fail(
            "a coating needs \"layers\", or a mirror's \"metal\" with or without \"layers\", or a mirror's "
            "\"reflectance\"");
    if (const toml::node* node = table.find("design_wavelength_nm"); node && !has_layers)
        table.fail("\"design_wavelength_nm\" is for layers, and there are none", node);
    Coating coating = reflectance ? stated_reflectance(*reflectance, name)
                      : has_metal ? metal_mirror(read_metal(table), read_layers(table, glasses), name)
                                  : layered_coating(read_layers(table, glasses), name);
    if (table.find("label")) coating.name = table.line("label");
    if (const toml::node* node = table.find("metal_label")) {
        if (!has_metal) table.fail("\"metal_label\" is for a \"metal\", and there is none", node);
        coating.metal.label = table.line("metal_label");
    }
    try {
        validate(coating);
    } catch (const InputError& error) {
        table.fail(error.what());
    }
    return coating;
}

}  // namespace

LensCoatings::LensCoatings(const TomlTable& file, const std::optional<TomlTable>& glasses) {
    if (const auto tables = file.table("coating")) {
        if (tables->raw().size() > kMaxCoatings)
            tables->fail("the lens has " + std::to_string(tables->raw().size()) + " coatings; at most " +
                         std::to_string(kMaxCoatings) + " are read");
        for (const auto& [key, node] : tables->raw()) {
            const std::string name(key.str());
            tables->check_name(name, node);
            if (named_coating(name))
                tables->fail(in_quotes(name) + " is the name of a predefined coating; choose another name", &node);
            file_coatings_[name] = read_coating(*tables->table(name), name, glasses);
        }
    }
    if (!file.find("default_coating")) return;
    default_ = named(file, "default_coating");
    if (default_.is_for_mirrors())
        file.fail("\"default_coating\" is for faces between air and glass; a mirror names its own",
                  file.find("default_coating"));
}

Coating LensCoatings::named(const TomlTable& table, std::string_view key) const {
    const std::string name = table.text(key);
    if (const auto found = file_coatings_.find(name); found != file_coatings_.end()) return found->second;
    if (auto known = named_coating(name)) return *known;
    std::vector<std::string> all = named_coatings();
    for (const auto& [own, coating] : file_coatings_) all.push_back(own);
    table.fail("unknown coating " + in_quotes(name) + did_you_mean(name, all) +
                   "; expected the name of a table [coating.NAME], or one of " + quoted_list(named_coatings()),
               table.find(key));
}

Coating LensCoatings::coating_of(const TomlTable& surface) const {
    return surface.find("coating") ? named(surface, "coating") : Coating();
}

void LensCoatings::apply_default(LensSystem& lens, const toml::array& surfaces) const {
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (!surfaces[i].as_table()->contains("coating") && is_face_in_air(lens, i))
            lens.surfaces[i].coating = default_;
}

}  // namespace realcam::io
