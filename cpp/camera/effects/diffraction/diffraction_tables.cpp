#include "diffraction_tables.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "../../../math/sampling_tables.hpp"
#include "../../../optics/pupil/pupil_track.hpp"

namespace realcam {

DiffractionTables::DiffractionTables(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
    : film_radius_(film_radius),
      radii_(has_blades(lens) ? kRadiiWithBlades : kRadii),
      azimuths_(has_blades(lens) ? kAzimuths : 1) {
    const PupilLens with_blades = PupilLens::with_blades(lens, tracer);
    const std::vector<DirectionBox> boxes = boxes_of(lens, tracer);
    std::vector<std::optional<ApertureDiffraction>> found(static_cast<std::size_t>(radii_ * azimuths_));
    tracer.for_each(radii_ * azimuths_, [&](int node) {
        const int row = node / azimuths_;
        if (const auto edges = pupil_edges(with_blades, radius_of(row), azimuth_of(node % azimuths_),
                                           boxes[static_cast<std::size_t>(row)]))
            found[static_cast<std::size_t>(node)] = diffraction_of(*edges);
    });
    for (int node = 0; node < radii_ * azimuths_; ++node) {
        auto& here = found[static_cast<std::size_t>(node)];
        // At the edge of the image, where the light is a crescent, the aperture of the next smaller film radius is
        // used.
        if (!here && node >= azimuths_) here = found[static_cast<std::size_t>(node - azimuths_)];
        if (!here) throw no_light(lens);
        add(*here);
    }
}

DiffractionView DiffractionTables::view(double film_steradians) const {
    return {nodes_.data(),
            entries_.data(),
            edges_.data(),
            radii_,
            azimuths_,
            static_cast<float>((radii_ - 1) / film_radius_),
            static_cast<float>(film_radius_),
            kSamplesPerSplat * nodes_.front().edge_share / static_cast<float>(film_steradians)};
}

double DiffractionTables::azimuth_of(int sector) const {
    const double angle = 4.0 * sector / azimuths_;
    return std::atan2(1 - std::fabs(std::remainder(angle - 1, 4)), 1 - std::fabs(std::remainder(angle, 4)));
}

std::vector<DirectionBox> DiffractionTables::boxes_of(const LensSystem& lens, const PupilTracer& tracer) const {
    const PupilSearch search(lens, FilmMap::radial, tracer);
    PupilTrack track;
    std::vector<DirectionBox> boxes;
    for (int row = 0; row < radii_; ++row) {
        const std::optional<DirectionBox> box = track.find(search, radius_of(row));
        if (!box && boxes.empty()) throw no_light(lens);
        boxes.push_back(box ? *box : boxes.back());
    }
    return boxes;
}

void DiffractionTables::add(const ApertureDiffraction& diffraction) {
    nodes_.push_back({static_cast<float>(1e-6 / diffraction.width), static_cast<float>(diffraction.edge_share)});
    std::vector<double> lengths(kDiffractionEdges, 0.0);
    const std::size_t first = edges_.size();
    edges_.resize(first + kDiffractionEdges);
    for (std::size_t k = 0; k < diffraction.edges.size(); ++k) {
        lengths[k] = diffraction.edges[k].length;
        edges_[first + k] = diffraction.edges[k].edge;
    }
    append_alias_table(lengths, entries_);
    append_alias_table(diffraction.cells, entries_);
}

StarburstTables::StarburstTables(const LensSystem& lens, double film_radius,
                                 std::shared_ptr<const DirectLensPath> direct_path, const PupilTracer& tracer)
    : direct_path_(std::move(direct_path)) {
    const EntrancePupilSearch<FilmRings> search(lens, film_radius, tracer);
    const std::vector<FoundRay> found = search.find_rays(lens, crossings_of(lens));
    directions_ = FilmRings::directions_of({found});
    entries_ = entries_of<FilmRings>(found, directions_);
}

GhostView StarburstTables::view() const {
    GhostView view = direct_path_->view(GhostLight::starbursts, kSamplesPerSplat);
    view.entries = entries_.data();
    view.largest_half_tangent = directions_.largest;
    return view;
}

}  // namespace realcam
