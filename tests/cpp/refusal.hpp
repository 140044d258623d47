#pragma once
// What the user is told when an input is refused.

#include <string>

#include "error.hpp"

namespace realcam::test {

/// The message of the error that f throws: an InputError, or an error of the kind that is named.
template <class Refusal = InputError, class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const Refusal& error) {
        return error.what();
    }
    return "(no error)";
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace realcam::test
