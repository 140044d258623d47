#include "surroundings.hpp"

#include <algorithm>
#include <utility>

#include "gap_finder.hpp"
#include "vast_sheets.hpp"

namespace realcam {

Surroundings::Surroundings(const Assembly& assembly) : pieces_(assembly), kept_(pieces_.count(), true) {
    box_ = box_of(kept_);
    while (take_away()) {
    }
}

BoundingBox Surroundings::box_of(const ChosenPieces& chosen) const {
    BoundingBox box;
    pieces_.for_chosen(chosen, [&](std::size_t, const Piece& piece) { box.add(piece.box); });
    return box;
}

bool Surroundings::keep(ChosenPieces chosen, double length_m) {
    const BoundingBox box = box_of(chosen);
    if (box.empty() || !(box.diagonal() <= kMuchSmaller * std::min(box_.diagonal(), length_m))) return false;
    kept_ = std::move(chosen);
    box_ = box;
    return true;
}

bool Surroundings::take_away() {
    const WithoutSheets rest = SheetFinder(pieces_, kept_, box_).rest();
    if (rest.any_left_out && keep(rest.chosen, rest.shortest_left_out)) return true;
    const GapFinder gap(pieces_, box_);
    return keep(gap.within(kept_)) || (rest.any_left_out && keep(gap.within(rest.chosen), rest.shortest_left_out));
}

}  // namespace realcam
