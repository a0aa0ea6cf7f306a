// ViewedRender: a render that viewers watch, pause, retarget, restart and stop.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/render_session.h"
#include "montelux/render/sample_record.h"
#include "montelux/view/live_picture.h"

namespace montelux {

enum class ViewState : std::uint8_t { preparing, rendering, paused, ended };

// Where the camera stands, relative to the scene's own: it turns about what it looks at.
struct ViewOrbit {
    double azimuth = 0, elevation = 0; // degrees
    double zoom = 1;                   // its distance is divided by this

    bool operator==(const ViewOrbit&) const = default;
};
// What takes a new render of the same scene.
struct ViewChange {
    ViewOrbit orbit{};
    bool light_groups = false; // a layer for each light

    bool operator==(const ViewChange&) const = default;
};

struct ViewStatus {
    ViewState state = ViewState::preparing;
    std::optional<RenderStop> ended_by{};
    RenderProgress progress{};
    RenderTarget target{};
    // Seconds and error of the picture (FilmError::relative), since the start.
    std::vector<std::pair<double, double>> curve{};
    std::uint32_t epoch = 0; // counts restarts
    ViewChange change{};
    std::uint64_t version = 0; // counts changes of this status
};

struct ViewedRenderSettings {
    // After the render: wait for quit(), or for limits that let it continue.
    bool stays = false;
    // Of other processes and signals; null: none.
    const CancelFlag* cancel = nullptr;
    // A picture to compare with, of the size of the render; null: none.
    std::shared_ptr<const Image> reference{};
    // Makes the session of a change. It destroys the one before; null: nothing can be changed.
    std::function<RenderSession&(const ViewChange&)> restart{};
};

class ViewedRender {
  public:
    explicit ViewedRender(ViewedRenderSettings settings) : settings_(std::move(settings)) {}

    // Renders, as the viewers ask. Returns the last session, whose render has ended and is not finished. Its picture is
    // the same to the last bit as without viewers, if they have neither restarted nor retargeted it.
    RenderSession& run(RenderSession& session, const RenderCompany& company);
    // After run(): the finished picture, which pages see from now on.
    void show(const RenderSnapshot& finished);

    // All that follows may be called from any thread while run() runs.

    const ViewedRenderSettings& settings() const { return settings_; }
    ViewStatus status() const;
    std::uint64_t status_version() const;
    ViewState state() const;
    // Of the current epoch; null before the first.
    std::shared_ptr<LivePicture> picture() const;
    // Ends the render if ViewedRenderSettings::cancel asks for it. To be called several times a second.
    void poll();

    void pause();
    void resume();
    void stop();
    void quit();
    // Limits of error and time; 0: none.
    void set_limits(double error, double time);
    // Throws Error where the render cannot be restarted.
    void change(const ViewChange& change);

    // The picture so far, with all layers; waits `seconds` at most. Empty while there is none.
    std::optional<RenderSnapshot> snapshot(double seconds);
    // The path of a sample as an outline (sample_record_text.h). Throws Error as Renderer::replay does.
    std::string replay(int x, int y, std::uint64_t index);

  private:
    enum class Next : std::uint8_t { go_on, restart, leave };

    void open(RenderSession& session);
    void watch(const RenderProgress& progress, const ProgressCallback& other);
    Next wait(RenderSession& session, const RenderReport& report);
    void set_state(ViewState state);
    bool is_cancelled() const { return settings_.cancel != nullptr && settings_.cancel->requested(); }
    // Anything that ends the current run of the render, with the lock held.
    bool is_interrupted() const {
        return paused_ || stopped_ || quit_ || new_target_ || new_change_ || is_cancelled();
    }
    // Makes a request, and interrupts the render for it.
    template <typename F>
    void request(const F& f);

    ViewedRenderSettings settings_;
    CancelFlag cancel_; // of the current run

    mutable std::mutex mutex_; // of the members below
    std::condition_variable changed_;
    ViewStatus status_;
    std::shared_ptr<LivePicture> picture_;
    std::optional<RenderSnapshot> still_; // while no samples are taken
    bool paused_ = false, stopped_ = false, quit_ = false;
    std::optional<RenderTarget> new_target_{};
    std::optional<ViewChange> new_change_{};

    // Held shared by those who use the session, and alone while it is exchanged or its target changes.
    std::shared_mutex session_mutex_;
    RenderSession* session_ = nullptr;
};

} // namespace montelux
