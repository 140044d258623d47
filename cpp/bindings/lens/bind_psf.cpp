// Lens.psf with the class PSF, and the transmission of a lens.

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <numeric>
#include <variant>

#include "../../embree/lens_rays.hpp"
#include "../../optics/analysis/psf.hpp"
#include "../../optics/analysis/psf_pupil.hpp"
#include "../../optics/analysis/transmission.hpp"
#include "../../optics/coating/coated_surface.hpp"
#include "../bindings.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "analysis_arguments.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Wavelengths = std::variant<double, std::vector<double>>;

std::vector<PsfColour> colours_from(const LensSystem& lens, const std::optional<Wavelengths>& wavelength_nm,
                                    const std::optional<std::vector<double>>& weights) {
    std::vector<double> wavelengths;
    if (const auto* several = wavelength_nm ? std::get_if<std::vector<double>>(&*wavelength_nm) : nullptr)
        wavelengths = *several;
    else
        wavelengths = {wavelength_nm ? std::get<double>(*wavelength_nm) : lens.wavelength_nm};
    if (weights && weights->size() != wavelengths.size())
        throw InputError("psf: there are " + std::to_string(weights->size()) + " weights for " +
                         counted(wavelengths.size(), "wavelength"));
    std::vector<PsfColour> colours;
    for (std::size_t i = 0; i < wavelengths.size(); ++i)
        colours.push_back({wavelength_or_design(lens, wavelengths[i]), weights ? (*weights)[i] : 1});
    return colours;
}

PsfMethod method_from(const std::string& name) {
    if (name == "direct") return PsfMethod::direct;
    if (name == "fft") return PsfMethod::fft;
    if (name == "geometric") return PsfMethod::geometric;
    throw InputError("unknown method \"" + name + "\"; expected direct, fft or geometric");
}

/// Computes the PSF with numpy's FFT. Must be called with the GIL.
Psf psf_by_fft(const LensSystem& lens, const PsfRequest& request) {
    std::vector<PsfPupil> pupils;
    Psf psf;
    {
        const Unlocked unlocked;
        const RayLoop loop = parallel_ray_loop(heed_signals);
        auto [parts, started] = psf_detail::prepare(lens, request, loop);
        psf = std::move(started);
        for (const psf_detail::ColourPart& part : parts) pupils.push_back(psf_pupil(part, psf, loop));
    }
    const py::object inverse_fft = py::module_::import("numpy.fft").attr("ifft2");
    double in_phase_peak = 0;  // peak value if all rays were in phase, for the Strehl ratio
    for (const PsfPupil& pupil : pupils) {
        const auto n = static_cast<std::size_t>(pupil.size);
        const auto size = static_cast<std::size_t>(psf.size), first = n - size / 2;
        const py::array_t<std::complex<double>> sums =
            inverse_fft(array_from(pupil.values, {pupil.size, pupil.size}), "norm"_a = "forward");
        const std::complex<double>* from = sums.data();
        // The transform has frequency 0 at index 0; the PSF has it at size / 2.
        for (std::size_t y = 0; y < size; ++y)
            for (std::size_t x = 0; x < size; ++x)
                psf.values[y * size + x] += pupil.scale * std::norm(from[(first + y) % n * n + (first + x) % n]);
        double amplitude = 0;
        for (const std::complex<double>& value : pupil.values) amplitude += std::abs(value);
        in_phase_peak += pupil.scale * amplitude * amplitude;
        psf.rays += std::count_if(pupil.values.begin(), pupil.values.end(), [](auto v) { return v != 0.0; });
    }
    psf.strehl = *std::max_element(psf.values.begin(), psf.values.end()) / in_phase_peak;
    return psf;
}

Psf make_psf(const LensSystem& lens, double field_deg, const std::optional<Wavelengths>& wavelength_nm,
             const std::string& method, int size, std::optional<double> pitch_um,
             std::optional<double> object_distance_m, const FilmPoint& film_mm, std::optional<double> film_distance_mm,
             const std::string& centre, std::optional<std::int64_t> rays,
             const std::optional<std::vector<double>>& weights) {
    if (centre != "chief" && centre != "centroid")
        throw InputError("unknown centre \"" + centre + "\"; expected chief or centroid");
    if (pitch_um && !(*pitch_um > 0)) throw InputError("psf: pitch_um must be a positive length");
    if (rays && *rays <= 0) throw InputError("psf: rays must be a positive number");
    if (film_distance_mm && !std::isfinite(*film_distance_mm))
        throw InputError("film_distance_mm must be a finite length, or None for the film");
    const PsfRequest request{field_from(field_deg, object_distance_m, film_mm),
                             colours_from(lens, wavelength_nm, weights),
                             film_distance_mm.value_or(lens.film_distance),
                             method_from(method),
                             size,
                             pitch_um.value_or(0),
                             centre == "chief" ? PsfCentre::chief : PsfCentre::centroid,
                             rays.value_or(0)};
    if (request.method == PsfMethod::fft) return psf_by_fft(lens, request);
    const Unlocked unlocked;
    return psf_of(lens, request, parallel_ray_loop(heed_signals));
}

py::array_t<double> pixel_positions_um(const Psf& psf) {
    return array_of(static_cast<std::size_t>(psf.size),
                    [&](std::size_t i) { return (static_cast<int>(i) - psf.size / 2) * psf.pitch_um; });
}

double mean_wavelength(const Psf& psf) {
    double sum = 0;
    for (const PsfColour& colour : psf.colours) sum += colour.weight * colour.wavelength_nm;
    return sum;
}

Typed<"tuple[NDArray[float64], NDArray[float64], NDArray[float64]]", py::tuple> mtf(
    const Psf& psf, const std::optional<InputArray<double>>& frequencies_per_mm) {
    const InputArray<double> frequencies =
        frequencies_per_mm.value_or(array_of(static_cast<std::size_t>(psf.size / 2 + 1), [&](std::size_t i) {
            return 1e3 * static_cast<double>(i) / (psf.size * psf.pitch_um);
        }));
    if (frequencies.ndim() != 1) throw InputError("frequencies_per_mm must be an array of shape (N,)");
    const auto along = [&](bool tangential) {
        return array_of(static_cast<std::size_t>(frequencies.size()),
                        [&](std::size_t i) { return modulation(psf, frequencies.data()[i], tangential); });
    };
    return py::make_tuple(frequencies, along(true), along(false));
}

}  // namespace

void bind_psf(py::module_& m) {
    py::class_<Psf> psf(m, "PSF",
                        "Point spread function: distribution of the light of one object point on the film, on a square "
                        "grid of points (docs/psf.md).");
    def_value(psf, [](const Psf& p) {
        require_restored(p.size >= 2 && p.pitch_um > 0 && std::isfinite(p.pitch_um) && !p.colours.empty());
        const auto size = static_cast<std::size_t>(p.size);
        require_restored(p.values.size() == size * size);
    });
    psf.def_property_readonly(
           "values", [](const Psf& p) { return array_from(p.values, {p.size, p.size}); },
           R"((size, size): fraction of the light that passes the lens, per um^2; over the whole film the values times
pitch_um^2 add up to 1. Rows from the lowest y, columns from the lowest x.)")
        .def_readonly("pitch_um", &Psf::pitch_um, "Distance between neighbouring points.")
        .def_property_readonly("x_um", &pixel_positions_um, "(size,): x of the columns, relative to centre_mm.")
        .def_property_readonly("y_um", &pixel_positions_um,
                               "(size,): y of the rows, relative to centre_mm; field_deg lies in the y-z plane.")
        .def_property_readonly(
            "centre_mm", [](const Psf& p) { return std::pair(p.centre_mm.x, p.centre_mm.y); },
            "(x, y) on the film, from the axis, of the point with x_um = y_um = 0.")
        .def_property_readonly("wavelength_nm", &mean_wavelength, "Weighted mean of the wavelengths.")
        .def_property_readonly(
            "wavelengths_nm",
            [](const Psf& p) { return array_of(p.colours.size(), [&](auto i) { return p.colours[i].wavelength_nm; }); },
            "(N,): wavelengths.")
        .def_property_readonly(
            "weights",
            [](const Psf& p) { return array_of(p.colours.size(), [&](auto i) { return p.colours[i].weight; }); },
            "(N,): fraction of the light at each wavelength; the sum is 1.")
        .def_readonly("strehl", &Psf::strehl,
                      "Strehl ratio: largest value over that of the same rays all in phase; nan for the method "
                      "\"geometric\".")
        .def_readonly("rays", &Psf::rays, "Number of rays, summed over all wavelengths.")
        .def_property_readonly(
            "energy",
            [](const Psf& p) {
                return std::accumulate(p.values.begin(), p.values.end(), 0.0) * p.pitch_um * p.pitch_um;
            },
            "Fraction of the light that falls on the array, 0 to 1.")
        .def(
            "energy_inside",
            [](const Psf& p, double radius_um, std::pair<double, double> about_um) {
                return energy_inside(p, radius_um, {about_um.first, about_um.second});
            },
            "radius_um"_a, "about_um"_a = std::pair(0.0, 0.0),
            "Returns the fraction of the light within a circle about the point about_um, (x, y) relative to centre_mm. "
            "Light outside of the array is not counted.")
        .def("mtf", &mtf, "frequencies_per_mm"_a = py::none(),
             R"(Returns the modulation transfer function as (frequencies_per_mm, tangential, sagittal), arrays of shape
(N,). Tangential: contrast of a line pattern that varies along y; sagittal: along x.
frequencies_per_mm: (N,); None: from 0 to half of 1 / pitch_um.)")
        .def("__repr__", [](const Psf& p) {
            return "<realcam.PSF " + std::to_string(p.size) + " x " + std::to_string(p.size) + ", pitch " +
                   digits(p.pitch_um) + " um, Strehl " + digits(p.strehl) + '>';
        });
    static const std::string text =
        R"(Computes the point spread function (PSF) of one object point on the film from the exact wavefront.
field_deg, film_mm, object_distance_m: field point, see Lens.wavefront.
wavelength_nm: a wavelength, or several, whose PSFs are added incoherently; None: the design wavelength.
weights: relative amount of light at each wavelength; None: equal.
method: "direct": sum of the rays as plane waves, for any wavefront; "fft": the same sum by a Fourier transform, for
  wavefronts that are not too steep; "geometric": density of the rays, without diffraction.
size: number of points across the array.
pitch_um: distance between points; None: a quarter of wavelength x f-number, or up to half of it if the spot is larger
  than the array.
film_distance_mm: distance from the last vertex to the plane of the PSF; None: the film.
centre: centre of the array. "chief": intersection of the first wavelength's chief ray with that plane; "centroid":
  centroid of the spot.
rays: minimum number of rays for each wavelength; None: as many as the wavefront and the array require. Not used by
  "fft".
Returns a PSF. Raises InputError if no light passes, a glass is unknown at a wavelength, or the number of rays is too
small for the wavefront.)";
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("psf", &make_psf, "field_deg"_a = 0.0, "wavelength_nm"_a = py::none(), py::kw_only(),
             "method"_a = "direct", "size"_a = 128, "pitch_um"_a = py::none(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "film_distance_mm"_a = py::none(), "centre"_a = "chief", "rays"_a = py::none(),
             "weights"_a = py::none(), text.c_str());
}

namespace {

double transmission(const LensSystem& lens, double field_deg, std::optional<double> wavelength_nm,
                    std::optional<double> object_distance_m, const std::string& polarisation,
                    const std::string& pattern, int samples, const std::optional<InputArray<double>>& pupil) {
    if (polarisation != "traced" && polarisation != "averaged")
        throw InputError("unknown polarisation \"" + polarisation + "\"; expected traced or averaged");
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    std::vector<PupilPoint> points = pattern_from(pattern, samples, pupil);
    const Unlocked unlocked;
    const BundleTransmission bundle = bundle_transmission(lens, wavelength, field_from(field_deg, object_distance_m),
                                                          std::move(points), parallel_ray_loop(heed_signals));
    return polarisation == "traced" ? bundle.mean_traced : bundle.mean_averaged;
}

}  // namespace

void bind_transmission(py::module_& m) {
    static const std::string text =
        std::string(
            R"(Computes the transmittance of the lens for unpolarised light of one object point: the mean over the part
of the stop that the light fills, without the rays that the rims block. It includes the losses by Fresnel reflection or
by the coating at every surface, but no absorption in glass. Surfaces without a specified coating (unknown_coatings)
count as bare glass or as perfect mirrors.
)") + kFieldText +
        R"(polarisation: "traced" follows both polarisations through the lens; "averaged" takes the mean of s and p at
  each surface, as if the light were unpolarised between surfaces.
)" + kPatternText +
        "Returns a fraction, 0 to 1. Raises InputError if no ray passes, or a material is unknown at the wavelength.";
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("transmission", &transmission, "field_deg"_a = 0.0, "wavelength_nm"_a = py::none(), py::kw_only(),
             "object_distance_m"_a = py::none(), "polarisation"_a = "traced", "pattern"_a = "rings", "samples"_a = 8,
             "pupil"_a = py::none(), text.c_str())
        .def_property_readonly(
            "t_stop", [](const LensSystem& lens) { return t_stop(lens, lens.wavelength_nm); },
            R"(T-stop: f-number / sqrt(transmittance) at the design wavelength, which is the f-number of a lossless lens
with the same exposure at the centre of the picture. The transmittance is that of the axial ray, times the fraction of
the pupil that is not centrally obstructed. inf if the lens has no f-number.)")
        .def_property_readonly(
            "unknown_coatings", &surfaces_with_unknown_coating,
            R"(Indices of the surfaces without a specified coating: faces between glass and air, which count as bare,
and mirrors, which count as perfect. Cemented faces are not listed; they are bare.)");
}

}  // namespace realcam::bindings
