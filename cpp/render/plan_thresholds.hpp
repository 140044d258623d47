#pragma once
#include <optional>
#include <string>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Sizes from which on the planner simulates an effect (cpp/plan).
struct PlanThresholds {
    double pixels = 0.5;  ///< displacement or blur
    double codes = 1;     ///< change of an 8-bit code of the developed picture

    bool operator==(const PlanThresholds&) const = default;
};

inline constexpr const char* kQualityNames = "draft, photo or reference";

/// Thresholds of a named quality; std::nullopt if the name is unknown.
inline std::optional<PlanThresholds> quality_named(const std::string& name) {
    if (name == "draft") return PlanThresholds{2, 4};
    if (name == "photo") return PlanThresholds{};
    if (name == "reference") return PlanThresholds{0.1, 0.25};
    return std::nullopt;
}

}  // namespace REALCAM_NAMESPACE
