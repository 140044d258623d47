#pragma once
#include <vector>

#include "../pupil/diffraction_cells.hpp"
#include "../pupil/pupil_edges.hpp"

namespace REALCAM_NAMESPACE {

/// Fraunhofer diffraction pattern of an aperture: the squared magnitude of the aperture's Fourier transform, normalised
/// to a total of 1. The unit of frequencies is one period over `width`.
struct ApertureDiffraction {
    double width;  ///< longer side of the aperture's bounding box, in optical direction cosines
    std::vector<double>
        cells;  ///< fraction of the light in each cell of diffraction_cells.hpp: stored ring * azimuths + azimuth
    double edge_share;  ///< fraction of the light at frequencies beyond the cells, represented by the edges
    /// Segment of the aperture's edge.
    struct Edge {
        double length;  ///< in units of `width`
        DiffractionEdge edge;
    };
    std::vector<Edge> edges;
    double found_share;  ///< sum of all fractions before normalisation; differs from 1 by the numerical error
};

namespace aperture_diffraction_detail {

using Point = Vec2<double>;

/// Azimuth of the outward normal of a side of a counter-clockwise polygon, in turns from -1/2 to 1/2.
double normal_angle(Point from, Point to);

}  // namespace aperture_diffraction_detail

/// Computes the diffraction pattern of a uniformly illuminated aperture. In the cells it is the Fourier transform of
/// the polygons. Beyond them, each edge diffracts light along its normal, with a density that falls as the inverse
/// square of the frequency (method of stationary phase). The error there is a tenth of the variation of the diffraction
/// rings.
ApertureDiffraction diffraction_of(const PupilEdges& edges);

}  // namespace REALCAM_NAMESPACE
