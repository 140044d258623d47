#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../camera/effects/effects.hpp"
#include "../camera/models/camera_view.hpp"
#include "../error.hpp"
#include "../number_text.hpp"
#include "../render/settings/render_settings.hpp"

namespace REALCAM_NAMESPACE {

// Result of planning: decisions with their reasons, and their text.

/// Unit of the change that an effect makes to a picture: pixels, or codes (8-bit display values).
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
    double threshold;  ///< size from which on the effect is simulated, in the same unit
    bool is_kept;      ///< true: the effect is simulated
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

inline const char* name_of(SizeUnit unit) {
    return unit == SizeUnit::pixels ? "px" : "codes";
}

/// A size with its unit: "31 px", "1 code".
inline std::string size_text(double size, SizeUnit unit) {
    return unit == SizeUnit::pixels ? number_text(size, 3) + " px" : counted(size, "code", 3);
}

/// One-line summary for a picture's metadata: "ghosts 0.3 codes left out, defocus 31 px kept".
inline std::string summary_of(const Plan& plan) {
    std::string text;
    for (const PlanDecision& decision : plan.decisions)
        text += (text.empty() ? "" : ", ") + decision.name + ' ' + size_text(decision.size, decision.unit) +
                (decision.is_kept ? " kept" : " left out") + (decision.by == DecidedBy::user ? " as requested" : "");
    return text;
}

/// Plan as a table of text. `model_name`: name of the plan's camera model.
inline std::string text_of(const Plan& plan, const std::string& model_name) {
    using Row = std::array<std::string, 6>;
    std::vector<Row> rows = {{"effect", "size", "threshold", "", "time", "because"}};
    for (const PlanDecision& decision : plan.decisions) {
        rows.push_back({decision.name, size_text(decision.size, decision.unit),
                        size_text(decision.threshold, decision.unit),
                        std::string(decision.is_kept ? "kept" : "left out") +
                            (decision.by == DecidedBy::user ? " as requested" : ""),
                        decision.time ? "+" + number_text(100 * *decision.time, 2) + "%" : "", decision.reason});
    }
    std::array<std::size_t, 6> width{};
    for (const Row& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    std::string text = "camera model " + model_name + ", max_bounces " + std::to_string(plan.max_bounces) + "\n\n";
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += row[c] + std::string(c + 1 < row.size() ? width[c] - row[c].size() + 2 : 0, ' ');
        text += line + '\n';
    }
    return text;
}

}  // namespace REALCAM_NAMESPACE
