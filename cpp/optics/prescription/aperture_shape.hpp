#pragma once
#include <string>
#include <vector>

#include "../../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

enum class ApertureOutline { circle, ellipse, rectangle, polygon };

/// A piece in a surface's way that light does not pass. All of them are rectangles or ellipses; a circle is an ellipse,
/// and the arm of a spider a rectangle that begins in the middle.
struct Obscuration {
    bool is_rectangle = false;
    Vec2d half = {0, 0};  ///< half widths or semi-axes, mm
    Vec2d offset = {0, 0};  ///< of its middle from the vertex, mm
    double angle_deg = 0;  ///< by which it is turned about its middle, from x towards y

    bool operator==(const Obscuration&) const = default;
};

/// A rectangle along the axes.
struct ApertureBox {
    Vec2d low, high;  ///< corners, mm
};

/// What a surface leaves open, beside the circle of its clear semi-diameter about the vertex. Lengths in mm.
struct ApertureShape {
    ApertureOutline kind = ApertureOutline::circle;
    Vec2d half = {0, 0};  ///< semi-axes or half widths; of a circle both are its radius, 0: the clear semi-diameter's
    Vec2d offset = {0, 0};  ///< of the middle from the vertex; of a polygon added to its corners
    std::vector<Vec2d> corners;  ///< of a polygon, one after the other
    std::vector<Obscuration> obscurations;

    bool operator==(const ApertureShape&) const = default;

    /// Whether the circle of the clear semi-diameter says it all.
    bool is_plain() const { return kind == ApertureOutline::circle && half == Vec2d{0, 0} && obscurations.empty(); }
    /// Empty: open alike in all directions. Else what it is: "has a rectangular aperture".
    std::string asymmetry() const;
    /// With all lengths times `factor`.
    ApertureShape scaled(double factor) const;
    /// The rectangle that holds what is open inside a rim about the vertex.
    ApertureBox box(double rim) const;
    /// Radius of the circle about the vertex that holds it, mm; 0: it is that of the clear semi-diameter.
    double reach() const;
};

/// The arms of a spider: `count` of them, of a width, from the vertex to `length`. The first one makes an angle with
/// the x axis.
std::vector<Obscuration> spider_arms(int count, double width, double length, double angle_deg);

}  // namespace REALCAM_NAMESPACE
