#pragma once
#include <algorithm>
#include <limits>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Direction of a ray from the film to the scene: x and y of its unit vector times the refractive index (optical
/// direction cosines).
struct PupilDirection {
    double l, m;
};

/// Bounding box of a set of directions, in optical direction cosines.
struct DirectionBox {
    double l_min, l_max, m_min, m_max;

    /// Returns the box of an empty set of directions.
    static DirectionBox empty() {
        constexpr double kInf = std::numeric_limits<double>::infinity();
        return {kInf, -kInf, kInf, -kInf};
    }
    /// Returns the box with this centre.
    static DirectionBox around(PupilDirection d, double half_width, double half_height) {
        return {d.l - half_width, d.l + half_width, d.m - half_height, d.m + half_height};
    }
    PupilDirection centre() const { return {0.5 * (l_min + l_max), 0.5 * (m_min + m_max)}; }
    double half_width() const { return 0.5 * (l_max - l_min); }
    double half_height() const { return 0.5 * (m_max - m_min); }

    /// Returns the smallest box that contains this box and a direction.
    DirectionBox extended_to(PupilDirection d) const {
        return {std::min(l_min, d.l), std::max(l_max, d.l), std::min(m_min, d.m), std::max(m_max, d.m)};
    }
    /// Returns the smallest box that contains both boxes.
    DirectionBox joined_with(const DirectionBox& other) const {
        return {std::min(l_min, other.l_min), std::max(l_max, other.l_max), std::min(m_min, other.m_min),
                std::max(m_max, other.m_max)};
    }
    /// Moves the left and right sides outwards by `width`, and the upper and lower sides by `height`.
    DirectionBox grown_by(double width, double height) const {
        return {l_min - width, l_max + width, m_min - height, m_max + height};
    }
    /// True if each side lies strictly inside the box `searched`, or if `searched` extends to the box `widest` of all
    /// possible directions on that side.
    bool is_enclosed_by(const DirectionBox& searched, const DirectionBox& widest) const {
        return (l_min > searched.l_min || searched.l_min <= widest.l_min) &&
               (l_max < searched.l_max || searched.l_max >= widest.l_max) &&
               (m_min > searched.m_min || searched.m_min <= widest.m_min) &&
               (m_max < searched.m_max || searched.m_max >= widest.m_max);
    }
    /// Box in which to expect the next region of a succession in which this one follows `previous`: this box and its
    /// linear extrapolation, by `steps` times its change from `previous`.
    DirectionBox expected_after(const DirectionBox& previous, double steps) const {
        const auto extrapolated = [steps](double current, double earlier) {
            return current + steps * (current - earlier);
        };
        return joined_with({extrapolated(l_min, previous.l_min), extrapolated(l_max, previous.l_max),
                            extrapolated(m_min, previous.m_min), extrapolated(m_max, previous.m_max)});
    }
};

}  // namespace REALCAM_NAMESPACE
