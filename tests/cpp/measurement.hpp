#pragma once
// Accuracy as a measured figure: a test states what it tried, the worst error that it found and the limit, and the same
// statement is the assertion and a line of docs/generated/numerics.md (`./run numerics`).

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "doctest/doctest.h"

namespace realcam::test {

struct Measurement {
    std::string section;  ///< section of the page: Surfaces, Rays, Lenses, Scenes, Sums, Iteration, Bundled lenses, ...
    std::string what;  ///< the hard case, in a few words
    std::string tried;  ///< number and kind of the cases
    std::string backend;  ///< "core" if no backend is involved
    std::string number_type;  ///< float32, float64
    double worst;  ///< the largest error found
    double limit;  ///< largest error allowed
    std::string unit;  ///< of `worst` and `limit`
};

namespace measurement_detail {

/// JSON number in the spelling of Python's json module, which has NaN and Infinity.
inline std::string json_number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// Appends one line of JSON to the file that REALCAM_MEASUREMENTS names. The texts hold no quotes.
inline void write(const Measurement& m, const char* kind) {
    const char* path = std::getenv("REALCAM_MEASUREMENTS");
    if (!path) return;
    std::FILE* file = std::fopen(path, "a");
    REQUIRE_MESSAGE(file, "cannot write to ", path);
    std::fprintf(file,
                 "{\"kind\": \"%s\", \"section\": \"%s\", \"what\": \"%s\", \"tried\": \"%s\", \"backend\": \"%s\", "
                 "\"number_type\": \"%s\", \"worst\": %s, \"limit\": %s, \"unit\": \"%s\"}\n",
                 kind, m.section.c_str(), m.what.c_str(), m.tried.c_str(), m.backend.c_str(), m.number_type.c_str(),
                 json_number(m.worst).c_str(), json_number(m.limit).c_str(), m.unit.c_str());
    std::fclose(file);
}

}  // namespace measurement_detail

/// The worst error stays within the limit. A NaN does not.
inline void hold(const Measurement& m) {
    CAPTURE(m.what);
    CAPTURE(m.number_type);
    CAPTURE(m.backend);
    CHECK(m.worst <= m.limit);
    measurement_detail::write(m, "held");
}

/// A deliberately broken copy of a routine goes past the limit: the test that holds the real one can fail.
inline void breaks(const Measurement& m) {
    CAPTURE(m.what);
    CHECK_FALSE(m.worst <= m.limit);
    measurement_detail::write(m, "broken");
}

}  // namespace realcam::test
