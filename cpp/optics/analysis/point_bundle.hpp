#pragma once
#include "field_rays.hpp"
#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of one object point where it meets the film plane.
struct FilmRay {
    bool passes;
    Vec2<double> at;  ///< mm from the chief ray
    Vec3d direction;  ///< unit
    double path;  ///< optical path to there less that of the chief ray, over the index behind the lens, mm
};

/// A ray as a plane wave on the film, beside the sphere that runs from the exit pupil to the chief ray's film point.
struct WaveRay {
    Vec2<double> slope;  ///< of its path along the film: its direction cosines less those of the sphere
    double path;  ///< at the chief ray's film point, mm
};

/// All light of one object point at one wavelength, by where its rays cross the entry plane (ObjectPoint::Entry): there
/// it is even, and the lens maps what passes to the film.
class PointBundle {
public:
    using Entry = ObjectPoint::Entry;

    bool mirrored;  ///< whether x and -x are alike, as all is round; blades need not be
    ObjectPoint object;
    Entry chief_entry;  ///< of the chief ray
    Vec2<double> chief;  ///< where the chief ray meets the film, mm from the axis
    double index;  ///< behind the lens
    double wave_number;  ///< 2 pi index / wavelength, 1/mm
    Entry middle, reach;  ///< of a rectangle in the entry plane that what passes lies in, or hardly beyond
    Vec2<double> centroid;  ///< of the spot, mm from the chief ray
    Vec2<double> spot;  ///< half the sides of the rectangle about the chief ray that holds the spot, mm
    Vec2<double> slope_low, slope_high;  ///< of the rays that pass

    static constexpr int kLook = 40;

    /// `look`: rays across the stop by which the bundle is found, of which those that pass are to be enough to say
    /// where the light is. Throws InputError for a field point or wavelength that makes no sense, and where no light
    /// reaches the film.
    PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                const RayLoop& loop = {}, int look = kLook);

    /// Of the plane, mm behind the last vertex, on which rays land: the film, of a curved one where the chief ray does.
    double plane() const { return plane_; }

    /// Whether the lens lets these rays pass.
    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        start(entries, rays);
        trace_lens(real_.view(), rays, PathRecord<double, N>{});
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

    /// Rays through the lens without its rims, so that a ray's neighbours are there too.
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

    /// The plane wave that has the ray's path and direction where the ray lands. There the path of the sphere is
    /// subtracted. Its curvature on the film is the same for all rays and changes no intensity. The differences that
    /// remain are small. Their curvature is negligible as long as the film is far from the exit pupil.
    WaveRay as_wave(const FilmRay& ray) const;

    /// Energy of the light for each area of the entry plane, over that in its middle: even in solid angle.
    double energy(Entry entry) const;

private:
    static constexpr int kCloseLook = 200;

    /// A twentieth of the rays over the whole stop, and not so few that they do not tell where the light is.
    static std::size_t few(int look) { return static_cast<std::size_t>(std::max(3 * look * look / 80, 20)); }

    static const LensSystem& in_known_glass(const LensSystem& lens, double wavelength_nm);

    /// Rays over the whole stop; more of them where the lens lets few pass.
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

}  // namespace REALCAM_NAMESPACE
