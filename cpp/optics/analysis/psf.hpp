#pragma once
#include <cstdint>

#include "plane_waves.hpp"

namespace REALCAM_NAMESPACE {

enum class PsfMethod {
    direct,  ///< sum of the rays' plane waves at each point
    fft,  ///< the same light by a Fourier transform over evenly sampled slopes
    geometric,  ///< density of the rays, without diffraction
};

enum class PsfCentre {
    chief,  ///< film point of the chief ray of the first wavelength
    centroid,  ///< the centroid of the spot of all wavelengths
};

/// A wavelength and its weight.
struct PsfColour {
    double wavelength_nm, weight;
};

struct PsfRequest {
    FieldPoint field;
    std::vector<PsfColour> colours;
    double film_distance;  ///< mm behind the last vertex
    PsfMethod method = PsfMethod::direct;
    int size = 128;
    double pitch_um = 0;  ///< 0: automatic (psf_pitch)
    PsfCentre centre = PsfCentre::chief;
    std::int64_t rays = 0;  ///< minimum for each wavelength; 0: as many as the wavefront and the window need
};

/// Point-spread function: the light of one object point on the film.
struct Psf {
    int size;
    double pitch_um;
    Vec2<double> centre_mm;  ///< film position of the point (size / 2, size / 2), from the axis
    std::vector<PsfColour> colours;  ///< weights add up to 1
    std::vector<double> values;  ///< fraction of the light that passes the lens, per um^2; rows by ascending y
    double strehl;  ///< largest value over that of the same rays all in phase; NaN without diffraction
    std::int64_t rays;
};

namespace psf_detail {

/// One colour of a PSF in progress: its bundle, its weight, the grid's centre relative to its chief ray, and its waves.
struct Part {
    PointBundle bundle;
    double weight;
    Vec2<double> centre{};
    PlaneWaves light{};
};

/// Returns the sampling for a colour. Throws InputError if it needs too many rays, or `rays` is too small.
BundleSampling checked_sampling(const Part& part, const Psf& psf, std::int64_t rays);

void add_waves(const std::vector<Part>& parts, FilmGrid grid, std::vector<double>& values, const RayLoop& loop);

/// Bundles and empty grid of a request, before any light is summed.
struct Start {
    std::vector<Part> parts;
    Psf psf;
};

Start start(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop);

}  // namespace psf_detail

/// Computes the PSF by the direct sum, or geometrically. Throws InputError if the request is invalid, a glass is not
/// known at a wavelength, no light passes, or the sum would take too many rays; also what `loop` throws to stop it.
Psf psf_of(const LensSystem& lens, const PsfRequest& request, const RayLoop& loop = {});

/// Fraction of the light within a circle; `about_um` is its centre relative to the PSF's centre point. Pixels count by
/// the fraction of their area in the circle. Light beyond the array is not counted.
double energy_inside(const Psf& psf, double radius_um, Vec2<double> about_um = {0, 0});

/// Modulation (MTF) at a frequency, periods per mm on the film: across y (tangential) or x (sagittal). It is not
/// divided by the light on the array, so that light beyond it counts as lost to all modulation: the tails of
/// diffraction are smooth.
double modulation(const Psf& psf, double frequency_per_mm, bool tangential);

}  // namespace REALCAM_NAMESPACE
