#pragma once
#include <vector>

#include "../pupil/diffraction_cells.hpp"
#include "../pupil/pupil_edges.hpp"

namespace REALCAM_NAMESPACE {

/// Fraunhofer diffraction of light of one direction by an aperture: the normalised square of the aperture's Fourier
/// transform. Frequencies are in periods over `width`; fractions are of all light.
struct ApertureDiffraction {
    double width;  ///< longer side of the aperture's bounding box, optical direction cosines
    std::vector<double> cells;  ///< fractions of light in the cells of diffraction_cells.hpp
    double edge_share;  ///< fraction of light beyond the cells, which the edges diffract
    struct Edge {
        double length;  ///< in units of `width`
        DiffractionEdge edge;
    };
    std::vector<Edge> edges;
    double found_share;  ///< sum over cells and edges before normalisation to 1
};

namespace aperture_diffraction_detail {

using Point = Vec2<double>;

/// Direction of the outward normal, in turns.
double normal_angle(Point from, Point to);

}  // namespace aperture_diffraction_detail

/// Computes the diffraction of a uniformly illuminated aperture. Beyond the cells its light is that of the edges, which
/// spread it along their normals as one over the square of the frequency (method of stationary phase); the error there
/// is a tenth of the rings' variation.
ApertureDiffraction diffraction_of(const PupilEdges& edges);

}  // namespace REALCAM_NAMESPACE
