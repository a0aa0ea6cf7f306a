// A render shared by the ranks of an MPI job: rank 0 reads, decides, prints and writes; the others help.
#pragma once

#include "app/render/render_options.h"
#include <memory>

#include "montelux/cluster/communicator.h"
#include "montelux/cluster/coordinator.h"
#include "montelux/formats/file_source.h"

namespace montelux::app {

// Rank 0. However the render ends, the other ranks are released.
class SharedRender {
  public:
    // `job` may be null: then everything runs in this process.
    SharedRender(Communicator* job, int threads, double patience_seconds)
        : job_(job), threads_(threads), patience_seconds_(patience_seconds) {}
    ~SharedRender();
    SharedRender(const SharedRender&) = delete;
    SharedRender& operator=(const SharedRender&) = delete;

    // Whether there are other ranks.
    bool is_job() const { return job_ != nullptr; }
    // The source of the scene's files; null: the disk.
    FileSource* files() { return job_ != nullptr ? &files_ : nullptr; }
    // Sends scene and settings to the others, which start to prepare them; returns the leader, or null if the
    // process is alone.
    RoundExecutor* begin(const SceneDescription& description, const SamplerSettings& sampler,
                         const RenderTarget& target);
    // Call when the render has ended; files may still be written. Prints what the ranks missed.
    void end();
    void print_statistics() const;
    // No effect if all ranks are well. Throws Error for a failed rank; if ranks do not answer, and so cannot
    // be waited for, prints the reason and ends the job.
    void end_job_if_failed(int exit_code) const;

  private:
    Communicator* job_;
    int threads_;
    double patience_seconds_; // timeout for silent ranks
    RecordedFiles files_;
    bool started_ = false; // scene and settings were sent
    std::unique_ptr<Coordinator> coordinator_;
};

// The other ranks, from the start to the end of the render. Any failure ends the job.
void help_rendering(Communicator& job, const RenderOptions& options, int threads);

} // namespace montelux::app
