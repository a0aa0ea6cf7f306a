#include <cmath>
#include <cstdio>

#include "montelux/render/integrator_choice.h"
#include "montelux/scene/setting_names.h"

namespace montelux {
namespace {

// Beyond a hundred, rare samples decide how large the ratio is.
std::string times_text(double ratio) {
    if (ratio > 100) return "over 100";
    char text[32];
    std::snprintf(text, sizeof text, ratio < 10 ? "%.1f" : "%.0f", ratio);
    return text;
}

} // namespace

std::string choice_text(const IntegratorChoice& choice) {
    if (!choice.decided) return "";
    std::string text(name_of(choice.chosen));
    std::string compared, untried;
    bool has_light = false;
    for (const IntegratorChoice::Candidate& c : choice.candidates) {
        has_light = has_light || c.effort > 0;
        const std::string name(name_of(c.kind));
        if (c.outcome == CandidateOutcome::unaffordable && c.kind != choice.chosen)
            untried += (untried.empty() ? "" : " and ") + name;
        if (c.outcome != CandidateOutcome::measured || c.kind == choice.chosen) continue;
        const double ratio = choice.time_ratio(c);
        if (!(ratio > 0)) continue;
        compared += (compared.empty() ? "to the same error " : ", ") + name + " would take " +
                    times_text(ratio) + (compared.empty() ? " times as long" : " times") +
                    (ratio < 1 ? " (too uncertain)" : "");
    }
    if (choice.missing > 0) {
        char share[48];
        std::snprintf(share, sizeof share, "path tracing would lack %.2g %% of the light",
                      100 * choice.missing);
        compared = share;
    }
    if (compared.empty() && choice.cpu_seconds > 0 && !has_light) compared = "the pilot found no light";
    if (!compared.empty()) text += ": " + compared;
    if (!untried.empty())
        text += (compared.empty() ? ": " : "; ") + std::string("the render is too short to try ") + untried;
    else if (compared.empty())
        text += ": no other integrator can render this scene with these settings";
    return text;
}

} // namespace montelux
