#pragma once
#include <optional>
#include <string>
#include <vector>

#include "../camera/camera_view.hpp"
#include "../camera/effects.hpp"
#include "../error.hpp"
#include "../render/plan_thresholds.hpp"

namespace REALCAM_NAMESPACE {

enum class SizeUnit { pixels, codes };

/// Thrown for a shot with nothing to decide upon, because the camera sees no object and no light.
struct NothingToPlan : InputError {
    using InputError::InputError;
};

/// The origin of a decision.
enum class DecidedBy { planner, user };

/// Decision on one effect that a picture may have or do without.
struct PlanDecision {
    std::string name;
    double size;  ///< change of the picture if the effect is left out; may be infinite
    SizeUnit unit;
    double threshold;
    bool is_kept;
    DecidedBy by = DecidedBy::planner;
    std::optional<double>
        time;  ///< additional time as a fraction of the time without any effect; std::nullopt if not measured
    std::string reason;  ///< a sentence

    bool operator==(const PlanDecision&) const = default;
};

/// Camera model, effects and bounces that a shot requires.
struct Plan {
    CameraModel model = CameraModel::full_lens;  ///< the cheapest whose picture matches that of the full lens
    EffectChoice effects;
    int max_bounces = 1;  ///< largest number of bounces of light in the scene
    std::vector<PlanDecision> decisions;
};

}  // namespace REALCAM_NAMESPACE
