#pragma once
#include <optional>
#include <string>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Base shape to which the other terms of the sag are added. The radius and conic of Surface belong to the section in
/// the yz plane.
enum class BaseForm {
    conic,  ///< conic of revolution
    biconic,  ///< (c_x x^2 + c_y y^2) / (1 + sqrt(1 - (1 + k_x) c_x^2 x^2 - (1 + k_y) c_y^2 y^2))
    toroid,  ///< the section in the yz plane, including its even terms of y, rotated about a line parallel to y
};

/// Term of the sag: coefficient x^i y^j, in mm^(1 - i - j).
struct XyTerm {
    int x, y;
    double coefficient;

    bool operator==(const XyTerm&) const = default;
};

enum class ZernikeOrder {
    noll,  ///< Noll's order, each term with an RMS of 1 over the circle ("Zernike standard")
    fringe,  ///< the order of the University of Arizona, each term of amplitude 1 at the rim
};

/// Sum of Zernike polynomials over a circle, mm. The azimuth counts from the x axis towards y.
struct ZernikeTerms {
    ZernikeOrder order = ZernikeOrder::noll;
    double radius = 1;  ///< radius of the circle, mm
    std::vector<double> coefficients;  ///< from the first term on, mm

    bool operator==(const ZernikeTerms&) const = default;
};

enum class ForbesKind {
    bfs,  ///< Q^bfs: departure from a sphere, u^2 (1 - u^2) / sqrt(1 - c^2 r^2) times a sum of Q_m(u^2)
    con,  ///< Q^con: departure from a conic, u^4 times a sum of Q_m(u^2)
};

/// G. W. Forbes, "Shape specification for axially symmetric optical surfaces", Opt. Express 15, 5218 (2007), with
/// u = r / radius.
struct ForbesTerms {
    ForbesKind kind = ForbesKind::bfs;
    double radius = 1;                 ///< mm
    std::vector<double> coefficients;  ///< a_0, a_1, ..., mm

    bool operator==(const ForbesTerms&) const = default;
};

/// Sag of a surface beyond a conic of revolution and its even aspheric terms. All parts are added.
struct SurfaceForm {
    BaseForm base = BaseForm::conic;
    double curvature_x = 0;  ///< biconic: in the xz plane; toroid: 1 / distance from the vertex to the line; 1/mm
    double conic_x = 0;  ///< biconic: in the xz plane
    std::vector<double> radial;  ///< coefficients of r, r^2, r^3, ..., 1, mm^-1, mm^-2, ...
    std::vector<XyTerm> xy;
    std::optional<ZernikeTerms> zernike;
    std::optional<ForbesTerms> forbes;

    bool operator==(const SurfaceForm&) const = default;

    /// True if the surface is a conic of revolution with at most even aspheric terms.
    bool is_none() const;
    /// Returns the form with all lengths multiplied by `factor`.
    SurfaceForm scaled(double factor) const;
    /// Returns the form with its sag negated.
    SurfaceForm turned() const;
    /// Reason why the form is not rotationally symmetric: "is toroidal"; empty if it is.
    std::string asymmetry() const;
};

}  // namespace REALCAM_NAMESPACE
