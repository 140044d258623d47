#include "values.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../error.hpp"
#include "../shot/names.hpp"

namespace realcam::app {
namespace {

[[noreturn]] void fail(const std::string& option, const std::string& text, const std::string& wanted) {
    throw InputError(option + ": \"" + text + "\" is not " + wanted);
}

/// The whole text as a number; false where it is none. strtod also knows "inf" and "nan".
bool read_number(const std::string& text, double& value) {
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return !text.empty() && end == text.c_str() + text.size() && !std::isspace(static_cast<unsigned char>(text[0]));
}

bool read_numbers(const std::string& text, char separator, std::size_t count, std::vector<double>& values) {
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        double value = 0;
        if (!read_number(text.substr(start, end - start), value) || !std::isfinite(value)) return false;
        values.push_back(value);
        start = end + 1;
    }
    return values.size() == count;
}

}  // namespace

std::optional<double> number_in(const std::string& text) {
    double value = 0;
    if (!read_number(text, value) || std::isnan(value)) return std::nullopt;
    return value;
}

double parse_number(const std::string& option, const std::string& text) {
    const auto value = number_in(text);
    if (!value || std::isinf(*value)) fail(option, text, "a number");
    return *value;
}

double parse_distance(const std::string& option, const std::string& text) {
    const auto value = number_in(text);
    if (!value) fail(option, text, "a number of metres or inf");
    return *value;
}

std::optional<double> parse_focus(const std::string& option, const std::string& text) {
    if (text == "auto") return std::nullopt;
    if (!number_in(text)) fail(option, text, "a number of metres, inf or auto");
    return parse_distance(option, text);
}

std::uint64_t parse_whole(const std::string& option, const std::string& text, std::uint64_t most) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > most)
        fail(option, text, "a whole number from 0 to " + std::to_string(most));
    return value;
}

std::optional<double> parse_exposure_time(const std::string& option, const std::string& text) {
    if (text == "auto") return std::nullopt;
    std::vector<double> parts;
    if (read_numbers(text, '/', 1, parts)) return parts[0];
    parts.clear();
    if (!read_numbers(text, '/', 2, parts) || parts[1] == 0)
        fail(option, text, "a number of seconds, such as 0.5 or 1/125, or auto");
    return parts[0] / parts[1];
}

Vec3d parse_point(const std::string& option, const std::string& text) {
    std::vector<double> v;
    if (!read_numbers(text, ',', 3, v)) fail(option, text, "three numbers with commas, such as 0,1.5,-2");
    return {v[0], v[1], v[2]};
}

std::array<double, 2> parse_size(const std::string& option, const std::string& text) {
    std::vector<double> v;
    if (!read_numbers(text, 'x', 2, v)) fail(option, text, "a width and a height in mm, such as 36x24");
    return {v[0], v[1]};
}

std::array<double, 2> parse_shift(const std::string& option, const std::string& text) {
    std::vector<double> v;
    if (!read_numbers(text, ',', 2, v)) fail(option, text, "two lengths in mm with a comma, such as 0,8");
    return {v[0], v[1]};
}

std::array<int, 2> parse_resolution(const std::string& option, const std::string& text) {
    std::vector<double> v;
    const auto whole = [](double n) { return n == std::floor(n) && std::fabs(n) < 2e9; };
    if (!read_numbers(text, 'x', 2, v) || !whole(v[0]) || !whole(v[1]))
        fail(option, text, "a width and a height in pixels, such as 960x640");
    return {static_cast<int>(v[0]), static_cast<int>(v[1])};
}

CameraModel parse_model(const std::string& text) {
    const auto model = shot::model_named(text);
    if (!model) fail("--model", text, shot::kModelNames);
    return *model;
}

ToneCurve parse_tone(const std::string& text) {
    const auto tone = shot::tone_named(text);
    if (!tone) fail("--tone", text, shot::kToneNames);
    return *tone;
}

std::string distance_text(double metres) {
    return number_text(metres) + (std::isfinite(metres) ? " m" : "");
}

std::string exposure_text(double seconds) {
    const double inverse = 1 / seconds;
    if (inverse < 2.5) return number_text(seconds) + " s";
    constexpr double kMostInFull = 1e6;  // no shutter is faster
    const bool in_full = inverse >= 10 && inverse <= kMostInFull;
    return "1/" + (in_full ? std::to_string(std::llround(inverse)) : number_text(inverse, 2)) + " s";
}

}  // namespace realcam::app
