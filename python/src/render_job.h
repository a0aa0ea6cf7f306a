// RenderJob: a render in a background thread that never takes Python's lock.
#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "montelux/denoise/denoise_image.h"
#include "montelux/render/render_session.h"
#include "montelux/view/view_server.h"
#include "montelux/view/viewed_render.h"

namespace montelux::python {

class RenderJob {
  public:
    // Builds the scene's tables and starts; throws Error for invalid settings. The description must not
    // change afterwards.
    RenderJob(std::shared_ptr<const SceneDescription> description, RenderSessionSettings settings,
              int threads, bool denoise, bool view);
    ~RenderJob();
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    void cancel() { cancel_.request(); }
    // The address of the page that shows the render; empty without one.
    std::string view_url() const { return server_ ? server_->url() : std::string(); }
    // Waits until the render has ended, at most this many seconds; returns whether it has.
    bool wait(double seconds);
    RenderProgress progress() const;
    // RenderSession::snapshot; also while the page has paused the render.
    std::optional<RenderSnapshot> snapshot(double seconds) {
        return viewed_ ? viewed_->snapshot(seconds) : session_.snapshot(seconds);
    }
    // After the end; rethrows the error that ended it.
    RenderSnapshot result() const;
    const RenderSession& session() const { return session_; }

  private:
    void run();

    RenderSession session_;
    int threads_;
    std::optional<Denoiser> denoiser_;
    CancelFlag cancel_;
    std::optional<ViewedRender> viewed_;
    std::optional<ViewServer> server_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool ended_ = false;
    std::exception_ptr failure_;
    RenderProgress progress_;
    std::optional<RenderSnapshot> result_;
    std::thread thread_;
};

} // namespace montelux::python
