#pragma once
#include <vector>

#include "../analysis/object_point.hpp"
#include "../trace/lens_path.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Direct path to the film through one lens at several wavelengths. The shapes of the surfaces are prepared once for
/// all wavelengths, because preparing a freeform takes longer than tracing it.
class CopyPath {
public:
    CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm);

    /// View for tracing at one of the wavelengths; valid as long as the path.
    struct At {
        LensView<double> view;
        double entry_position, entry_index;  ///< see LensPath
    };
    At at(std::size_t wavelength) const;

private:
    LensPath<double> first_;
    std::vector<std::vector<SurfaceView<double>>> surfaces_;  ///< for each wavelength
    std::vector<double> entry_indices_;
};

/// Rays of one object point at one wavelength that fill the stop of the nominal lens. In a copy, slightly different
/// surfaces in front of the stop displace them on it: all rays are shifted so that the chief ray passes the stop's
/// centre again.
class FieldFan {
public:
    /// `azimuth_cos`, `azimuth_sin`: direction in which the field angle counts; (0, 1) is towards y, as in FieldPoint.
    /// Throws InputError if no ray reaches the stop.
    FieldFan(const LensSystem& nominal, double wavelength_nm, const FieldPoint& field, double azimuth_cos,
             double azimuth_sin, int rings, const RayLoop& loop);

    struct FilmRay {
        Vec2<double> at;  ///< mm, on the plane of the last vertex
        Vec2<double> slope;  ///< dx / dz, dy / dz
        double weight;  ///< fraction of the stop's area; 0: the ray does not pass
    };

    struct Traced {
        FilmRay chief;  ///< included even if it does not pass
        std::vector<FilmRay> rays;
    };

    /// Traces the fan through a copy at the fan's wavelength. `rays`: false traces the chief ray only.
    Traced through(const CopyPath::At& copy, int stop, bool rays = true) const;

    /// Sum of the weights of all rays.
    double full_weight() const;

private:
    Vec2<double> turned(Vec2<double> v) const;
    Vec2<double> turned_back(Vec2<double> v) const;
    template <int N>
    void start(const CopyPath::At& copy, const Vec2<double>* entries, LensRays<double, N>& rays) const;
    Vec2<double> miss(const CopyPath::At& copy, int stop) const;

    ObjectPoint object_;
    double cos_, sin_;  ///< rotation about the axis, from y to the field's azimuth
    Vec2<double> chief_;
    Vec2<double> by_x_, by_y_;  ///< derivatives of the entry point by x and y on the stop
    std::vector<Vec2<double>> entries_;
    std::vector<double> weights_;
};

}  // namespace REALCAM_NAMESPACE
