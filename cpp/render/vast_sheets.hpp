#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "scene_pieces.hpp"

namespace REALCAM_NAMESPACE {

/// Pieces without floors, walls and what else is vast and flat.
struct WithoutSheets {
    ChosenPieces chosen;
    bool any_left_out = false;
    double shortest_left_out = std::numeric_limits<double>::infinity();  ///< of single long pieces, m
};

/// Leaves out planes across one axis that reach along at least half of the box in both other directions and are at
/// least half covered, of however many pieces; and single pieces longer than a third of the box.
class SheetFinder {
public:
    SheetFinder(const ScenePieces& pieces, const ChosenPieces& kept, const BoundingBox& box)
        : pieces_(pieces), kept_(kept), box_(box), flat_(kFlat * box.diagonal()) {}

    WithoutSheets rest() const {
        double longest = 0;
        const std::array<Sheets, 3> vast = vast_sheets(longest);
        WithoutSheets rest{kept_};
        const double longest_kept = kLong * box_.diagonal();
        if (vast[0].empty() && vast[1].empty() && vast[2].empty() && longest <= longest_kept) return rest;
        rest.any_left_out = true;
        pieces_.for_chosen(kept_, [&](std::size_t i, const Piece& piece) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (const auto plane = plane_of(piece, axis); plane && vast[axis].contains(*plane))
                    rest.chosen[i] = false;
            const double own = piece.box.diagonal();
            if (!rest.chosen[i] || own <= longest_kept) return;
            rest.chosen[i] = false;
            rest.shortest_left_out = std::min(rest.shortest_left_out, own);
        });
        return rest;
    }

private:
    static constexpr double kVast = 0.5, kCovered = 0.5, kLong = 1.0 / 3;
    /// Corners of one plane differ by roundings of float32 at most, 6e-8 of a coordinate.
    static constexpr double kFlat = 1e-6;

    struct Sheet {
        BoundingBox box;
        double area = 0;
    };
    using Sheets = std::map<std::int64_t, Sheet>;  ///< by their height, in units of what counts as flat

    /// Of an instance, which has no area of its own, as much as its box shows.
    static double area_across(const Piece& piece, std::size_t axis) {
        const auto size = numbers(piece.box.size()), area = numbers(piece.area);
        return piece.area == Vec3d{} ? size[(axis + 1) % 3] * size[(axis + 2) % 3] : std::fabs(area[axis]);
    }

    std::optional<std::int64_t> plane_of(const Piece& piece, std::size_t axis) const {
        const double low = numbers(piece.box.low)[axis], high = numbers(piece.box.high)[axis];
        if (!(high - low <= flat_) || !(flat_ > 0)) return {};
        return std::llround((0.5 * (low + high) - numbers(box_.low)[axis]) / (4 * flat_));
    }

    bool is_vast(const Sheet& sheet, std::size_t axis) const {
        const auto size = numbers(sheet.box.size()), whole = numbers(box_.size());
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        return size[u] >= kVast * whole[u] && size[v] >= kVast * whole[v] && sheet.area >= kCovered * size[u] * size[v];
    }

    std::array<Sheets, 3> vast_sheets(double& longest) const {
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

    const ScenePieces& pieces_;
    const ChosenPieces& kept_;
    const BoundingBox& box_;
    double flat_;  ///< m
};

}  // namespace REALCAM_NAMESPACE
