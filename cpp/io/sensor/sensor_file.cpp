#include "sensor_file.hpp"

#include "../files/regular_file.hpp"
#include "../text/toml_document.hpp"

namespace realcam::io {
namespace {

constexpr int kFormat = 1;

/// RaiseFileError for sensor files.
[[noreturn]] void raise_input_error(const std::string& message, const std::string& file, int line, int) {
    throw InputError(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + message);
}

double number_or(const TomlTable& table, const char* key, double default_value) {
    return table.number(key).value_or(default_value);
}

/// Returns a number of the key as a whole number; an error if it is not whole, or beyond a million.
int whole(const TomlTable& table, const char* key, double value) {
    if (value != std::floor(value) || std::fabs(value) > 1e6)
        table.fail('"' + std::string(key) + "\" must be a whole number", table.find(key));
    return static_cast<int>(value);
}

/// Reads the rows of a table of numbers; empty if the key is absent. The number of columns of each row must be one of
/// `widths`. `columns`: their names, for messages.
std::vector<std::vector<double>> read_rows(const TomlTable& table, const char* key, std::vector<std::size_t> widths,
                                           const std::string& columns) {
    const toml::node* node = table.find(key);
    if (!node) return {};
    const std::string message = '"' + std::string(key) + "\" must be a table of " + columns;
    if (!node->is_array() || node->as_array()->empty()) table.fail(message, node);
    std::vector<std::vector<double>> rows;
    for (const toml::node& item : *node->as_array()) {
        const toml::array* row = item.as_array();
        if (!row) table.fail(message, &item);
        bool has_valid_width = false;
        for (std::size_t width : widths) has_valid_width |= row->size() == width;
        if (!has_valid_width) table.fail(message, &item);
        std::vector<double> values;
        for (const toml::node& value : *row)
            values.push_back(table.as_number(value, "each value of " + std::string(key)));
        rows.push_back(std::move(values));
    }
    return rows;
}

/// Reads a curve: rows of abscissa and value.
std::vector<SensorPoint> read_points(const TomlTable& table, const char* key, const std::string& columns) {
    std::vector<SensorPoint> points;
    for (const std::vector<double>& row : read_rows(table, key, {2}, columns)) points.push_back({row[0], row[1]});
    return points;
}

/// Reads the pixels: pitch, resolution, colour filters, quantum efficiency, cover glass and angular response.
void read_pixels(const TomlTable& table, Sensor& sensor) {
    sensor.pixel_pitch_um = number_or(table, "pixel_pitch_um", 0);
    if (const auto size = table.numbers("resolution", 2); !size.empty()) {
        sensor.columns = whole(table, "resolution", size[0]);
        sensor.rows = whole(table, "resolution", size[1]);
    }
    sensor.color_filter_array = table.text("color_filter_array");
    if (sensor.has_filters() && !is_filter_array(sensor.color_filter_array))
        table.fail(std::string("\"color_filter_array\" must be ") + kFilterArrays, table.find("color_filter_array"));
    const bool has_filters = sensor.has_filters();
    const std::string columns = has_filters ? "[nm, red, green, blue]" : "[nm, electrons per photon]";
    for (const std::vector<double>& row :
         read_rows(table, "quantum_efficiency", {has_filters ? std::size_t{4} : std::size_t{2}}, columns))
        sensor.quantum_efficiency.push_back(
            {row[0], has_filters ? std::array{row[1], row[2], row[3]} : std::array{row[1], row[1], row[1]}});
    sensor.cover_glass = read_points(table, "cover_glass", "[nm, transmission]");
    sensor.angular_response = read_points(table, "angular_response", "[degrees, relative response]");
}

/// Reads the conversion from electrons to digital numbers (DN).
void read_conversion(const TomlTable& table, SensorConversion& conversion) {
    conversion.gain_dn_per_e = number_or(table, "gain_dn_per_e", conversion.gain_dn_per_e);
    conversion.largest_gain_db = number_or(table, "largest_gain_db", conversion.largest_gain_db);
    conversion.saturation_capacity_e = number_or(table, "saturation_capacity_e", conversion.saturation_capacity_e);
    conversion.adc_bits = whole(table, "adc_bits", number_or(table, "adc_bits", conversion.adc_bits));
    conversion.black_level_dn = number_or(table, "black_level_dn", conversion.black_level_dn);
    conversion.converter_noise_dn = number_or(table, "converter_noise_dn", conversion.converter_noise_dn);
}

/// Reads the parameters of the noise (EMVA 1288).
void read_noise(const TomlTable& table, SensorNoise& noise) {
    noise.read_noise_e = number_or(table, "read_noise_e", noise.read_noise_e);
    noise.row_noise_e = number_or(table, "row_noise_e", noise.row_noise_e);
    noise.dark_current_e_per_s = number_or(table, "dark_current_e_per_s", noise.dark_current_e_per_s);
    noise.dark_current_temperature_c = number_or(table, "dark_current_temperature_c", noise.dark_current_temperature_c);
    noise.dark_current_doubling_k = number_or(table, "dark_current_doubling_k", noise.dark_current_doubling_k);
    noise.dsnu_e = number_or(table, "dsnu_e", noise.dsnu_e);
    noise.prnu_percent = number_or(table, "prnu_percent", noise.prnu_percent);
    noise.hot_pixel_share = number_or(table, "hot_pixel_share", noise.hot_pixel_share);
    noise.hot_pixel_current_e_per_s = number_or(table, "hot_pixel_current_e_per_s", noise.hot_pixel_current_e_per_s);
}

Sensor sensor_from_table(const toml::table& root, const std::string& file) {
    const TomlTable table(root, file, 0, raise_input_error);
    table.allow({"format",
                 "name",
                 "title",
                 "source",
                 "assumptions",
                 "pixel_pitch_um",
                 "resolution",
                 "color_filter_array",
                 "quantum_efficiency",
                 "cover_glass",
                 "angular_response",
                 "gain_dn_per_e",
                 "largest_gain_db",
                 "saturation_capacity_e",
                 "adc_bits",
                 "black_level_dn",
                 "converter_noise_dn",
                 "read_noise_e",
                 "row_noise_e",
                 "dark_current_e_per_s",
                 "dark_current_temperature_c",
                 "dark_current_doubling_k",
                 "dsnu_e",
                 "prnu_percent",
                 "hot_pixel_share",
                 "hot_pixel_current_e_per_s"});
    if (table.number("format") != kFormat)
        table.fail("expected format = " + std::to_string(kFormat), table.find("format"));
    Sensor sensor;
    sensor.name = table.text("name");
    if (sensor.name.empty()) table.fail("\"name\" is missing");
    sensor.title = table.text("title");
    sensor.source = table.text("source");
    sensor.assumptions = table.texts("assumptions");
    read_pixels(table, sensor);
    read_conversion(table, sensor.conversion);
    read_noise(table, sensor.noise);
    try {
        validate(sensor);
    } catch (const InputError& error) {
        const std::string message = error.what();  // begins with the key
        table.fail(message, table.find(message.substr(0, message.find(' '))));
    }
    return sensor;
}

/// Returns the contents of a file. Throws InputError.
std::string text_of_file(const std::string& path) {
    constexpr std::uint64_t kMaxBytes = 16 << 20;  // bytes; the bundled sensors have some thousand
    try {
        RegularFile file(path);
        if (file.size() > kMaxBytes) throw InputError(path + ": is larger than 16 MiB; expected a sensor file (.toml)");
        std::string text(file.size(), '\0');
        text.resize(file.read(text.data(), text.size()));
        return text;
    } catch (const FileError& error) {
        throw InputError(error.what());
    }
}

std::string_view bundled_text(const std::string& name) {
    for (const BundledFile& file : bundled_sensor_files())
        if (file.name == name) return file.text;
    throw InputError("unknown sensor " + in_quotes(name) + did_you_mean(name, sensor_names()) +
                     "; expected a bundled sensor or the path of a .toml file");
}

}  // namespace

std::vector<std::string> sensor_names() {
    std::vector<std::string> names;
    for (const BundledFile& file : bundled_sensor_files()) names.emplace_back(file.name);
    return names;
}

Sensor parse_sensor(std::string_view text, const std::string& file, const KeepGoing& keep_going) {
    return sensor_from_table(parse_toml(text, file, raise_input_error, keep_going), file);
}

Sensor read_sensor(const std::string& name_or_path, const KeepGoing& keep_going) {
    if (name_or_path.find_first_of("/.") == std::string::npos)
        return parse_sensor(bundled_text(name_or_path), name_or_path);
    return parse_sensor(text_of_file(name_or_path), name_or_path, keep_going);
}

}  // namespace realcam::io
