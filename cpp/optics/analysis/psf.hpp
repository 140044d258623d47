#pragma once
#include <cstdint>

#include "plane_waves.hpp"

namespace REALCAM_NAMESPACE {

/// Method by which the PSF is computed.
enum class PsfMethod {
    direct,     ///< sum of the plane waves of all rays at each point (plane_waves.hpp)
    fft,        ///< Fourier transform of plane waves with equally spaced slopes (psf_pupil.hpp)
    geometric,  ///< density of the rays, without diffraction
};

/// Film point at the centre of the PSF's array.
enum class PsfCentre {
    chief,  ///< film point of the chief ray of the first wavelength
    centroid,  ///< the centroid of the spot of all wavelengths
};

/// A wavelength and its weight.
struct PsfColour {
    double wavelength_nm, weight;
};

/// Parameters of a PSF.
struct PsfRequest {
    FieldPoint field;
    std::vector<PsfColour> colours;  ///< weights need not be normalised
    double film_distance;  ///< mm behind the last vertex
    PsfMethod method = PsfMethod::direct;
    int size = 128;  ///< number of rows and columns of the array, 2 to 4096
    double pitch_um = 0;  ///< distance between neighbouring points; 0: chosen by wavelength, f-number, and spot size
    PsfCentre centre = PsfCentre::chief;
    std::int64_t rays = 0;  ///< minimum number for each wavelength; 0: as many as the wavefront and the window need
};

/// Point-spread function: the light of one object point on the film.
struct Psf {
    int size;  ///< number of rows and columns
    double pitch_um;  ///< distance between neighbouring points
    Vec2<double> centre_mm;  ///< film position of the point (size / 2, size / 2), from the axis
    std::vector<PsfColour> colours;  ///< weights add up to 1
    std::vector<double> values;  ///< fraction of the light that passes the lens, per um^2; row by row, in ascending y
    double strehl;  ///< largest value over that with all waves in phase; NaN for PsfMethod::geometric
    std::int64_t rays;  ///< number of rays that were traced, of all wavelengths
};

namespace psf_detail {

/// One colour of a PSF in progress.
struct ColourPart {
    PointBundle bundle;
    double weight;  ///< normalised
    Vec2<double> centre{};  ///< centre of the PSF's grid, mm from the colour's chief ray
    PlaneWaves light{};  ///< its plane waves, if they have been computed
};

/// Returns the sampling of a colour's bundle for the window of a PSF, with at least `rays` rays (0: no minimum). Throws
/// InputError if it needs too many rays, or if `rays` is less than it needs.
BundleSampling checked_sampling(const ColourPart& part, const Psf& psf, std::int64_t rays);

/// Computes the irradiance of all colours' waves, per um^2, on a grid around the centre of the PSF, and assigns it to
/// `values`, row by row.
void add_waves(const std::vector<ColourPart>& parts, FilmGrid grid, std::vector<double>& values, const RayLoop& loop);

/// Bundles and empty array of a request, before light is summed.
struct PreparedPsf {
    std::vector<ColourPart> parts;
    Psf psf;
};

/// Checks a request and prepares its bundles. Throws InputError if it is invalid.
PreparedPsf prepare(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop);

}  // namespace psf_detail

/// Computes a PSF by PsfMethod::direct or PsfMethod::geometric. Throws InputError if the request is invalid, the index
/// of a glass is not known at a wavelength, no light passes, or the sum would take too many rays, and Cancelled if
/// `loop` is cancelled.
Psf psf_of(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop = {});

/// Returns the fraction of the light within a circle on the film (encircled energy). `about_um`: centre of the circle
/// relative to the centre of the PSF. Pixels count by the fraction of their area inside the circle. Light outside the
/// array is not counted.
double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um = {0, 0});

/// Returns the modulation (MTF) at a frequency, in periods per mm on the film, of a pattern that varies along y
/// (tangential) or along x (sagittal). It is not divided by the light on the array: light outside the array, the smooth
/// tails of diffraction, counts as unmodulated.
double modulation(const Psf& psf, double frequency_per_mm, bool tangential);

}  // namespace REALCAM_NAMESPACE
