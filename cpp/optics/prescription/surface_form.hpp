#pragma once
#include <optional>
#include <string>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// What the sag of a surface begins with. Its own radius and conic are those of the section in the yz plane.
enum class BaseForm {
    conic,     ///< of revolution
    biconic,   ///< (c_x x^2 + c_y y^2) / (1 + sqrt(1 - (1 + k_x) c_x^2 x^2 - (1 + k_y) c_y^2 y^2))
    toroid,    ///< the section in the yz plane, even terms of y with it, turned about a line parallel to y
};

/// A term of the sag: coefficient x^i y^j, mm^(1 - i - j).
struct XyTerm {
    int x, y;
    double coefficient;

    bool operator==(const XyTerm&) const = default;
};

enum class ZernikeOrder {
    noll,    ///< Noll's order, each term of unit root mean square over the circle ("Zernike standard")
    fringe,  ///< the order of the University of Arizona, each term of amplitude 1 at the rim
};

/// The sum of Zernike polynomials over a circle, mm. The azimuth counts from the x axis towards y.
struct ZernikeTerms {
    ZernikeOrder order = ZernikeOrder::noll;
    double radius = 1;                 ///< of the circle, mm
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

/// What the sag of a surface is beside a conic of revolution and its even asphere. The parts are added up.
struct SurfaceForm {
    BaseForm base = BaseForm::conic;
    double curvature_x = 0;  ///< biconic: in the xz plane; toroid: 1 / distance from the vertex to the line; 1/mm
    double conic_x = 0;      ///< biconic: in the xz plane
    std::vector<double> radial;  ///< coefficients of r, r^2, r^3, ..., 1, mm^-1, mm^-2, ...
    std::vector<XyTerm> xy;
    std::optional<ZernikeTerms> zernike;
    std::optional<ForbesTerms> forbes;

    bool operator==(const SurfaceForm&) const = default;

    /// Whether there is no such part.
    bool is_none() const;
    /// With all lengths times `factor`.
    SurfaceForm scaled(double factor) const;
    /// With the sag turned over.
    SurfaceForm turned() const;
    /// Empty: the form is one of revolution. Else what it is: "is toroidal".
    std::string asymmetry() const;
};

}  // namespace REALCAM_NAMESPACE
