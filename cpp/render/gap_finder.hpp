#pragma once
#include <bitset>

#include "../scene/bounding_box.hpp"
#include "scene_pieces.hpp"

namespace REALCAM_NAMESPACE {

/// Finds a gap about the middle of what a picture is of: a shell that no piece touches, whose outer radius is eight
/// times the inner. What lies beyond is no part of the subject in two cases. It may surround what lies within, as a sky
/// does: it is seen in 40% or more of the directions. Or it is far away and little: at most a tenth of the pieces and
/// of their area.
class GapFinder {
public:
    GapFinder(const ScenePieces& pieces, const BoundingBox& box) : pieces_(pieces), box_(box) {}

    /// What lies within a gap that parts surroundings off; nothing where there is none.
    ChosenPieces within(const ChosenPieces& among) const;

private:
    static constexpr double kSeenAround = 0.4, kLittle = 0.1;
    static constexpr double kLeastSubject = 4;  ///< triangles: a stray one in a hollow object is no subject

    /// Every so many of the chosen pieces.
    std::vector<Piece> some_of(const ChosenPieces& chosen) const;

    /// The median of the pieces' middles, each coordinate by itself. A piece counts by its size to minus this power: 0
    /// is all alike; 4 lets even a box of 12 triangles count more than a sky of thousands of large ones.
    Vec3d median(const std::vector<Piece>& among, int power) const;

    /// What could be the middle of the subject. It is the median of all pieces, or that of the finest detail. For a
    /// small object under a sky it is one of the pieces nearest to the middle of the scene and of its lower side,
    /// whether y or z is up.
    std::vector<Vec3d> possible_middles(const ChosenPieces& among, const std::vector<Piece>& some) const;

    bool is_background(const ChosenPieces& among, const ChosenPieces& inside, Vec3d centre) const;

    /// Cells of a cube about the centre, four by four on each face.
    static constexpr std::size_t kDirections = 96;
    static std::size_t direction_of(Vec3d d);

    const ScenePieces& pieces_;
    const BoundingBox& box_;
};

}  // namespace REALCAM_NAMESPACE
