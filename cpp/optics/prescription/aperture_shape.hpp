#pragma once
#include <string>
#include <vector>

#include "../../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Outline of a surface's clear aperture.
enum class ApertureOutline { circle, ellipse, rectangle, polygon };

/// An opaque rectangle or ellipse on a surface. A circle is an ellipse with equal semi-axes; a spider arm is a
/// rectangle with one end at the vertex.
struct Obscuration {
    bool is_rectangle = false;
    Vec2d half = {0, 0};  ///< half widths or semi-axes, mm
    Vec2d offset = {0, 0};  ///< centre relative to the vertex, mm
    double angle_deg = 0;  ///< rotation about its centre, from x towards y

    bool operator==(const Obscuration&) const = default;
};

/// Axis-aligned rectangle.
struct ApertureBox {
    Vec2d low, high;  ///< corners, mm
};

/// Clear aperture of a surface inside the circle of its clear semi-diameter about the vertex. Lengths in mm.
struct ApertureShape {
    ApertureOutline kind = ApertureOutline::circle;
    /// Semi-axes of the ellipse, or half widths of the rectangle. Circle: both are its radius, or 0 for the clear
    /// semi-diameter. Not used by a polygon.
    Vec2d half = {0, 0};
    Vec2d offset = {0, 0};  ///< centre relative to the vertex; added to a polygon's corners
    std::vector<Vec2d> corners;  ///< polygon's corners, in order along its outline
    std::vector<Obscuration> obscurations;  ///< blocked parts inside the outline

    bool operator==(const ApertureShape&) const = default;

    /// True if the aperture is exactly the circle of the clear semi-diameter.
    bool is_plain() const { return kind == ApertureOutline::circle && half == Vec2d{0, 0} && obscurations.empty(); }
    /// Returns the reason why the aperture is not rotationally symmetric, for example "has a rectangular aperture";
    /// empty if it is.
    std::string asymmetry() const;
    /// Returns the shape with all lengths multiplied by `factor`.
    ApertureShape scaled(double factor) const;
    /// Returns the bounding box of the part of the outline inside a rim of radius `rim` about the vertex, mm.
    /// Obscurations do not reduce it.
    ApertureBox box(double rim) const;
    /// Returns the radius of a circle about the vertex that encloses the outline, mm; 0 if the outline is the circle of
    /// the clear semi-diameter.
    double reach() const;
};

/// Returns `count` spider arms of this width and length, mm, from the vertex outwards at equal angles. The first one
/// makes the angle `angle_deg` with the x axis.
std::vector<Obscuration> spider_arms(int count, double width, double length, double angle_deg);

}  // namespace REALCAM_NAMESPACE
