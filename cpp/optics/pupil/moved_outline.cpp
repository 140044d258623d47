#include "moved_outline.hpp"

#include <vector>

namespace realcam {

namespace {

constexpr int kAzimuths = PupilOutline::kAzimuths, kTurn = 2 * kAzimuths;

double cross(Vec2<double> a, Vec2<double> b) {
    return a.x * b.y - a.y * b.x;
}

using Reaches = double (PupilOutline::*)[kAzimuths + 1];

/// Sets one edge of the moved outline. Returns false if the edge does not surround the centre of the box.
bool move_edge(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to, Reaches edge,
               OutlineHalves& moved) {
    std::vector<Vec2<double>> corners;
    for (int i = 0; i <= kTurn; ++i) {
        const TurnAzimuth at(i % kTurn);
        const double reach = (outline[at.half].*edge)[at.azimuth];
        if (!(reach > 0)) return false;
        corners.push_back(
            {(from.centre().l + reach * from.half_width() * at.direction.x - to.centre().l) / to.half_width(),
             (from.centre().m + reach * from.half_height() * at.direction.y - to.centre().m) / to.half_height()});
    }
    const auto is_beyond = [&](Vec2<double> direction, std::size_t corner) {
        return cross(corners[corner], direction) >= 0;
    };
    std::size_t side = 0;
    for (int i = 0; i < kTurn; ++i) {
        const TurnAzimuth at(i);
        std::size_t tries = 0;
        while (!(is_beyond(at.direction, side) && !is_beyond(at.direction, side + 1))) {
            side = (side + 1) % kTurn;
            if (++tries > kTurn) return false;
        }
        const Vec2<double> along = {corners[side + 1].x - corners[side].x, corners[side + 1].y - corners[side].y};
        (moved[at.half].*edge)[at.azimuth] = cross(corners[side], along) / cross(at.direction, along);
    }
    for (const int end : {0, kAzimuths}) (moved[1].*edge)[end] = (moved[0].*edge)[end];
    return true;
}

bool has_hole(const OutlineHalves& outline) {
    return outline[0].inner[0] > 0;
}

}  // namespace

TurnAzimuth::TurnAzimuth(int i) : half(i > kAzimuths), azimuth(half ? kTurn - i : i) {
    const PupilDirection d = PupilOutline::direction(azimuth);
    direction = {d.l, half ? -d.m : d.m};
}

OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to) {
    OutlineHalves moved;
    if (!move_edge(outline, from, to, &PupilOutline::outer, moved)) return {};
    if (has_hole(outline) && !move_edge(outline, from, to, &PupilOutline::inner, moved)) return {};
    return moved;
}

}  // namespace realcam
