#pragma once
#include <array>
#include <vector>

#include "../pupil/bundle_quadrature.hpp"
#include "field_rays.hpp"
#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of one object point at the film plane.
struct FilmRay {
    bool passes;
    Vec2<double> at;  ///< mm from the chief ray
    Vec3d direction;  ///< unit
    double path;  ///< optical path to `at` less that of the chief ray, over the index behind the lens, mm
};

/// A ray as a plane wave on the film, relative to the sphere that converges from the exit pupil to the chief ray's film
/// point.
struct WaveRay {
    Vec2<double> slope;  ///< gradient of the path along the film: the ray's direction cosines less the sphere's
    double path;  ///< at the chief ray's film point, mm
};

/// All light of one object point at one wavelength, parametrised by its rays' intersection with the entry plane
/// (ObjectPoint::Entry), over which it is uniform; the lens maps what passes to the film.
class PointBundle {
public:
    using Entry = ObjectPoint::Entry;

    bool mirrored;  ///< true: the light is symmetric in x, which diaphragm blades may prevent
    ObjectPoint object;
    Entry chief_entry;  ///< entry of the chief ray
    Vec2<double> chief;  ///< film point of the chief ray, mm from the axis
    double index;  ///< refractive index behind the lens
    double wave_number;  ///< 2 pi index / wavelength, 1/mm
    Entry middle, reach;  ///< approximate bounds in the entry plane of what passes: centre and half sides
    Vec2<double> centroid;  ///< centroid of the spot, mm from the chief ray
    Vec2<double> spot;  ///< half sides of the spot's bounding rectangle centred on the chief ray, mm
    Vec2<double> slope_low, slope_high;  ///< bounds of the slopes of the rays that pass

    static constexpr int kLook = 40;

    /// `look`: the number of probe rays across the stop that locate the light; if too few of them pass, a denser probe
    /// follows. Throws InputError if the field point or the wavelength is invalid, or no light reaches the film.
    PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                const RayLoop& loop = {}, int look = kLook);

    /// z of the plane on which rays land, mm behind the last vertex: the film, or for a curved film the plane through
    /// the chief ray's film point.
    double plane() const { return plane_; }

    /// For each entry: true if its ray passes the lens.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        trace_lens(real_.view(), rays, PathRecord<double, N>{});
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Traces rays through the lens without its rims, so that the neighbours of a ray exist, too.
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

    /// Returns the plane wave with the ray's path and direction at its film point, less those of the sphere there. The
    /// sphere's curvature on the film is the same for all rays and changes no intensity. The remaining differences are
    /// small, and their curvature is negligible as long as the film is far from the exit pupil.
    WaveRay as_wave(const FilmRay& ray) const;

    /// Energy per area of the entry plane, relative to its centre: uniform in solid angle.
    double energy(Entry entry) const;

private:
    static constexpr int kCloseLook = 200;

    /// Least number of passing probe rays: a twentieth of those over the whole stop, but at least 20, to locate the
    /// light.
    static std::size_t few(int look) { return static_cast<std::size_t>(std::max(3 * look * look / 80, 20)); }

    static const LensSystem& in_known_glass(const LensSystem& lens, double wavelength_nm);

    /// Probe rays over the whole stop; denser ones if the lens lets few pass.
    static FieldRays look_for(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, int look,
                              const RayLoop& loop);

    void measure(const FieldRays& rays, int look);

    template <int N>
    void start(const Entry (&entries)[N], LensRays<double, N>& rays) const {
        for (int i = 0; i < N; ++i) {
            rays.origin.set(i, object.at(entries[i]) - Vec3d{0, 0, path_.entry_position});
            rays.direction.set(i, path_.entry_index * object.direction(entries[i]));
            rays.status[i] = 0;
        }
    }

    FilmRay on_film(Vec3d origin, Vec3d direction, double path) const;
    FilmRay from_chief(bool passes, Vec3d origin, Vec3d direction, double path) const;

    LensPath<double> path_;
    AimingPath open_, real_;
    double plane_;
    double chief_path_, curvature_;  ///< 1 / distance from the exit pupil to the chief ray's film point
    Vec3d chief_direction_;
};

/// A ray of a bundle, with the fraction of the light that it represents.
struct BundleRay {
    PointBundle::Entry entry;  ///< on the entry plane, mm
    double energy;  ///< fraction of the energy of all rays
    Vec2<double> at;  ///< on the film, mm from the chief ray
    Vec3d direction;  ///< unit, behind the lens
    WaveRay wave;
    double amplitude;  ///< root of the energy per area of slopes, times a common factor
};

/// Segment of the edge of what passes: its two end points.
struct EdgePiece {
    std::array<PointBundle::Entry, 2> entry;
    std::array<Vec2<double>, 2> slope;
};

/// Ray bundle of one object point at one wavelength, with the edge of what passes and the foci about the chief ray.
struct TracedBundle {
    std::vector<BundleRay> rays;
    std::vector<EdgePiece> edge;
    double tangential_focus, sagittal_focus;  ///< foci of rays close to the chief ray, mm behind the film plane
};

/// Traces rays at Gauss's nodes on radial scan lines over what passes. If a bundle is its own mirror image, the second
/// half of the rays are the mirror images of the first.
TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
