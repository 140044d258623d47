#include "prescription_json.hpp"

#include <cmath>
#include <stdexcept>

namespace realcam::io {

PrescriptionJson::PrescriptionJson(const char* format, std::string_view text, const std::string& file,
                                   LensGlasses& glasses)
    : PrescriptionReader(format, file, glasses) {
    Checkpoint checkpoint(glasses.options().keep_going);
    try {
        root_ = Json::parse(text, checkpoint, JsonNumbers::with_infinity);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::runtime_error& error) {  // "line 3: ..."
        fail("not valid JSON: " + printable(error.what()));
    }
}

double PrescriptionJson::number(const Json& value, const std::string& what) const {
    if (!value.is_number() || !std::isfinite(value.number(0))) fail(what + " must be a finite number");
    return value.number(0);
}

double PrescriptionJson::number_or(const Json& value, const std::string& what, double default_value) const {
    return value.is_null() ? default_value : number(value, what);
}

std::vector<double> PrescriptionJson::numbers(const Json& list, const std::string& what, std::size_t max_count) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < list.size() && i < max_count; ++i) values.push_back(number(list[i], what));
    return values;
}

bool PrescriptionJson::is_infinite(const Json& value) {
    return value.is_number() && std::isinf(value.number(0));
}

void PrescriptionJson::check_count(std::size_t surfaces, const std::string& what) const {
    if (surfaces < 3) fail("expected " + what + " with an object, a lens and an image");
    if (surfaces > kMaxFileSurfaces) fail("the file has more than " + std::to_string(kMaxFileSurfaces) + " surfaces");
}

void PrescriptionJson::add_terms(const Json& list, int step, const std::string& what, PrescriptionSurface& row,
                                 double unit) const {
    int power = 0;
    for (const double value : numbers(list, what, 100)) add_term(row, power += step, value, unit);
}

void PrescriptionJson::add_field(const Json& field, double scale, const std::array<const char*, 4>& vignetting_keys) {
    const auto value = [&](const char* key) { return number_or(field[key], "a field", 0); };
    p_.fields.push_back({scale * value("x"), scale * value("y"), vignetting(value(vignetting_keys[0])),
                         vignetting(value(vignetting_keys[1])), vignetting(value(vignetting_keys[2])),
                         vignetting(value(vignetting_keys[3]))});
}

}  // namespace realcam::io
