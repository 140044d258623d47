#include "vast_sheets.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

WithoutSheets SheetFinder::rest() const {
    double longest = 0;
    const std::array<Sheets, 3> vast = vast_sheets(longest);
    WithoutSheets rest{kept_};
    const double longest_kept = kLong * box_.diagonal();
    if (vast[0].empty() && vast[1].empty() && vast[2].empty() && longest <= longest_kept) return rest;
    rest.any_left_out = true;
    pieces_.for_chosen(kept_, [&](std::size_t i, const Piece& piece) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const auto plane = plane_of(piece, axis); plane && vast[axis].contains(*plane)) rest.chosen[i] = false;
        const double own = piece.box.diagonal();
        if (!rest.chosen[i] || own <= longest_kept) return;
        rest.chosen[i] = false;
        rest.shortest_left_out = std::min(rest.shortest_left_out, own);
    });
    return rest;
}

double SheetFinder::area_across(const Piece& piece, std::size_t axis) {
    const auto size = numbers(piece.box.size()), area = numbers(piece.area);
    return piece.area == Vec3d{} ? size[(axis + 1) % 3] * size[(axis + 2) % 3] : std::fabs(area[axis]);
}

std::optional<std::int64_t> SheetFinder::plane_of(const Piece& piece, std::size_t axis) const {
    const double low = numbers(piece.box.low)[axis], high = numbers(piece.box.high)[axis];
    if (!(high - low <= flat_) || !(flat_ > 0)) return {};
    return std::llround((0.5 * (low + high) - numbers(box_.low)[axis]) / (4 * flat_));
}

bool SheetFinder::is_vast(const Sheet& sheet, std::size_t axis) const {
    const auto size = numbers(sheet.box.size()), whole = numbers(box_.size());
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    return size[u] >= kVast * whole[u] && size[v] >= kVast * whole[v] && sheet.area >= kCovered * size[u] * size[v];
}

std::array<SheetFinder::Sheets, 3> SheetFinder::vast_sheets(double& longest) const {
    std::array<Sheets, 3> sheets;
    double longest_squared = 0;
    pieces_.for_chosen(kept_, [&](std::size_t, const Piece& piece) {
        const Vec3d size = piece.box.size();
        longest_squared = std::max(longest_squared, dot(size, size));
        if (std::min({size.x, size.y, size.z}) > flat_) return;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const auto plane = plane_of(piece, axis)) {
                Sheet& sheet = sheets[axis][*plane];
                sheet.box.add(piece.box);
                sheet.area += area_across(piece, axis);
            }
    });
    for (std::size_t axis = 0; axis < 3; ++axis)
        std::erase_if(sheets[axis], [&](const auto& entry) { return !is_vast(entry.second, axis); });
    longest = std::sqrt(longest_squared);
    return sheets;
}

}  // namespace realcam
