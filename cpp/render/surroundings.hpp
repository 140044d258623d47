#pragma once
#include <limits>

#include "scene_pieces.hpp"

namespace REALCAM_NAMESPACE {

/// Finds what a picture of a scene is of, which is not always the whole scene: an object on a wide floor under a sky
/// is the object.
///
/// Surroundings are taken away, one after the other, as long as what is left is less than a third as large (diagonals
/// of boxes). So an object of one piece, a room and its furniture, or a table and what stands on it stay whole. They
/// are floors and walls (SheetFinder), and what lies beyond a wide gap (GapFinder). Single long triangles, such as the
/// sides of a slab, have to be more than three times as long as what is left.
class Surroundings {
public:
    explicit Surroundings(const Assembly& assembly);

    /// The bounding box of what is left.
    const BoundingBox& box() const { return box_; }
    /// f(number, piece) for what is left.
    template <class F>
    void for_each(F&& f) const {
        pieces_.for_chosen(kept_, f);
    }

private:
    static constexpr double kMuchSmaller = 1.0 / 3;

    BoundingBox box_of(const ChosenPieces& chosen) const;

    /// Keeps the chosen pieces alone, if they are there and so much smaller than all, and than this length, m.
    bool keep(ChosenPieces chosen, double length_m = std::numeric_limits<double>::infinity());

    bool take_away();

    ScenePieces pieces_;
    ChosenPieces kept_;
    BoundingBox box_;
};

}  // namespace REALCAM_NAMESPACE
