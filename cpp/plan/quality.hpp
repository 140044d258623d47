#pragma once
#include <optional>
#include <string>

#include "plan.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr const char* kQualityNames = "draft, photo or reference";

/// Thresholds by a name; nothing for one that is none.
inline std::optional<PlanThresholds> quality_named(const std::string& name) {
    if (name == "draft") return PlanThresholds{2, 4};
    if (name == "photo") return PlanThresholds{};
    if (name == "reference") return PlanThresholds{0.1, 0.25};
    return std::nullopt;
}

}  // namespace REALCAM_NAMESPACE
