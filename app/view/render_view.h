// RenderView: a render of the program that is shown while it runs.
#pragma once

#include "app/render/render_options.h"
#include <memory>
#include <optional>

#include "montelux/image/image.h"
#include "montelux/render/render_session.h"
#include "montelux/scene/render_settings.h"
#include "montelux/view/tev_stream.h"
#include "montelux/view/view_server.h"
#include "montelux/view/viewed_render.h"

namespace montelux::app {

class RenderView {
  public:
    // `session`: of the render, exchanged for another one when a page restarts it, with `description` changed for that.
    // All must outlive this. Prints the address of the page. Throws Error for a page that cannot be served, a reference
    // that does not fit, and where no tev listens.
    RenderView(const RenderOptions& options, ToneCurve tone, SceneDescription& description,
               std::unique_ptr<RenderSession>& session);
    ~RenderView();
    RenderView(const RenderView&) = delete;
    RenderView& operator=(const RenderView&) = delete;

    // The render, and after it, with ViewOptions::stays, the wait for its end.
    void render(const RenderCompany& company);
    // The finished picture.
    void show(const RenderSnapshot& finished) { viewed_.show(finished); }

  private:
    RenderSession& restart(const ViewChange& change);
    ViewedRenderSettings settings_of(const RenderOptions& options);

    SceneDescription& description_;
    std::unique_ptr<RenderSession>& session_;
    // As the scene has them.
    CameraSettings camera_;
    LayerSet layers_;
    ViewedRender viewed_;
    std::optional<ViewServer> server_;
    std::optional<TevStream> tev_;
};

} // namespace montelux::app
