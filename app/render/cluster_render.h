// A render that the ranks of an MPI job share: rank 0 reads, decides, speaks and writes; the others help.
#pragma once

#include "app/render/render_options.h"
#include <memory>

#include "montelux/cluster/communicator.h"
#include "montelux/cluster/coordinator.h"
#include "montelux/formats/file_source.h"

namespace montelux::app {

// The side of rank 0. Whatever happens to the render, the others learn that they are not needed any more.
class SharedRender {
  public:
    // `job` may be null: then everything happens in this process.
    SharedRender(Communicator* job, int threads, double patience_seconds)
        : job_(job), threads_(threads), patience_seconds_(patience_seconds) {}
    ~SharedRender();
    SharedRender(const SharedRender&) = delete;
    SharedRender& operator=(const SharedRender&) = delete;

    // What the scene is to be read by; null: the disk.
    FileSource* files() { return job_ != nullptr ? &files_ : nullptr; }
    // Sends scene and settings to the others, which begin to prepare them, and returns who leads; null where
    // the process is alone.
    RoundExecutor* begin(const SceneDescription& description, const SamplerSettings& sampler,
                         const RenderTarget& target);
    // The render is over; files may be written yet. Prints what the ranks missed.
    void end();
    void print_statistics() const;
    // Does nothing where all ranks are well. Throws Error for a rank that failed; where ranks do not answer,
    // so that they cannot be waited for, prints what there is to tell and ends the job.
    void end_job_if_failed(int exit_code) const;

  private:
    Communicator* job_;
    int threads_;
    double patience_seconds_; // with ranks that say nothing
    RecordedFiles files_;
    bool told_ = false; // the others know whether there is something to do
    std::unique_ptr<Coordinator> coordinator_;
};

// The side of the other ranks, from the beginning to the end of the render. What goes wrong ends the job.
void help_rendering(Communicator& job, const RenderOptions& options, int threads);

} // namespace montelux::app
