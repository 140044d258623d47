#pragma once
#include <string>
#include <utility>

#include "../../error.hpp"

namespace realcam::io {

/// A glass of a lens file that no catalogue has, or several; whoever names another one for it settles that.
class UnknownGlass : public InputError {
public:
    UnknownGlass(const std::string& message, std::string glass, std::string candidate = {})
        : InputError(message), glass(std::move(glass)), candidate(std::move(candidate)) {}

    std::string glass;  ///< as the file calls it
    std::string candidate;  ///< one of several that it may be, "schott:F4"; empty where there is none
};

/// An error of a lens file that the caller may settle. How that is said is known to programs and not to a reader, whose
/// message leaves it out.
class LensReadError : public LensFileError {
public:
    using LensFileError::LensFileError;
    /// Adds the place to an error that knows none.
    LensReadError(const InputError& cause, std::string file, int line = 0, int surface = 0)
        : LensFileError(cause.what(), std::move(file), line, surface) {
        if (const auto* unknown = dynamic_cast<const UnknownGlass*>(&cause))
            glass = unknown->glass, candidate = unknown->candidate;
    }

    std::string glass, candidate;  ///< see UnknownGlass
    bool can_be_forced = false;  ///< a reader that is told to leaves out what this is about
};

}  // namespace realcam::io
