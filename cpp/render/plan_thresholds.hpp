#pragma once
#include <optional>
#include <string>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// From which size on something is simulated, where the planner decides (cpp/plan).
struct PlanThresholds {
    double pixels = 0.5;  ///< by which something moves or is blurred
    double codes = 1;     ///< by which an 8-bit code of the developed picture changes

    bool operator==(const PlanThresholds&) const = default;
};

inline constexpr const char* kQualityNames = "draft, photo or reference";

/// Thresholds by a name; nothing for one that is none.
inline std::optional<PlanThresholds> quality_named(const std::string& name) {
    if (name == "draft") return PlanThresholds{2, 4};
    if (name == "photo") return PlanThresholds{};
    if (name == "reference") return PlanThresholds{0.1, 0.25};
    return std::nullopt;
}

}  // namespace REALCAM_NAMESPACE
