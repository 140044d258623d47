#pragma once
#include <cstdint>

#include "plane_wave_sum.hpp"

namespace REALCAM_NAMESPACE {

enum class PsfMethod {
    direct,  ///< the sum of the rays' plane waves at each point
    fft,     ///< the same light by a Fourier transform of its slopes, sampled evenly
    geometric,  ///< the rays themselves, without diffraction
};

enum class PsfCentre {
    chief,     ///< where the chief ray of the first wavelength meets the film
    centroid,  ///< the centroid of the spot of all wavelengths
};

/// A wavelength and its share of the light.
struct PsfColour {
    double wavelength_nm, weight;
};

struct PsfRequest {
    FieldPoint field;
    std::vector<PsfColour> colours;
    double film_distance;  ///< mm behind the last vertex
    PsfMethod method = PsfMethod::direct;
    int size = 128;
    double pitch_um = 0;  ///< 0: psf_pitch
    PsfCentre centre = PsfCentre::chief;
    std::int64_t rays = 0;  ///< at least, for each wavelength; 0: as many as the wavefront and the window need
};

/// The light of one object point on the film.
struct Psf {
    int size;
    double pitch_um;
    Vec2<double> centre_mm;  ///< on the film, from the axis: of the point (size / 2, size / 2)
    std::vector<PsfColour> colours;  ///< with weights whose sum is 1
    std::vector<double> values;  ///< share of the light that passes the lens, per um^2; row by row from the lowest y
    double strehl;  ///< largest value over that of the same rays all in phase; NaN without diffraction
    std::int64_t rays;
};

namespace psf_detail {

/// A colour of a PSF that is under way: its light, its grid relative to its own chief ray, and its share of the sum.
struct Part {
    PointBundle bundle;
    double weight;
    Vec2<double> centre{};
    PlaneWaves light{};
};

/// Throws InputError where too many or too few rays would be taken.
BundleSampling checked_sampling(const Part& part, const Psf& psf, std::int64_t rays);

void add_waves(const std::vector<Part>& parts, FilmGrid grid, std::vector<double>& values, const RayLoop& loop);

/// The request's light on a grid that is laid, of which nothing is summed yet.
struct Start {
    std::vector<Part> parts;
    Psf psf;
};

Start start(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop);

}  // namespace psf_detail

/// The PSF by the direct sum, or of the rays alone. Throws InputError for an impossible request, for a wavelength at
/// which a glass is not known, where no light passes, and where a sum would take too many rays. Also throws what `loop`
/// throws to stop it.
Psf psf_of(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
