#pragma once
#include <vector>

#include "../analysis/object_point.hpp"
#include "../trace/ray_loop.hpp"
#include "copy_path.hpp"

namespace REALCAM_NAMESPACE {

/// The rays of one object point at one wavelength, as they fill the stop of the lens as it was drawn. A copy's stop is
/// met through slightly other surfaces in front of it: all rays are moved by what its chief ray misses the middle by.
class FieldFan {
public:
    /// `azimuth_cos`, `azimuth_sin`: of the direction from which the angle counts; (0, 1) is towards y, as FieldPoint
    /// has it. Throws InputError where no ray reaches the stop.
    FieldFan(const LensSystem& nominal, double wavelength_nm, const FieldPoint& field, double azimuth_cos,
             double azimuth_sin, int rings, const RayLoop& loop);

    struct FilmRay {
        Vec2<double> at;  ///< mm, on the plane of the last vertex
        Vec2<double> slope;  ///< dx / dz, dy / dz
        double weight;  ///< share of the stop's area; 0: the ray does not pass
    };

    struct Traced {
        FilmRay chief;  ///< whether or not it passes
        std::vector<FilmRay> rays;
    };

    /// Through a copy, at this fan's wavelength. `rays`: false leaves all but the chief ray out.
    Traced through(const CopyPath::At& copy, int stop, bool rays = true) const;

    /// The sum of all rays' weights.
    double full_weight() const;

private:
    Vec2<double> turned(Vec2<double> v) const;
    Vec2<double> turned_back(Vec2<double> v) const;
    template <int N>
    void start(const CopyPath::At& copy, const Vec2<double>* entries, LensRays<double, N>& rays) const;
    Vec2<double> miss(const CopyPath::At& copy, int stop) const;

    ObjectPoint object_;
    double cos_, sin_;  ///< of the turn about the axis from towards y
    Vec2<double> chief_;
    Vec2<double> by_x_, by_y_;  ///< how the entry moves with the place on the stop
    std::vector<Vec2<double>> entries_;
    std::vector<double> weights_;
};

}  // namespace REALCAM_NAMESPACE
