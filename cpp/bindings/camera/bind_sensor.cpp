// The Python class Sensor, and the simulation of its noise.

#include <pybind11/stl.h>

#include "../../camera/sensor/sensor_response.hpp"
#include "../../embree/sensor_exposure.hpp"
#include "../../io/sensor/sensor_file.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Table of numbers as passed from Python.
using Rows = std::vector<std::vector<double>>;

/// Converts a table of two columns. `key`: name of the argument, for the InputError.
std::vector<SensorPoint> points_from(const char* key, const Rows& rows) {
    std::vector<SensorPoint> points;
    for (const std::vector<double>& row : rows) {
        if (row.size() != 2) throw InputError(std::string(key) + " must be a table of two columns");
        points.push_back({row[0], row[1]});
    }
    return points;
}

Typed<"tuple[tuple[float, float], ...]", py::tuple> pairs_of(const std::vector<SensorPoint>& points) {
    py::tuple pairs(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) pairs[i] = py::make_tuple(points[i].at, points[i].value);
    return pairs;
}

std::vector<QuantumEfficiency> efficiency_from(const Rows& rows, bool has_filters) {
    std::vector<QuantumEfficiency> table;
    for (const std::vector<double>& row : rows) {
        if (row.size() != (has_filters ? 4u : 2u))
            throw InputError(std::string("quantum_efficiency must be a table of ") +
                             (has_filters ? "(nm, red, green, blue)" : "(nm, electrons per photon)"));
        table.push_back(
            {row[0], has_filters ? std::array{row[1], row[2], row[3]} : std::array{row[1], row[1], row[1]}});
    }
    return table;
}

Typed<"tuple[tuple[float, ...], ...]", py::tuple> efficiency_of(const Sensor& sensor) {
    py::tuple rows(sensor.quantum_efficiency.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [nm, e] = sensor.quantum_efficiency[i];
        if (sensor.has_filters())
            rows[i] = py::make_tuple(nm, e[0], e[1], e[2]);
        else
            rows[i] = py::make_tuple(nm, e[0]);
    }
    return rows;
}

Illuminant illuminant_from(const std::string& text) {
    return text.empty() ? Illuminant::named("D65") : Illuminant::parse(text);
}

/// Returns the sensor's pixel pitch. Throws InputError if the sensor adopts that of the film.
double own_pitch_um(const Sensor& sensor) {
    if (!(sensor.pixel_pitch_um > 0))
        throw InputError("the sensor \"" + sensor.name +
                         "\" has no pixel pitch of its own; it adopts that of the film");
    return sensor.pixel_pitch_um;
}

/// Returns the mean number of dark electrons of a pixel. `current_e_per_s`: at the reference temperature of the sensor;
/// `temperature_c`: of the exposure; std::nullopt: the reference temperature. Throws InputError.
double dark_electrons(const Sensor& sensor, double current_e_per_s, double exposure_time_s,
                      std::optional<double> temperature_c) {
    const SensorNoise& noise = sensor.noise;
    double doublings = 0;
    if (temperature_c && !sensor_detail::is_temperature(*temperature_c))
        throw InputError("temperature_c must be a temperature in degrees Celsius, from -273.15 to 1000");
    if (temperature_c && *temperature_c != noise.dark_current_temperature_c) {
        if (current_e_per_s > 0 && noise.dark_current_doubling_k == 0)
            throw InputError("the sensor \"" + sensor.name +
                             "\" does not specify how its dark current depends on temperature "
                             "(dark_current_doubling_k)");
        if (current_e_per_s > 0)
            doublings = (*temperature_c - noise.dark_current_temperature_c) / noise.dark_current_doubling_k;
    }
    return current_e_per_s * exposure_time_s * std::exp2(std::min(doublings, 60.0));
}

/// Tabulates the angular response over the square of the distance from the picture's centre, see AngularResponse.
/// `film_pitch_mm`: pixel pitch of the film; `height`: rows of pixels.
void set_angular_response(SensorRequest& request, const Sensor& sensor, double film_pitch_mm,
                          double exit_pupil_distance_mm, int height) {
    AngularResponse& response = request.angular_response;
    response.middle_column = 0.5f * static_cast<float>(request.width - 1);
    response.middle_row = 0.5f * static_cast<float>(height - 1);
    if (sensor.angular_response.size() < 2 || !std::isfinite(exit_pupil_distance_mm)) return;
    const double largest = std::tan(sensor.angular_response.back().at * kDegree);
    for (int k = 0; k <= AngularResponse::kSteps; ++k) {
        const double tangent = largest * std::sqrt(static_cast<double>(k) / AngularResponse::kSteps);
        response.at[k] = static_cast<float>(sensor_detail::table_at(
            sensor.angular_response, std::min(std::atan(tangent) / kDegree, sensor.angular_response.back().at)));
    }
    const double per_pixel = film_pitch_mm / exit_pupil_distance_mm / largest;
    response.steps_per_square = static_cast<float>(AngularResponse::kSteps * per_pixel * per_pixel);
}

/// Returns the colour filter, 0 to 2 for red, green and blue, at a position of the 2 x 2 mosaic, 0 to 3 row by row.
std::size_t filter_at(const Sensor& sensor, std::size_t position) {
    return sensor.has_filters() ? std::string_view("RGB").find(sensor.color_filter_array[position]) : 0;
}

/// Returns the raw values (H, W) of an exposure (H, W, 3) in lux seconds. `pixel_pitch_um`: of the sensor;
/// `film_pitch_um`: of the film, for the angles of incidence. Other arguments as for Sensor.expose.
py::array_t<std::uint16_t> expose(const Sensor& sensor, const InputArray<float>& exposure, double pixel_pitch_um,
                                  double film_pitch_um, double exit_pupil_distance_mm, double exposure_time_s,
                                  double iso, const std::string& illuminant, std::optional<double> temperature_c,
                                  std::int64_t seed, std::int64_t serial, int threads) {
    if (exposure.ndim() != 3 || exposure.shape(2) != 3 || exposure.size() == 0)
        throw InputError("expected an exposure of shape (H, W, 3)");
    if (exposure.shape(0) * exposure.shape(1) > std::int64_t{0xffffffff})
        throw InputError("expected a picture of fewer than 2^32 pixels");
    const auto height = static_cast<int>(exposure.shape(0));
    py::array_t<std::uint16_t> raw({exposure.shape(0), exposure.shape(1)});
    SensorRequest request{};
    request.exposure = exposure.data();
    request.raw = raw.mutable_data();
    request.width = static_cast<std::int32_t>(exposure.shape(1));
    request.row_count = height;
    const SensorMatrix electrons = electrons_per_um2(sensor, illuminant_from(illuminant));
    for (std::size_t position = 0; position < 4; ++position)
        for (std::size_t channel = 0; channel < 3; ++channel)
            request.electrons[position][channel] = static_cast<float>(
                pixel_pitch_um * pixel_pitch_um * electrons[3 * filter_at(sensor, position) + channel]);
    set_angular_response(request, sensor, film_pitch_um / 1000, exit_pupil_distance_mm, height);
    const SensorNoise& noise = sensor.noise;
    request.response_deviation = static_cast<float>(noise.prnu_percent / 100);
    request.offset_deviation_e = static_cast<float>(noise.dsnu_e);
    request.dark_electrons = static_cast<float>(
        std::min(dark_electrons(sensor, noise.dark_current_e_per_s, exposure_time_s, temperature_c), 1e30));
    request.hot_share = static_cast<float>(noise.hot_pixel_share);
    request.hot_electrons = static_cast<float>(
        std::min(dark_electrons(sensor, noise.hot_pixel_current_e_per_s, exposure_time_s, temperature_c), 1e30));
    request.full_well_e = static_cast<float>(full_well_e(sensor));
    request.read_noise_e = static_cast<float>(noise.read_noise_e);
    request.row_noise_e = static_cast<float>(noise.row_noise_e);
    request.converter_noise_dn = static_cast<float>(sensor.conversion.converter_noise_dn);
    request.gain_dn_per_e = static_cast<float>(SensorSpeed(sensor, pixel_pitch_um).gain_dn_per_e(iso));
    request.black_level_dn = static_cast<float>(sensor.conversion.black_level_dn);
    request.largest_dn = static_cast<float>(sensor.conversion.largest_dn());
    request.seed = seed_from(seed);
    request.serial = seed_from(serial, "serial number");
    const Unlocked unlocked;
    expose_sensor(request, threads, heed_signals);
    return raw;
}

py::array_t<double> matrix_array(const SensorMatrix& m) {
    return array_from(std::vector<double>(m.begin(), m.end()), {3, 3});
}

Sensor changed_sensor(Sensor sensor, const std::optional<std::string>& name, std::optional<double> pixel_pitch_um,
                      const std::optional<std::pair<int, int>>& resolution,
                      const std::optional<std::string>& color_filter_array,
                      const std::optional<Rows>& quantum_efficiency, const std::optional<Rows>& cover_glass,
                      const std::optional<Rows>& angular_response, std::optional<double> gain_dn_per_e,
                      std::optional<double> largest_gain_db, std::optional<double> saturation_capacity_e,
                      std::optional<int> adc_bits, std::optional<double> black_level_dn,
                      std::optional<double> converter_noise_dn, std::optional<double> read_noise_e,
                      std::optional<double> row_noise_e, std::optional<double> dark_current_e_per_s,
                      std::optional<double> dark_current_temperature_c, std::optional<double> dark_current_doubling_k,
                      std::optional<double> dsnu_e, std::optional<double> prnu_percent,
                      std::optional<double> hot_pixel_share, std::optional<double> hot_pixel_current_e_per_s) {
    std::string changed_names;
    const auto list_if = [&](bool has_changed, const char* key) {
        if (has_changed) changed_names += std::string(changed_names.empty() ? "" : ", ") + key;
    };
    const auto set = [&](const char* key, auto& value, const auto& new_value) {
        list_if(new_value && !(value == *new_value), key);
        if (new_value) value = *new_value;
    };
    const Sensor before = sensor;
    if (name) sensor.name = *name;
    set("pixel_pitch_um", sensor.pixel_pitch_um, pixel_pitch_um);
    if (resolution) std::tie(sensor.columns, sensor.rows) = *resolution;
    set("color_filter_array", sensor.color_filter_array, color_filter_array);
    if (quantum_efficiency) sensor.quantum_efficiency = efficiency_from(*quantum_efficiency, sensor.has_filters());
    if (cover_glass) sensor.cover_glass = points_from("cover_glass", *cover_glass);
    if (angular_response) sensor.angular_response = points_from("angular_response", *angular_response);
    list_if(sensor.columns != before.columns || sensor.rows != before.rows, "resolution");
    list_if(sensor.quantum_efficiency != before.quantum_efficiency, "quantum_efficiency");
    list_if(sensor.cover_glass != before.cover_glass, "cover_glass");
    list_if(sensor.angular_response != before.angular_response, "angular_response");
    SensorConversion& conversion = sensor.conversion;
    set("gain_dn_per_e", conversion.gain_dn_per_e, gain_dn_per_e);
    set("largest_gain_db", conversion.largest_gain_db, largest_gain_db);
    set("saturation_capacity_e", conversion.saturation_capacity_e, saturation_capacity_e);
    set("adc_bits", conversion.adc_bits, adc_bits);
    set("black_level_dn", conversion.black_level_dn, black_level_dn);
    set("converter_noise_dn", conversion.converter_noise_dn, converter_noise_dn);
    SensorNoise& noise = sensor.noise;
    set("read_noise_e", noise.read_noise_e, read_noise_e);
    set("row_noise_e", noise.row_noise_e, row_noise_e);
    set("dark_current_e_per_s", noise.dark_current_e_per_s, dark_current_e_per_s);
    set("dark_current_temperature_c", noise.dark_current_temperature_c, dark_current_temperature_c);
    set("dark_current_doubling_k", noise.dark_current_doubling_k, dark_current_doubling_k);
    set("dsnu_e", noise.dsnu_e, dsnu_e);
    set("prnu_percent", noise.prnu_percent, prnu_percent);
    set("hot_pixel_share", noise.hot_pixel_share, hot_pixel_share);
    set("hot_pixel_current_e_per_s", noise.hot_pixel_current_e_per_s, hot_pixel_current_e_per_s);
    if (!changed_names.empty()) sensor.assumptions.push_back("changed since its file: " + changed_names);
    validate(sensor);
    return sensor;
}

std::string text_of(const Sensor& sensor) {
    std::string text = "<realcam.Sensor " + shortened(sensor.name);
    if (sensor.columns > 0) text += ", " + std::to_string(sensor.columns) + " x " + std::to_string(sensor.rows);
    text += sensor.pixel_pitch_um > 0 ? " pixels of " + digits(sensor.pixel_pitch_um) + " um" : ", pixels of any size";
    return text + ", " + (sensor.has_filters() ? sensor.color_filter_array : "monochrome") + ", " +
           std::to_string(sensor.conversion.adc_bits) + " bit>";
}

Film film_of(const Sensor& sensor) {
    const double pitch_mm = own_pitch_um(sensor) / 1000;
    if (sensor.columns == 0)
        throw InputError("the sensor \"" + sensor.name + "\" does not specify its number of pixels");
    const Film film{pitch_mm * sensor.columns, pitch_mm * sensor.rows, sensor.columns, sensor.rows};
    validate(film);
    return film;
}

void bind_data(py::class_<Sensor>& type) {
    type.def_readonly("name", &Sensor::name, "Name, which identifies a bundled sensor.")
        .def_readonly("title", &Sensor::title, "Description in one line.")
        .def_readonly("source", &Sensor::source, "Origin of the data.")
        .def_property_readonly(
            "assumptions",
            [](const Sensor& s)->Typed<"tuple[str, ...]", py::tuple> { return py::tuple(py::cast(s.assumptions)); },
            "Texts: what data are not published, and what is assumed instead; and what replace() has changed.")
        .def_property_readonly(
            "pixel_pitch_um",
            [](const Sensor& s) { return s.pixel_pitch_um > 0 ? std::optional(s.pixel_pitch_um) : std::nullopt; },
            "Pixel pitch; None: that of the film's pixels.")
        .def_property_readonly(
            "resolution",
            [](const Sensor& s) { return s.columns > 0 ? std::optional(std::pair(s.columns, s.rows)) : std::nullopt; },
            "(columns, rows) of pixels; None: any number.")
        .def_readonly(
            "color_filter_array", &Sensor::color_filter_array,
            "Mosaic of colour filters such as \"RGGB\", two rows of two from the upper left; \"\": no filters.")
        .def_property_readonly("quantum_efficiency", &efficiency_of,
                               "Table of (wavelength_nm, red, green, blue), or without filters (wavelength_nm, value): "
                               "electrons per photon on the pixel's area.")
        .def_property_readonly(
            "cover_glass", [](const Sensor& s) { return pairs_of(s.cover_glass); },
            "Table of (wavelength_nm, transmittance); empty: 1.")
        .def_property_readonly(
            "angular_response", [](const Sensor& s) { return pairs_of(s.angular_response); },
            "Table of (angle of incidence in degrees, response relative to normal incidence); empty: 1.");
}

void bind_conversion(py::class_<Sensor>& type) {
    const auto def = [&](const char* name, auto member, const char* doc) {
        type.def_property_readonly(name, [member](const Sensor& s) { return s.conversion.*member; }, doc);
    };
    def("gain_dn_per_e", &SensorConversion::gain_dn_per_e,
        "Overall system gain K at the lowest ISO, in digital numbers per electron; 0: the gain follows from the ISO.");
    def("largest_gain_db", &SensorConversion::largest_gain_db,
        "Largest additional gain in dB; 20 dB are a factor of 10.");
    def("saturation_capacity_e", &SensorConversion::saturation_capacity_e,
        "Saturation capacity in electrons as measured by EMVA 1288: at the maximum of the temporal variance.");
    def("adc_bits", &SensorConversion::adc_bits, "Number of bits of the analogue-to-digital converter.");
    def("black_level_dn", &SensorConversion::black_level_dn, "Raw value without light, in digital numbers.");
    def("converter_noise_dn", &SensorConversion::converter_noise_dn,
        "Standard deviation of the noise after the gain, in digital numbers.");
    type.def_property_readonly(
        "full_well_e", [](const Sensor& s) { return full_well_e(s); },
        "Full-well capacity in electrons. EMVA 1288's saturation capacity is about three standard deviations lower.");
}

void bind_noise(py::class_<Sensor>& type) {
    const auto def = [&](const char* name, double SensorNoise::* member, const char* doc) {
        type.def_property_readonly(name, [member](const Sensor& s) { return s.noise.*member; }, doc);
    };
    def("read_noise_e", &SensorNoise::read_noise_e,
        "Read noise: temporal dark noise for zero exposure time, before the gain, in electrons (standard deviation).");
    def("row_noise_e", &SensorNoise::row_noise_e,
        "Standard deviation, in electrons, of the noise that is common to the pixels of a row in an exposure.");
    def("dark_current_e_per_s", &SensorNoise::dark_current_e_per_s,
        "Mean dark current of a pixel at dark_current_temperature_c, in electrons per second.");
    def("dark_current_temperature_c", &SensorNoise::dark_current_temperature_c,
        "Temperature of the dark currents, in degrees Celsius.");
    def("dark_current_doubling_k", &SensorNoise::dark_current_doubling_k,
        "Temperature increase in kelvin that doubles the dark current; 0: unknown.");
    def("dsnu_e", &SensorNoise::dsnu_e,
        "Dark signal non-uniformity: standard deviation of the pixels' offsets, in electrons.");
    def("prnu_percent", &SensorNoise::prnu_percent,
        "Photo-response non-uniformity: standard deviation of the pixels' responses, in percent.");
    def("hot_pixel_share", &SensorNoise::hot_pixel_share, "Fraction of the pixels that are hot, 0 to 1.");
    def("hot_pixel_current_e_per_s", &SensorNoise::hot_pixel_current_e_per_s,
        "Mean of the hot pixels' additional dark current, which is exponentially distributed, in electrons per "
        "second.");
}

}  // namespace

void bind_sensor(py::module_& m) {
    m.def("sensor_names", &io::sensor_names, "Returns the names of the bundled sensors.");
    py::class_<Sensor> type(m, "Sensor",
                            "Image sensor by the linear model of the EMVA standard 1288 (docs/sensor.md). Immutable.");
    def_hashable_value(type);
    type.def_static(
            "load",
            [](const PathLike& name) {
                const std::string path = path_from(name);
                const Unlocked unlocked;
                return io::read_sensor(path, heed_signals);
            },
            "name_or_path"_a = "ideal",
            "Reads a sensor: name of a bundled sensor, or path of a sensor file (.toml). Raises InputError with file "
            "and "
            "line.")
        .def("replace", &changed_sensor, py::kw_only(), "name"_a = py::none(), "pixel_pitch_um"_a = py::none(),
             "resolution"_a = py::none(), "color_filter_array"_a = py::none(), "quantum_efficiency"_a = py::none(),
             "cover_glass"_a = py::none(), "angular_response"_a = py::none(), "gain_dn_per_e"_a = py::none(),
             "largest_gain_db"_a = py::none(), "saturation_capacity_e"_a = py::none(), "adc_bits"_a = py::none(),
             "black_level_dn"_a = py::none(), "converter_noise_dn"_a = py::none(), "read_noise_e"_a = py::none(),
             "row_noise_e"_a = py::none(), "dark_current_e_per_s"_a = py::none(),
             "dark_current_temperature_c"_a = py::none(), "dark_current_doubling_k"_a = py::none(),
             "dsnu_e"_a = py::none(), "prnu_percent"_a = py::none(), "hot_pixel_share"_a = py::none(),
             "hot_pixel_current_e_per_s"_a = py::none(),
             R"(Returns the sensor with some properties changed. Arguments as the properties, which sensors/README.md
describes; None: unchanged. Raises InputError.)")
        .def("film", &film_of,
             "Returns a Film with the sensor's size and pixels. Raises InputError if the sensor has no pixel pitch or "
             "resolution of its own.")
        .def(
            "electrons_per_um2",
            [](const Sensor& sensor, const std::string& illuminant) {
                return matrix_array(electrons_per_um2(sensor, illuminant_from(illuminant)));
            },
            "illuminant"_a = "D65",
            R"(Returns an array (3, 3): electrons per square micrometre under each filter (rows: red, green, blue) for
an exposure of one lux second in each channel of the film (columns), including the cover glass.
illuminant: spectrum of the light, as for RenderSettings. Raises InputError.)")
        .def(
            "iso_range",
            [](const Sensor& sensor, std::optional<double> pitch_um) {
                const SensorSpeed speed(sensor, pitch_um                    ? *pitch_um
                                                : sensor.pixel_pitch_um > 0 ? sensor.pixel_pitch_um
                                                                            : 1);
                return std::pair(speed.lowest_iso(), speed.highest_iso());
            },
            "pixel_pitch_um"_a = py::none(),
            R"(Returns the (lowest, highest) ISO number by saturation (ISO 12232: 78 over the exposure by D65, in lux
seconds, that saturates). The highest is that with the largest gain. (0, inf) if the gain follows from the ISO.
pixel_pitch_um: None: the sensor's own.)")
        .def(
            "expose",
            [](const Typed<"Sensor">& self, const Typed<"Image">& image, std::optional<double> iso, std::int64_t seed,
               std::int64_t serial, std::optional<double> temperature_c, int threads)
                ->Typed<"RawImage"> {
                    return py::module_::import("realcam.raw_image")
                        .attr("exposed")(self, image, iso, seed, serial, temperature_c, threads);
                },
            "image"_a, py::kw_only(), "iso"_a = py::none(), "seed"_a = 0, "serial"_a = 0,
            "temperature_c"_a = py::none(), "threads"_a = 0,
            R"(Returns the RawImage of an exposure of the sensor, which lies in the place of the film of an Image.
iso: sensitivity; None: that of the camera. seed: of the noise of this exposure. serial: seed of the sensor's fixed
  pattern (PRNU, DSNU, hot pixels). temperature_c: None: dark_current_temperature_c. threads: number of threads; 0: all.
Each pixel of the image is one pixel of the sensor; a UserWarning is issued if the film's pixels have another size. The
noise does not depend on the number of threads. Raises InputError.)")
        .def("__repr__", [](const Sensor& s) { return text_of(s); });
    bind_data(type);
    bind_conversion(type);
    bind_noise(type);
    m.def("_expose", &expose, "sensor"_a, "exposure"_a, "pixel_pitch_um"_a, "film_pitch_um"_a,
          "exit_pupil_distance_mm"_a, "exposure_time_s"_a, "iso"_a, "illuminant"_a, "temperature_c"_a, "seed"_a,
          "serial"_a, "threads"_a,
          R"(Internal: use Sensor.expose. Returns raw values (H, W) uint16 of an exposure (H, W, 3) in lux seconds.
film_pitch_um, exit_pupil_distance_mm: determine the angles of incidence for the angular response.)");
    m.def(
        "_sensor_gain",
        [](const Sensor& sensor, double pixel_pitch_um, double iso) {
            return SensorSpeed(sensor, pixel_pitch_um).gain_dn_per_e(iso);
        },
        "sensor"_a, "pixel_pitch_um"_a, "iso"_a,
        "Internal. Returns the gain at an ISO, in digital numbers per electron.");
    m.def(
        "_sensor_color",
        [](const Sensor& sensor, const std::string& illuminant) {
            const SensorColor color = sensor_color(sensor, illuminant_from(illuminant));
            return py::make_tuple(array_from(std::vector<double>(color.white.begin(), color.white.end()), {3}),
                                  matrix_array(color.camera_from_xyz), matrix_array(color.film_from_balanced),
                                  matrix_array(color.d50_from_balanced));
        },
        "sensor"_a, "illuminant"_a,
        R"(Internal. Returns the raw colour of white (3,), and the matrices (3, 3) camera_from_xyz, film_from_balanced
and d50_from_balanced, for colours of the camera that are balanced by that white.)");
}

}  // namespace realcam::bindings
