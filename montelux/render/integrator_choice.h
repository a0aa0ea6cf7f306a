// choose_integrator: which integrator takes least time to an error, by short pilots (docs/integrator-choice.md).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/prepared_scene.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"

namespace montelux {

struct IntegratorChoiceSettings {
    // The target of a render by an integrator: not all can adapt their samples.
    std::function<RenderTarget(IntegratorKind)> target;
    const CancelFlag* cancel = nullptr;
};

// The render by the chosen integrator, to be continued.
struct ChosenIntegrator {
    RenderState state; // with the samples of its pilot, and the choice in its report
    std::shared_ptr<const PreparedScene> prepared;
    std::vector<std::string> refusals; // why others cannot render this scene
};

// Chooses for a description whose integrator is automatic, and sets it there. Null, and nothing set, if it was
// cancelled. Throws Error for a slice, and as check_render() does if not even the path integrator can render it.
//
// The choice depends on scene, settings, target and seed: time is estimated by the rays that a sample takes, so that it
// does not depend on the machine, on other work on it or on the number of threads. With a time limit the size of the
// pilots depends on how fast the machine is.
//
// A render continued from the state ends with the same bits as one by the same integrator from the start.
std::shared_ptr<ChosenIntegrator> choose_integrator(SceneDescription& description,
                                                    const IntegratorChoiceSettings& settings);

// "bidirectional: to the same error path takes 8 times as long", for people.
std::string choice_text(const IntegratorChoice& choice);

} // namespace montelux
