#pragma once
#include <string>
#include <utility>

#include "../../error.hpp"

namespace realcam::io {

/// Error of a glass name in a lens file that is unknown or ambiguous. The caller can resolve it by specifying a glass
/// for the name.
class UnknownGlass : public InputError {
public:
    UnknownGlass(const std::string& message, std::string glass, std::string candidate = {})
        : InputError(message), glass(std::move(glass)), candidate(std::move(candidate)) {}

    std::string glass;  ///< name in the file
    std::string candidate;  ///< one of several possible glasses, "schott:F4"; empty if there are none
};

/// Error of a lens file that the caller may be able to resolve by options. The message does not mention the options,
/// because their names depend on the program.
class LensReadError : public LensFileError {
public:
    using LensFileError::LensFileError;
    /// Adds the position in the file to an error without one.
    LensReadError(const InputError& cause, std::string file, int line = 0, int surface = 0)
        : LensFileError(cause.what(), std::move(file), line, surface) {
        if (const auto* unknown = dynamic_cast<const UnknownGlass*>(&cause))
            glass = unknown->glass, candidate = unknown->candidate;
    }

    std::string glass, candidate;  ///< see UnknownGlass
    bool can_be_forced = false;  ///< true if LensReadOptions::force omits the feature
};

}  // namespace realcam::io
