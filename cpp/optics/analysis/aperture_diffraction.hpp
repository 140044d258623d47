#pragma once
#include <vector>

#include "../pupil/diffraction_cells.hpp"
#include "../pupil/pupil_edges.hpp"

namespace REALCAM_NAMESPACE {

/// Where an aperture spreads light of one direction, by the square of its Fourier transform (Fraunhofer diffraction).
/// Frequencies are in periods over `width`; shares are of all light.
struct ApertureDiffraction {
    double width;  ///< the longer side of the box around the aperture, optical direction cosines
    std::vector<double> cells;  ///< shares of the cells of diffraction_cells.hpp
    double edge_share;          ///< of the light beyond the cells, which comes from the edges
    struct Edge {
        double length;  ///< in widths
        DiffractionEdge edge;
    };
    std::vector<Edge> edges;
    double found_share;  ///< what cells and edges have before they are scaled to 1
};

namespace aperture_diffraction_detail {

using Point = Vec2<double>;

/// Direction of the outward normal, in turns.
double normal_angle(Point from, Point to);

}  // namespace aperture_diffraction_detail

/// The diffraction of an aperture that is evenly lit. Beyond the cells its light is that of its edges, which spread it
/// along their normals as one over the square of the frequency. This is the method of stationary phase; its error there
/// is a tenth of the rings' variation.
ApertureDiffraction diffraction_of(const PupilEdges& edges);

}  // namespace REALCAM_NAMESPACE
