// The loop over rounds of a render, until its target is reached.
#pragma once

#include "montelux/render/metropolis/chain_renderer.h"
#include "montelux/render/render_control.h"
#include "montelux/render/renderer.h"
#include "montelux/render/sample_context.h"

namespace montelux {

// As Renderer::render. The context is made for the renderer's scene, and may get a guide. `chains`: take the samples;
// null: tiles do.
void run_render_loop(const Renderer& renderer, SampleContext& context, ChainRenderer* chains,
                     RenderState& state, const RenderControl& control);

} // namespace montelux
