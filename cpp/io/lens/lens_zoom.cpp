#include "lens_zoom.hpp"

#include <algorithm>

#include "../../checkpoint.hpp"
#include "../../optics/lens/best_focus.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/prescription/lens_limits.hpp"
#include "lens_text.hpp"

namespace realcam::io {
namespace {

/// Parses a surface number that is a key, such as "12".
int surface_number(const TomlTable& table, std::string_view key, const toml::node& node) {
    const bool digits = !key.empty() && key.size() < 6 && key.find_first_not_of("0123456789") == key.npos;
    const int number = digits ? std::stoi(std::string(key)) : 0;
    if (number < 1)
        table.fail("\"thickness_mm\" of a zoom position has numbers of surfaces, from 1, as keys; this one is " +
                       in_quotes(key),
                   &node);
    return number;
}

}  // namespace

LensZoom::LensZoom(const TomlTable& file) : file_(file) {
    const toml::node* node = file.find("zoom");
    const toml::array* tables = node ? node->as_array() : nullptr;
    if (node && (!tables || !tables->is_array_of_tables())) file.fail("zoom positions are tables [[zoom]]", node);
    if (tables && tables->size() > static_cast<std::size_t>(kMaxFileZoomPositions))
        file.fail("the lens has " + std::to_string(tables->size()) + " zoom positions; at most " +
                      std::to_string(kMaxFileZoomPositions) + " are read",
                  node);
    for (std::size_t i = 0; tables && i < tables->size(); ++i) {
        Position position{TomlTable(*(*tables)[i].as_table(), file.file()), {}, {}};
        const TomlTable& table = position.table;
        table.allow({"name", "thickness_mm", "film_distance_mm", "focus_distance_mm", "stop_semi_diameter_mm"});
        position.name = table.text("name");
        if (position.name.empty() || printable(position.name) != position.name)
            table.fail("a zoom position needs a \"name\" of one line", table.find("name"));
        if (const auto list = table.table("thickness_mm"))
            for (const auto& [key, value] : list->raw())
                position.thicknesses.emplace_back(surface_number(*list, key.str(), value),
                                                  list->as_number(value, "the thickness"));
        std::sort(position.thicknesses.begin(), position.thicknesses.end());
        positions_.push_back(std::move(position));
    }
    check_same_surfaces();
    if (!file.find("zoom_position")) return;
    const std::string name = file.text("zoom_position");
    std::vector<std::string> names;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        names.push_back(positions_[i].name);
        if (positions_[i].name == name) current_ = static_cast<int>(i);
    }
    if (!current_)
        file.fail("unknown zoom position " + in_quotes(name) + did_you_mean(name, names), file.find("zoom_position"));
}

void LensZoom::check_same_surfaces() const {
    for (const Position& position : positions_) {
        const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
        const auto& first = positions_.front().thicknesses;
        if (!std::equal(first.begin(), first.end(), position.thicknesses.begin(), position.thicknesses.end(), same))
            position.table.fail("all zoom positions must have the thicknesses of the same surfaces");
    }
}

bool LensZoom::changes(int surface) const {
    return !positions_.empty() &&
           std::any_of(positions_.front().thicknesses.begin(), positions_.front().thicknesses.end(),
                       [&](const auto& entry) { return entry.first == surface; });
}

void LensZoom::apply(LensSystem& lens, const std::vector<bool>& has_thickness, const KeepGoing& keep_going) const {
    if (positions_.empty()) return;
    const auto current = static_cast<std::size_t>(current_.value_or(0));
    const int count = static_cast<int>(lens.surfaces.size());
    ZoomRange& zoom = lens.zoom;
    zoom.current = static_cast<int>(current);
    for (const auto& [surface, value] : positions_[current].thicknesses) {
        if (surface >= count)
            positions_[current].table.fail("there is no thickness of surface " + std::to_string(surface) +
                                           "; the last surface has the film distance");
        const auto index = static_cast<std::size_t>(surface) - 1;
        zoom.surfaces.push_back(surface - 1);
        if (!has_thickness[index]) {
            lens.surfaces[index].thickness = value;
        } else if (!current_ && lens.surfaces[index].thickness != value) {
            throw LensFileError(
                "the thickness is not that of the first zoom position, " + in_quotes(positions_.front().name) +
                    "; leave it out, or specify the \"zoom_position\" in which the file describes the lens",
                file_.file(), static_cast<int>(positions_.front().table.raw().source().begin.line), surface);
        }
    }
    // Zooming returns the focusing group to rest: the thicknesses that focusing changes are needed, too.
    const FocusingRule& rule = lens.focusing;
    if (rule.moves_group())
        for (const int i : {rule.group_first - 1, rule.group_last})
            if (i >= 0 && i + 1 < count && !changes(i + 1)) zoom.surfaces.push_back(i);
    std::sort(zoom.surfaces.begin(), zoom.surfaces.end());
    for (const Position& position : positions_) {
        ZoomPosition result;
        result.name = position.name;
        for (const int i : zoom.surfaces) {
            const auto found = std::find_if(position.thicknesses.begin(), position.thicknesses.end(),
                                            [&](const auto& entry) { return entry.first == i + 1; });
            result.thicknesses.push_back(found == position.thicknesses.end()
                                             ? lens.surfaces[static_cast<std::size_t>(i)].thickness
                                             : found->second);
        }
        result.film_distance = position.table.number("film_distance_mm").value_or(0);
        if (result.film_distance == 0 && position.table.find("film_distance_mm")) result.film_distance = kFilmContact;
        result.focus_distance = position.table.number("focus_distance_mm").value_or(kInfinity);
        const auto stop = position.table.number("stop_semi_diameter_mm");
        if (stop && !(*stop > 0))
            position.table.fail("\"stop_semi_diameter_mm\" must be positive",
                                position.table.find("stop_semi_diameter_mm"));
        result.stop_semi_diameter = stop.value_or(0);  // 0: constant
        if ((position.table.find("stop_semi_diameter_mm") == nullptr) !=
            (positions_.front().table.find("stop_semi_diameter_mm") == nullptr))
            position.table.fail("either all zoom positions must have \"stop_semi_diameter_mm\", or none");
        zoom.positions.push_back(std::move(result));
    }
    if (zoom.positions[current].stop_semi_diameter > 0)
        lens.surfaces[static_cast<std::size_t>(lens.stop_index())].clear_semi_diameter =
            zoom.positions[current].stop_semi_diameter;
    Checkpoint checkpoint(keep_going);
    constexpr std::size_t kWorkPerPosition = 1 << 14;  // checkpoint work: a few milliseconds
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        checkpoint.pass(kWorkPerPosition);
        const TomlTable& table = positions_[i].table;
        ZoomPosition& position = zoom.positions[i];
        if (table.find("film_distance_mm")) continue;
        LensSystem zoomed = at_zoom_position(lens, static_cast<int>(i));
        try {
            check_surfaces(zoomed);
        } catch (const LensFileError& error) {
            throw LensFileError("in zoom position " + in_quotes(position.name) + ": " + error.detail, file_.file(),
                                static_cast<int>(table.raw().source().begin.line), error.surface);
        }
        position.film_distance = best_focus_distance(zoomed, lens.wavelength_nm, kInfinity);
        if (!(position.film_distance > 0))
            table.fail(
                "the lens makes no real image of infinity behind its last surface; \"film_distance_mm\" is "
                "required");
    }
}

}  // namespace realcam::io
