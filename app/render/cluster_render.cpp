#include "app/render/cluster_render.h"

#include "app/cluster_job.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/cluster/serve.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/renderer.h"
#include "montelux/scene/scene_digest.h"

namespace montelux::app {
namespace {

// The leader's message to the others at the start, beside the files of the scene.
struct Opening {
    SceneDigest scene;
    SamplerSettings sampler;
    std::int32_t tile_size = 0;
    IntegratorKind integrator = IntegratorKind::path; // the chosen one, if rank 0 chose
};

// Large tiles need the fewest messages; small ones keep many threads busy to the end of a round.
int tile_size_for(const PixelBounds& crop, double threads) {
    constexpr double tiles_a_thread = 8;
    int size = 16;
    const double pixels = static_cast<double>(crop.width()) * crop.height();
    while (size > 2 && pixels / (size * size) < tiles_a_thread * threads) size /= 2;
    return size;
}

constexpr const char* no_memory = "there is not enough memory";

// Everything that a rank builds for the render. The renderer refers to the description.
struct Prepared {
    Opening opening;
    SceneDescription description;
    std::optional<Renderer> renderer;

    Prepared(std::vector<std::uint8_t> bytes, const RenderOptions& options) {
        ByteReader in(bytes);
        opening = in.get<Opening>();
        const auto target = in.get<RenderTarget>();
        {
            BundledFiles files(FileBundle::from_bytes(in.get_bytes()));
            bytes = std::vector<std::uint8_t>(); // {} would keep the memory
            Warnings ignored;
            description = load_requested(options, ignored, &files).description;
        }
        if (digest_of(description.scene) != opening.scene)
            throw Error("the scene", "this rank has read another one than rank 0");
        description.sampler = opening.sampler;
        description.integrator.method = opening.integrator;
        renderer.emplace(description, target);
    }
};

void help_with(std::vector<std::uint8_t> bytes, Communicator& job, const RenderOptions& options,
               int threads) {
    const CancelFlag& cancel = follow_on_signals();
    std::unique_ptr<Prepared> prepared;
    prepare_and_beat(job, [&] {
        with_threads(threads, [&] { prepared = std::make_unique<Prepared>(std::move(bytes), options); });
    });
    serve_render(*prepared->renderer, job,
                 {.tile_size = prepared->opening.tile_size,
                  .threads = threads,
                  .cancel = &cancel,
                  .patience_seconds = patience_with_leader});
}

} // namespace

SharedRender::~SharedRender() {
    if (job_ == nullptr || started_) return;
    std::vector<std::uint8_t> nothing_to_do;
    try {
        job_->broadcast(nothing_to_do, patience_seconds_);
    } catch (const Error&) { // already reported; leave_job() ends the others
    }
}

RoundExecutor* SharedRender::begin(const SceneDescription& description, const SamplerSettings& sampler,
                                   const RenderTarget& target) {
    if (job_ == nullptr) return nullptr;
    CoordinatorSettings settings;
    settings.threads = threads_;
    settings.tile_size = tile_size_for(description.film.crop, static_cast<double>(threads_) * job_->size());
    settings.patience_seconds = patience_seconds_;
    ByteWriter out;
    out.put(
        Opening{digest_of(description.scene), sampler, settings.tile_size, description.integrator.method});
    out.put(target);
    out.put_bytes(files_.bundle().to_bytes());
    files_ = {};
    std::vector<std::uint8_t> bytes = out.take();
    started_ = true;
    job_->broadcast(bytes, patience_seconds_);
    coordinator_ = std::make_unique<Coordinator>(*job_, description.film.crop, settings, request_cancel);
    return coordinator_.get();
}

void SharedRender::end() {
    if (!coordinator_) return;
    coordinator_->end();
    for (int rank : coordinator_->left_out())
        std::fprintf(stderr,
                     "montelux: warning: rank %d did not answer in time; what it did since the last "
                     "checkpoint is missing\n",
                     rank);
}

void SharedRender::print_statistics() const {
    if (!coordinator_) return;
    const RankRoster::Traffic& t = coordinator_->traffic();
    constexpr double mib = 1 << 20;
    std::printf("ranks              %d, with %d threads in all\n", job_->size(), coordinator_->threads());
    std::printf("between ranks      %.1f MiB to rank 0, %.1f MiB from it in %llu messages; %llu tiles "
                "changed hands\n",
                static_cast<double>(t.bytes_in) / mib, static_cast<double>(t.bytes_out) / mib,
                static_cast<unsigned long long>(t.messages),
                static_cast<unsigned long long>(coordinator_->moved_tiles()));
}

void SharedRender::end_job_if_failed(int exit_code) const {
    if (!coordinator_) return;
    if (!coordinator_->someone_hangs()) {
        if (coordinator_->failed()) throw Error(*coordinator_->failure());
        return;
    }
    if (coordinator_->failed()) {
        std::fprintf(stderr, "montelux: error: %s\n", coordinator_->failure()->c_str());
        exit_code = exit_failed;
    }
    end_job(exit_code);
}

void help_rendering(Communicator& job, const RenderOptions& options, int threads) {
    const std::string this_rank = "rank " + std::to_string(job.rank());
    try {
        std::vector<std::uint8_t> bytes;
        job.broadcast(bytes, patience_with_leader);
        if (bytes.empty()) return;
        try {
            help_with(std::move(bytes), job, options, threads);
        } catch (const LeaderIsSilent&) {
            throw;
        } catch (const std::bad_alloc&) {
            serve_failure(no_memory, job, patience_with_leader);
        } catch (const std::exception& e) {
            serve_failure(e.what(), job, patience_with_leader);
        }
    } catch (const std::bad_alloc&) {
        print_rank_error(this_rank + ": " + no_memory);
        end_job(exit_failed);
    } catch (const std::exception& e) {
        print_rank_error(e.what());
        end_job(exit_failed);
    }
}

} // namespace montelux::app
