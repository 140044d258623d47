#pragma once
#include <array>
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

/// Leaves out planes across one axis, of however many pieces, that reach along at least half of the box in both other
/// directions and are at least half covered. It also leaves out single pieces longer than a third of the box.
class SheetFinder {
public:
    SheetFinder(const ScenePieces& pieces, const ChosenPieces& kept, const BoundingBox& box)
        : pieces_(pieces), kept_(kept), box_(box), flat_(kFlat * box.diagonal()) {}

    WithoutSheets rest() const;

private:
    static constexpr double kVast = 0.5, kCovered = 0.5, kLong = 1.0 / 3;
    /// Corners of one plane differ by roundings of float32 at most, 6e-8 of a coordinate.
    static constexpr double kFlat = 1e-6;

    struct Sheet {
        BoundingBox box;
        double area = 0;
    };
    using Sheets = std::map<std::int64_t, Sheet>;  ///< by their height, in units of what counts as flat

    /// An instance, which has no area of its own, has as much as its box shows.
    static double area_across(const Piece& piece, std::size_t axis);

    std::optional<std::int64_t> plane_of(const Piece& piece, std::size_t axis) const;

    bool is_vast(const Sheet& sheet, std::size_t axis) const;

    std::array<Sheets, 3> vast_sheets(double& longest) const;

    const ScenePieces& pieces_;
    const ChosenPieces& kept_;
    const BoundingBox& box_;
    double flat_;  ///< m
};

}  // namespace REALCAM_NAMESPACE
