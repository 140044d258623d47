#pragma once
#include <algorithm>
#include <limits>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Optical direction cosines of a ray that travels from the film to the scene.
struct PupilDirection {
    double l, m;
};

/// Bounding box of a set of directions.
struct DirectionBox {
    double l_min, l_max, m_min, m_max;

    static DirectionBox none() {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        return {kFar, -kFar, kFar, -kFar};
    }
    static DirectionBox around(PupilDirection d, double half_width, double half_height) {
        return {d.l - half_width, d.l + half_width, d.m - half_height, d.m + half_height};
    }
    PupilDirection centre() const { return {0.5 * (l_min + l_max), 0.5 * (m_min + m_max)}; }
    double half_width() const { return 0.5 * (l_max - l_min); }
    double half_height() const { return 0.5 * (m_max - m_min); }

    DirectionBox with(PupilDirection d) const {
        return {std::min(l_min, d.l), std::max(l_max, d.l), std::min(m_min, d.m), std::max(m_max, d.m)};
    }
    DirectionBox joined_with(const DirectionBox& other) const {
        return {std::min(l_min, other.l_min), std::max(l_max, other.l_max), std::min(m_min, other.m_min),
                std::max(m_max, other.m_max)};
    }
    DirectionBox grown_by(double width, double height) const {
        return {l_min - width, l_max + width, m_min - height, m_max + height};
    }
    /// True if each side lies inside the searched box, or the searched box reaches the widest one on that side.
    bool lies_in(const DirectionBox& searched, const DirectionBox& widest) const {
        return (l_min > searched.l_min || searched.l_min <= widest.l_min) &&
               (l_max < searched.l_max || searched.l_max >= widest.l_max) &&
               (m_min > searched.m_min || searched.m_min <= widest.m_min) &&
               (m_max < searched.m_max || searched.m_max >= widest.m_max);
    }
    /// Linear extrapolation: this box, moved on from `before` by `steps` times the step between the two.
    DirectionBox moved_on_from(const DirectionBox& before, double steps) const {
        const auto ahead = [steps](double now, double then) { return now + steps * (now - then); };
        return {ahead(l_min, before.l_min), ahead(l_max, before.l_max), ahead(m_min, before.m_min),
                ahead(m_max, before.m_max)};
    }
};

}  // namespace REALCAM_NAMESPACE
