#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "../../text/json.hpp"
#include "../../text/printable.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {

/// Returns a name in a file for a message: printable, and truncated to `max_length` characters.
inline std::string printable_name(const std::string& name, std::size_t max_length = 40) {
    return printable(name).substr(0, max_length);
}

/// Base of the readers of JSON files: access to members, with error messages that name file and surface.
class PrescriptionJson : protected PrescriptionReader {
public:
    /// Parses the text. Throws LensFileError, with the line, for invalid JSON, and Cancelled.
    PrescriptionJson(const char* format, std::string_view text, const std::string& file, LensGlasses& glasses);

protected:
    // Throw LensFileError at the current surface.
    [[noreturn]] void fail(const std::string& message) const { fail_at(message, 0, surface_); }
    [[noreturn]] void fail(const InputError& cause) const { throw LensReadError(cause, p_.file, 0, surface_); }
    /// Records a feature that realcam does not model, at the current surface. `description`: a noun phrase.
    void unsupported(const std::string& description) { add_unsupported(description, 0, surface_); }

    /// Returns a finite number. `what`: noun phrase for the value, which begins the message of the error for other
    /// values.
    double number(const Json& value, const std::string& what) const;
    /// Returns a finite number, or `default_value` if the value is absent or null.
    double number_or(const Json& value, const std::string& what, double default_value) const;
    /// Returns the first `max_count` elements of a list as finite numbers.
    std::vector<double> numbers(const Json& list, const std::string& what,
                                std::size_t max_count = kMaxFileIndices) const;
    /// True if the value is an infinite number.
    static bool is_infinite(const Json& value);

    /// Throws LensFileError if there are fewer than three surfaces or too many. `what`: name of the expected list of
    /// surfaces, for the message.
    void check_count(std::size_t surfaces, const std::string& what) const;
    /// Adds aspheric terms of r^step, r^(2 step), ..., with lengths in units of `unit` mm.
    void add_terms(const Json& list, int step, const std::string& what, PrescriptionSurface& row,
                   double unit = 1) const;
    /// Adds a field point with the members x and y, times `scale`. `vignetting_keys`: members with the vignetting
    /// factors at the pupil's +x, -x, +y and -y edges.
    void add_field(const Json& field, double scale, const std::array<const char*, 4>& vignetting_keys);

    Json root_;  ///< the whole file
    int surface_ = 0;  ///< number of the current surface, which messages name; 0: none
};

}  // namespace realcam::io
