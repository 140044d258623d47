#pragma once
#include <array>
#include <vector>

#include "../pupil/bundle_quadrature.hpp"
#include "field_rays.hpp"
#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// Ray of one object point at the film plane.
struct FilmRay {
    bool passes;  ///< true if the ray reaches the film plane; other members are undefined if it does not
    Vec2<double> at;  ///< film point, mm from that of the chief ray
    Vec3d direction;  ///< unit vector
    double path;  ///< (optical path of the ray - that of the chief ray) / index behind the lens, mm
};

/// Ray as a plane wave on the film, relative to the spherical wave that converges from the exit pupil to the film point
/// of the chief ray.
struct WaveRay {
    Vec2<double>
        slope;  ///< gradient of the path along the film: direction cosines of the ray minus those of the sphere
    double path;  ///< at the film point of the chief ray, mm
};

/// All light of one object point at one wavelength (a Bundle of bundle_quadrature.hpp). The entry point of a ray is its
/// intersection with the entry plane (ObjectPoint::Entry), over which the light is uniform, except for `energy`.
class PointBundle {
public:
    using Entry = ObjectPoint::Entry;

    bool mirrored;  ///< true: the light is symmetric in x; false also if the iris has blades
    ObjectPoint object;
    Entry chief_entry;  ///< entry point of the chief ray
    Vec2<double> chief;  ///< film point of the chief ray, mm from the axis
    double index;  ///< refractive index behind the lens
    double wave_number;  ///< 2 pi index / wavelength, 1/mm
    Entry middle, reach;  ///< approximate bounds of the entry points that pass: centre and half-sides, mm
    Vec2<double> centroid;  ///< centroid of the spot, mm from the chief ray
    Vec2<double> spot;  ///< half sides of the spot's bounding rectangle centred on the chief ray, mm
    Vec2<double> slope_low, slope_high;  ///< bounds of the slopes (WaveRay) of the rays that pass

    static constexpr int kProbeRays = 40;  ///< default of the constructor's `probe_rays`

    /// `film_distance`: from the last vertex to the film, mm. `probe_rays`: number of rays across the diameter of the
    /// stop that locate the light; if too few of them pass, a denser probe follows. Throws InputError if the field
    /// point or the wavelength is invalid or no light reaches the film, and Cancelled if `loop` is cancelled.
    PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                const RayLoop& loop = {}, int probe_rays = kProbeRays);

    /// z of the film plane, mm behind the last vertex. For a curved film it is the plane through the film point of the
    /// chief ray.
    double plane() const { return plane_; }

    /// Sets passed[i] to true if the ray with entry point i passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        trace_lens(real_.view(), rays, PathRecord<double, N>{});
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Traces the rays with these entry points through the lens without rims, so that the neighbours of a ray at the
    /// edge of the light reach the film, too.
    template <int N>
    void trace(const Entry (&entries)[N], FilmRay (&found)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        PathRecord<double, N> record{};
        trace_lens(open_.view(), rays, record);
        for (int i = 0; i < N; ++i)
            found[i] = from_chief(rays.status[i] == 0, rays.origin[i], rays.direction[i],
                                  record.optical_path[i] + path_.entry_index * object.path_difference(entries[i]));
    }

    /// Converts a ray to a plane wave: path and direction of the ray at its film point, minus those of the sphere
    /// there. The sphere is common to all rays and does not change intensities. The differences are small, and the
    /// curvature of the wave is negligible as long as the film is far from the exit pupil.
    WaveRay as_wave(const FilmRay& ray) const;

    /// Returns the energy per area of the entry plane, relative to that at its centre. The light of the object point is
    /// uniform in solid angle.
    double energy(Entry entry) const;

private:
    static constexpr int kDenseProbeRays = 200;  ///< rays across the stop of the denser probe

    /// Returns the smallest number of passing probe rays that locate the light: 3/80 probe_rays^2, about a twentieth of
    /// the rays over the whole stop, but at least 20.
    static std::size_t min_passing(int probe_rays) {
        return static_cast<std::size_t>(std::max(3 * probe_rays * probe_rays / 80, 20));
    }

    /// Returns the lens. Throws InputError if the index of a glass is not known at the wavelength.
    static const LensSystem& with_known_glasses(const LensSystem& lens, double wavelength_nm);

    /// Traces probe rays over the whole stop, and denser ones if few of them pass. `probe_rays`: number of rays across
    /// the stop; it becomes that of the rays returned.
    static FieldRays probe(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, int& probe_rays,
                           const RayLoop& loop);

    /// Sets `middle`, `reach`, `centroid`, `spot`, and the bounds of slopes from probe rays on a square_grid of
    /// `probe_rays` rays across the stop.
    void measure(const FieldRays& rays, int probe_rays);

    /// Starts N rays at their entry points.
    template <int N>
    void start(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            rays.origin.set(i, object.at(entries[i]) - Vec3d{0, 0, path_.entry_position});
            rays.direction.set(i, path_.entry_index * object.direction(entries[i]));
            rays.status[i] = 0;
        }
    }

    /// Converts a ray behind the lens to one on the film plane, relative to the axis. `path`: optical path to `origin`,
    /// mm.
    FilmRay on_film(Vec3d origin, Vec3d direction, double path) const;
    /// Same, relative to the chief ray.
    FilmRay from_chief(bool passes, Vec3d origin, Vec3d direction, double path) const;

    LensPath<double> path_;
    AimingPath open_, real_;  ///< the lens without and with rims
    double plane_;
    double chief_path_;  ///< optical path of the chief ray to the film / index, mm
    double curvature_;  ///< 1 / distance from the exit pupil to the film point of the chief ray, 1/mm
    Vec3d chief_direction_;  ///< unit vector
};

/// Ray of a bundle, with the fraction of the light that it represents.
struct BundleRay {
    PointBundle::Entry entry;  ///< point of the entry plane, mm
    double energy;  ///< fraction of the energy of all rays
    Vec2<double> at;  ///< film point, mm from that of the chief ray
    Vec3d direction;  ///< unit vector, behind the lens
    WaveRay wave;
    double amplitude;  ///< square root of the energy per area of slopes; 0 if that is not defined
};

/// Segment of the edge of the light.
struct EdgePiece {
    std::array<PointBundle::Entry, 2> entry;  ///< end points on the entry plane, mm
    std::array<Vec2<double>, 2> slope;  ///< their slopes (WaveRay)
};

/// Ray bundle of one object point at one wavelength, with the edge of the light and the foci about the chief ray.
struct TracedBundle {
    std::vector<BundleRay> rays;
    std::vector<EdgePiece> edge;
    double tangential_focus,
        sagittal_focus;  ///< foci of rays close to the chief ray, mm behind the film plane; NaN if there is none
};

/// Traces the rays of a quadrature over a bundle (quadrature_rays). For a mirrored bundle, the second half of the
/// result's rays are the mirror images of the first half.
TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
