// A render that goes on by itself, in a thread that never asks for Python's lock.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "montelux/denoise/denoise_image.h"
#include "montelux/image/image.h"
#include "montelux/render/renderer.h"

namespace montelux::python {

struct RenderJobSettings {
    RenderTarget target;
    int threads = 0; // 0: one a processor
    std::filesystem::path checkpoint;
    double checkpoint_every = 60;
    bool resume = false;
    std::string scene_name; // for the header of the picture
    bool denoise = false;
};

// What is known of a render at some moment.
struct RenderSnapshot {
    std::shared_ptr<const Image> image; // the layers of Film::develop() with the header of a render
    FilmError error;
    RenderReport report;
};

class RenderJob {
  public:
    // Builds what the scene needs and starts; throws Error where the settings make no sense. The description
    // must not change any more.
    RenderJob(std::shared_ptr<const SceneDescription> description, RenderJobSettings settings);
    ~RenderJob();
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    void cancel() { cancel_.request(); }
    // Waits until the render has ended, but so many seconds at most; whether it has.
    bool wait(double seconds);
    RenderProgress progress() const;
    // The render as it is now, waiting for a moment without open samples but so many seconds at most; none
    // where that did not do, or the render ended meanwhile.
    std::optional<RenderSnapshot> snapshot(double seconds);
    // After the end; rethrows what ended it.
    RenderSnapshot result() const;
    const SceneDescription& description() const { return *description_; }
    // Why the newest checkpoint was not gone on from but the one before; empty where it was.
    const std::string& refused_checkpoint() const { return refused_checkpoint_; }
    // Why the last checkpoint was not written; empty where it was.
    std::string checkpoint_failure() const;
    // Why the finished picture was not denoised though it should have been; after the end.
    const std::string& denoise_failure() const { return denoise_failure_; }

  private:
    void run();
    void take_snapshot(const RenderState& state);
    void save(const RenderState& state);
    std::shared_ptr<Image> developed(const Film& film, const RenderReport& report) const;
    void denoise(Image& image);

    std::shared_ptr<const SceneDescription> description_;
    RenderJobSettings settings_;
    std::unique_ptr<Renderer> renderer_;
    std::optional<Denoiser> denoiser_;
    std::optional<RenderState> state_;
    std::string refused_checkpoint_;
    std::uint32_t replicate_size_ = 1;
    CancelFlag cancel_;
    std::atomic<bool> snapshot_wanted_{false};

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool ended_ = false;
    std::exception_ptr failure_;
    std::string checkpoint_failure_, denoise_failure_;
    RenderProgress progress_;
    std::optional<Film> seen_; // what a snapshot is made of
    RenderReport seen_report_;
    std::optional<RenderSnapshot> result_;
    std::thread thread_;
};

} // namespace montelux::python
