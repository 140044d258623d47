#include "lens_material.hpp"

#include "lens_file.hpp"
#include "lens_text.hpp"

namespace realcam::io {

std::string number_label(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

Glass read_material(const TomlTable& table, const std::optional<TomlTable>& glasses) {
    const toml::node* node = table.find("material");
    if (node->is_number()) {
        const double index = table.as_number(*node, "the index in \"material\"");
        if (!(index >= 1)) table.fail("the refractive index in \"material\" is less than 1", node);
        Glass glass = Glass::constant(index);
        glass.label = number_label(index);
        return glass;
    }
    if (node->is_array()) {
        const std::vector<double> pair = table.numbers("material", 2);
        if (!(pair[0] >= 1) || !(pair[1] > 0))
            table.fail("\"material\" as [n_d, V_d] needs n_d of at least 1 and a positive V_d", node);
        Glass glass = Glass::from_abbe_number(pair[0], pair[1]);
        glass.label = number_label(pair[0]) + " / " + number_label(pair[1]);
        return glass;
    }
    const std::string name = table.text("material");
    if (glasses)
        if (const auto own = glasses->table(name)) {
            glasses->check_name(name, own->raw());
            Glass glass = glass_from_table(*own);
            glass.label = own->find("label") ? own->line("label") : name;
            return glass;
        }
    try {
        return catalogue_glass(name);
    } catch (const InputError& error) {
        table.fail(error.what(), node);
    }
}

CoatingMaterial read_complex_index(const TomlTable& table, std::string_view key) {
    const toml::node* node = table.find(key);
    const std::string what = '"' + std::string(key) + "\" must be [n, k], or [[wavelength in nm, n, k], ...]";
    const toml::array* rows = node->as_array();
    if (!rows || rows->empty()) table.fail(what, node);
    if (!(*rows)[0].is_array()) {
        const std::vector<double> pair = table.numbers(key, 2);
        CoatingMaterial material = CoatingMaterial::constant({pair[0], pair[1]});
        material.label = number_label(pair[0]) + " + " + number_label(pair[1]) + " i";
        return material;
    }
    if (rows->size() > kMaxFileIndices)
        table.fail("\"" + std::string(key) + "\" has " + std::to_string(rows->size()) + " points; at most " +
                       std::to_string(kMaxFileIndices) + " are read",
                   node);
    CoatingMaterial material;
    for (const toml::node& row : *rows) {
        const toml::array* point = row.as_array();
        if (!point || point->size() != 3) table.fail(what, &row);
        const auto number = [&](std::size_t i) { return table.as_number((*point)[i], "each number of a point"); };
        material.points.push_back({number(0), number(1), number(2)});
    }
    return material;
}

}  // namespace realcam::io
