#pragma once
#include <algorithm>
#include <limits>
#include <optional>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Optical direction cosines of a ray that travels from the film to the scene.
struct PupilDirection {
    double l, m;
};

/// Bounding box of a set of directions that is symmetric in m.
struct PupilBox {
    double l_min, l_max, m_max;

    static PupilBox none() {
        return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0};
    }
    double l() const { return 0.5 * (l_min + l_max); }
    double half_width() const { return 0.5 * (l_max - l_min); }
    PupilBox with(PupilDirection d) const { return {std::min(l_min, d.l), std::max(l_max, d.l), std::max(m_max, d.m)}; }
    /// True if each side lies inside the searched box, or the searched box reaches the widest one on that side.
    bool lies_in(const PupilBox& searched, const PupilBox& widest) const {
        return (l_min > searched.l_min || searched.l_min <= widest.l_min) &&
               (l_max < searched.l_max || searched.l_max >= widest.l_max) &&
               (m_max < searched.m_max || searched.m_max >= widest.m_max);
    }
    PupilBox grown(double share) const {
        const double w = share * 2 * half_width(), h = share * m_max;
        return {l_min - w, l_max + w, m_max + h};
    }
};

/// Boxes found so far, from the axis outwards. The edges of the region move smoothly, so the last two boxes predict the
/// next: near the edge of the image circle the region is a sliver that moves by more than its own width.
struct PupilTrack {
    struct Seen {
        double radius;
        PupilBox box;
    };
    std::optional<Seen> last, before;

    void add(double radius, const PupilBox& box) {
        before = last;
        last = Seen{radius, box};
    }
    PupilBox search_at(double radius) const {
        PupilBox box = last->box;
        if (before) {
            const double f = (radius - last->radius) / (last->radius - before->radius);
            const auto ahead = [f](double now, double then) { return now + f * (now - then); };
            box.l_min = std::min(box.l_min, ahead(box.l_min, before->box.l_min));
            box.l_max = std::max(box.l_max, ahead(box.l_max, before->box.l_max));
            box.m_max = std::max(box.m_max, ahead(box.m_max, before->box.m_max));
        }
        return box.grown(0.4);
    }
};

}  // namespace REALCAM_NAMESPACE
