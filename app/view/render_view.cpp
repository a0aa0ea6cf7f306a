#include "app/view/render_view.h"

#include "app/interrupt.h"
#include "app/usage_error.h"
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/error.h"
#include "montelux/view/orbit_camera.h"

namespace montelux::app {

namespace {

std::shared_ptr<const Image> reference_of(const std::string& file, const PixelBounds& bounds) {
    if (file.empty()) return nullptr;
    auto image = std::make_shared<Image>(read_image(file));
    if (image->color_channels().empty())
        throw Error(file, "the picture has neither the channels R, G, B nor Y");
    if (image->width() != bounds.width() || image->height() != bounds.height())
        throw UsageError("--reference", file + " has " + std::to_string(image->width()) + " x " +
                                            std::to_string(image->height()) + " pixels, the render " +
                                            std::to_string(bounds.width()) + " x " +
                                            std::to_string(bounds.height()));
    return image;
}

} // namespace

RenderView::RenderView(const RenderOptions& options, ToneCurve tone, SceneDescription& description,
                       std::unique_ptr<RenderSession>& session)
    : description_(description), session_(session), camera_(description.scene.camera),
      layers_(description.film.layers.set), viewed_(settings_of(options)) {
    const std::string name = std::filesystem::path(options.scene).filename().string();
    if (options.view.page) {
        ViewServerSettings settings;
        settings.address = options.view.host;
        settings.port = static_cast<std::uint16_t>(options.view.port);
        settings.introduction.name = name;
        settings.introduction.spp = description.sampler.spp;
        settings.introduction.tone = tone.kind;
        if (!options.tone.automatic) settings.introduction.exposure = tone.exposure;
        server_.emplace(viewed_, settings);
        std::fprintf(stderr, "The render is shown at %s\n", server_->url().c_str());
    }
    if (!options.view.tev.empty()) tev_.emplace(viewed_, options.view.tev, name);
}

RenderView::~RenderView() = default;

ViewedRenderSettings RenderView::settings_of(const RenderOptions& options) {
    ViewedRenderSettings settings;
    settings.stays = options.view.stays;
    settings.cancel = &cancel_on_signals();
    settings.reference = reference_of(options.view.reference, description_.film.crop);
    // A checkpoint, and pictures that were asked for, are of the scene as it is.
    if (options.view.stays && options.checkpoint.empty())
        settings.restart = [this](const ViewChange& change) -> RenderSession& { return restart(change); };
    return settings;
}

RenderSession& RenderView::restart(const ViewChange& change) {
    description_.scene.camera = camera_;
    const Vec3d pivot = orbit_pivot(session_->renderer());
    RenderSessionSettings settings = session_->settings();
    settings.prepared = session_->renderer().prepared();
    const std::shared_ptr<const SceneDescription> description = session_->shared_description();
    session_.reset(); // before its description changes
    description_.scene.camera = orbited(camera_, pivot, change.orbit);
    description_.film.layers.set = layers_;
    if (change.light_groups) description_.film.layers.set.add(Layer::light_groups);
    session_ = std::make_unique<RenderSession>(description, std::move(settings));
    return *session_;
}

void RenderView::render(const RenderCompany& company) { viewed_.run(*session_, company); }

} // namespace montelux::app
