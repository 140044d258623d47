#pragma once
#include <vector>

#include "../analysis/object_point.hpp"
#include "../trace/lens_path.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Direct path to the film through a copy of a lens at several wavelengths. The shapes of the surfaces are prepared
/// once for all wavelengths, because preparing a freeform takes longer than tracing it.
class CopyPath {
public:
    CopyPath(const LensSystem& lens, const std::vector<double>& wavelengths_nm);

    /// View for tracing at one of the wavelengths; valid as long as the CopyPath.
    struct WavelengthView {
        LensView<double> view;
        double entry_position, entry_index;  ///< see LensPath
    };
    /// `wavelength`: index in the list of wavelengths.
    WavelengthView at(std::size_t wavelength) const;

private:
    LensPath<double> first_;  ///< at the first wavelength
    std::vector<std::vector<SurfaceView<double>>> surfaces_;  ///< for each wavelength
    std::vector<double> entry_indices_;
};

/// Rays of one object point at one wavelength that fill the stop of the nominal lens, for tracing through copies of the
/// lens with errors. In a copy, the surfaces in front of the stop displace the rays on the stop. All rays are then
/// shifted, so that the chief ray passes the centre of the stop again.
class FieldFan {
public:
    /// `azimuth_cos`, `azimuth_sin`: unit vector of the direction in which the field lies; (0, 1) is towards y, as in
    /// FieldPoint. `rings`: number of rings of rays in the stop (gauss_rings). Throws InputError if no ray reaches the
    /// stop, and Cancelled if `loop` is cancelled.
    FieldFan(const LensSystem& nominal, double wavelength_nm, const FieldPoint& field, double azimuth_cos,
             double azimuth_sin, int rings, const RayLoop& loop);

    /// Ray behind the lens.
    struct FilmRay {
        Vec2<double> at;  ///< intersection with the plane z = 0 through the last vertex, mm
        Vec2<double> slope;  ///< dx / dz, dy / dz
        double weight;  ///< fraction of the stop's area that the ray represents; 0: the ray does not pass
    };

    /// Result of trace_copy.
    struct Traced {
        FilmRay chief;  ///< chief ray; its weight is 0 if it does not pass
        std::vector<FilmRay> rays;
    };

    /// Traces the rays through a copy. `copy`: the copy at the wavelength of the fan; `stop`: index of the stop;
    /// `rays`: false traces only the chief ray.
    Traced trace_copy(const CopyPath::WavelengthView& copy, int stop, bool rays = true) const;

    /// Returns the sum of the weights of all rays of the nominal lens.
    double total_weight() const;

private:
    /// Rotates a vector from the frame of FieldPoint (field in the y-z plane) to the azimuth of the field, and back.
    Vec2<double> to_azimuth(Vec2<double> v) const;
    Vec2<double> from_azimuth(Vec2<double> v) const;
    /// Starts N rays at these entry points of the object point.
    template <int N>
    void start(const CopyPath::WavelengthView& copy, const Vec2<double>* entries, LensRays<double, N>& rays) const;
    /// Returns the intersection of the nominal chief ray with the copy's stop, relative to its centre, in the frame of
    /// FieldPoint, mm.
    Vec2<double> chief_ray_miss(const CopyPath::WavelengthView& copy, int stop) const;

    ObjectPoint object_;  ///< field point at azimuth y
    double cos_, sin_;  ///< rotation about the axis, from y to the field's azimuth
    Vec2<double> chief_;  ///< entry point of the nominal chief ray
    Vec2<double> by_x_, by_y_;  ///< derivatives of the entry point by x and y on the stop
    std::vector<Vec2<double>> entries_;  ///< entry points of the rays, padded to whole blocks of lanes
    std::vector<double> weights_;  ///< see FilmRay; 0 for padding
};

}  // namespace REALCAM_NAMESPACE
