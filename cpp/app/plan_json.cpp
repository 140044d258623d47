#include "plan_json.hpp"

#include <limits>

#include "../io/files/image_metadata.hpp"
#include "../io/text/json_writer.hpp"
#include "../plan/plan_text.hpp"
#include "../render/effect_names.hpp"

namespace realcam::app {

std::string json_of(const Plan& plan) {
    io::JsonWriter json;
    json.begin_object().key("model").text(io::name_of(plan.model)).key("effects").begin_array();
    for (const std::string& name : names_of(plan.effects)) json.text(name);
    json.end().key("decisions").begin_array();
    for (const PlanDecision& decision : plan.decisions) {
        json.begin_object()
            .key("effect")
            .text(decision.name)
            .key("size")
            .number(decision.size)
            .key("threshold")
            .number(decision.threshold)
            .key("unit")
            .text(name_of(decision.unit))
            .key("decision")
            .text(decision.is_kept ? "kept" : "left out")
            .key("by")
            .text(decision.by == DecidedBy::user ? "user" : "planner")
            .key("time_share")
            .number(decision.time.value_or(std::numeric_limits<double>::quiet_NaN()))
            .key("reason")
            .text(decision.reason)
            .end();
    }
    return json.end().end().finish() + '\n';
}

}  // namespace realcam::app
