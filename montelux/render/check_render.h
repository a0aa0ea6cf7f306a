// Checks of a render before it starts: settings that exclude one another.
#pragma once

#include "montelux/mc/random/sampler_settings.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// The description's sampler; `chains` is set if the integrator walks in chains.
SamplerSettings sampler_of(const SceneDescription& description);

// Throws Error, which says what to choose instead.
void check_render(const SceneDescription& description, const SamplerSettings& sampler,
                  const RenderTarget& target);

} // namespace montelux
