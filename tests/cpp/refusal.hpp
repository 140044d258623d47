#pragma once
// Messages for rejected inputs.

#include <string>

#include "error.hpp"

namespace realcam::test {

/// Message of the error that f throws: an InputError, or an error of the type `Refusal`.
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
