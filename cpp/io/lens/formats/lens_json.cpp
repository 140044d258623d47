#include "lens_json.hpp"

#include <cmath>
#include <stdexcept>

#include "../../text/printable.hpp"
#include "../lens_error.hpp"

namespace realcam::io {

LensJson::LensJson(std::string_view text, std::string file, const KeepGoing& keep_going) : file_(std::move(file)) {
    Checkpoint checkpoint(keep_going);
    try {
        root_ = Json::parse(text, checkpoint, JsonNumbers::with_infinity);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::runtime_error& error) {  // "line 3: ..."
        throw LensFileError("not valid JSON: " + printable(error.what()), file_);
    }
}

void LensJson::fail(const std::string& message) const {
    throw LensFileError(message, file_, 0, surface_);
}

void LensJson::fail(const InputError& cause) const {
    throw LensReadError(cause, file_, 0, surface_);
}

double LensJson::number(const Json& value, const std::string& what) const {
    if (!value.is_number() || !std::isfinite(value.number(0))) fail(what + " must be a finite number");
    return value.number(0);
}

double LensJson::number_or(const Json& value, const std::string& what, double otherwise) const {
    return value.is_null() ? otherwise : number(value, what);
}

}  // namespace realcam::io
