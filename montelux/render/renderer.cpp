#include "montelux/render/renderer.h"

#include <optional>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/render/check_render.h"
#include "montelux/render/metropolis/chain_renderer.h"
#include "montelux/render/render_loop.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {

Renderer::Renderer(const SceneDescription& description, const RenderTarget& target,
                   std::uint32_t replicate_points, std::shared_ptr<const PreparedScene> prepared)
    : description_(description), target_(target),
      sampler_(with_replicates(with_points(sampler_of(description), replicate_points), target)),
      camera_(description.scene.camera, description.film.width, description.film.height) {
    check_render(description, with_points(sampler_of(description), replicate_points), target);
    scene_digest_ = digest_of(description.scene);
    prepared_ = prepared ? std::move(prepared) : std::make_shared<const PreparedScene>(description);
}

void Renderer::set_target(const RenderTarget& target) {
    if (target.adaptive != target_.adaptive || target.slice != target_.slice)
        throw Error("render", "allocation and slice cannot change while a picture is rendered");
    target_ = target;
}

std::vector<MemoryUse> Renderer::memory_use() const {
    std::vector<MemoryUse> table = montelux::memory_use(description_.scene);
    for (const MemoryUse& use : prepared_->memory_use()) table.push_back(use);
    const PixelBounds& crop = description_.film.crop;
    const std::size_t pixels =
        static_cast<std::size_t>(crop.width()) * static_cast<std::size_t>(crop.height());
    table.push_back(
        {"film", pixels * (sizeof(Pixel) + sizeof(std::uint32_t)), pixels, "pixels"}); // and target counts
    return table;
}

void Renderer::serve(const std::function<void(const SampleTakers&)>& work) const {
    SampleContext context(description_, sampler_, scene(), camera_);
    const SampleOrder order(sampler_, target_.slice);
    std::optional<ChainRenderer> chains;
    if (sampler_.chains) chains.emplace(description_, sampler_, scene(), camera_, accelerator(), order);
    work({context, TileRenderer(context, accelerator(), order), chains ? &*chains : nullptr});
}

void Renderer::render(RenderState& state, const RenderControl& control) const {
    SampleContext context(description_, sampler_, scene(), camera_);
    if (description_.integrator.guiding == Guiding::on && !context.can_be_guided())
        throw Error("guiding",
                    "only the path integrator can be guided, by a strategy other than 'uniform': leave "
                    "guiding to 'auto' elsewhere, or turn it off");
    if (context.makes_splats() && !state.splats) state.splats.emplace(state.film.bounds());
    if (context.merges() && !state.bias) state.bias.emplace(state.film.bounds());
    if (state.film.layers().channels() != context.layers().channels())
        throw Error("film", "its layers are not those of the scene's film");
    std::optional<ChainRenderer> chains;
    if (sampler_.chains)
        chains.emplace(description_, sampler_, scene(), camera_, accelerator(),
                       SampleOrder(sampler_, target_.slice));
    run_render_loop(*this, context, chains ? &*chains : nullptr, state, control);
}

RenderReport Renderer::render(Film& film, const ProgressCallback& progress, const CancelFlag* cancel) const {
    RenderState state(description_);
    RenderControl control;
    control.progress = progress;
    control.cancel = cancel;
    render(state, control);
    film = std::move(state.film);
    return state.report;
}

} // namespace montelux
