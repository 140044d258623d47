#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "../../text/json.hpp"
#include "../../text/printable.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {

/// Returns a name of a file for a message, as one line that is cut to a length.
inline std::string short_name(const std::string& name, std::size_t most = 40) {
    return printable(name).substr(0, most);
}

/// Base of the readers of JSON files: access to members, with error messages that name file and surface.
class PrescriptionJson : protected PrescriptionReader {
public:
    /// Parses the text. Throws LensFileError, with the line, for invalid JSON, and Cancelled.
    PrescriptionJson(const char* format, std::string_view text, const std::string& file, LensGlasses& glasses);

protected:
    [[noreturn]] void fail(const std::string& message) const { fail_at(message, 0, surface_); }
    [[noreturn]] void fail(const InputError& cause) const { throw LensReadError(cause, p_.file, 0, surface_); }
    void foreign(const std::string& what) { add_foreign(what, 0, surface_); }

    /// Returns a finite number; otherwise fails with a message that begins with `what`.
    double number(const Json& value, const std::string& what) const;
    /// Returns a finite number, or `otherwise` if it is absent or null.
    double number_or(const Json& value, const std::string& what, double otherwise) const;
    std::vector<double> numbers(const Json& list, const std::string& what, std::size_t most = kMostFileIndices) const;
    static bool is_infinite(const Json& value);

    /// Throws LensFileError if a file has no lens, with `what` it has instead, or too many surfaces.
    void check_count(std::size_t surfaces, const std::string& what) const;
    /// Adds aspheric terms of r^step, r^(2 step), ..., in a unit of length given in mm.
    void add_terms(const Json& list, int step, const std::string& what, PrescriptionSurface& row,
                   double unit = 1) const;
    /// Adds a field. `cuts`: members for the vignetting at +x, -x, +y and -y.
    void add_field(const Json& field, double scale, const std::array<const char*, 4>& cuts);

    Json root_;
    int surface_ = 0;  ///< the one that messages name; 0: none
};

}  // namespace realcam::io
