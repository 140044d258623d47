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

/// A shot in which there is nothing to decide upon.
struct NothingToPlan : InputError {
    using InputError::InputError;
};

/// Who decided.
enum class DecidedBy { planner, user };

/// One thing that a picture may have or do without.
struct PlanDecision {
    std::string name;
    double size;  ///< by how much the picture changes where it is left out; infinite: beyond all measure
    SizeUnit unit;
    double threshold;
    bool is_kept;
    DecidedBy by = DecidedBy::planner;
    std::optional<double>
        time;  ///< that it adds to the picture's, as a share of that without any effect; where measured
    std::string reason;  ///< a sentence

    bool operator==(const PlanDecision&) const = default;
};

/// What a shot calls for.
struct Plan {
    CameraModel model = CameraModel::full_lens;  ///< the cheapest that looks like every surface of the lens
    EffectChoice effects;
    int max_bounces = 1;  ///< of light in the scene
    std::vector<PlanDecision> decisions;
};

}  // namespace REALCAM_NAMESPACE
