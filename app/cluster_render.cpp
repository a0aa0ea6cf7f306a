#include "app/cluster_render.h"

#include "app/cluster_job.h"
#include "app/interrupt.h"
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "montelux/cluster/tile_worker.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"

namespace montelux::app {
namespace {

// What the leader tells the others in the beginning, beside the files of the scene.
struct Opening {
    std::uint64_t content_hash = 0;
    SamplerSettings sampler;
    std::int32_t tile_size = 0;
};

// Large tiles have the least to say; small ones keep many threads busy to the end of a round.
int tile_size_for(const PixelBounds& crop, double threads) {
    constexpr double tiles_a_thread = 8;
    int size = 16;
    const double pixels = static_cast<double>(crop.width()) * crop.height();
    while (size > 2 && pixels / (size * size) < tiles_a_thread * threads) size /= 2;
    return size;
}

} // namespace

SharedRender::~SharedRender() {
    if (job_ == nullptr || told_) return;
    std::vector<std::uint8_t> nothing_to_do;
    job_->broadcast(nothing_to_do);
}

RoundExecutor* SharedRender::begin(const SceneDescription& description, const RenderTarget& target,
                                   const RenderOptions& options) {
    if (job_ == nullptr) return nullptr;
    CoordinatorSettings settings;
    settings.threads = threads_;
    settings.tile_size = tile_size_for(description.film.crop, static_cast<double>(threads_) * job_->size());
    settings.patience_seconds = options.rank_timeout;
    ByteWriter out;
    out.put(Opening{description.content_hash, description.sampler, settings.tile_size});
    out.put(target);
    out.put_bytes(files_.bundle().to_bytes());
    files_ = {};
    std::vector<std::uint8_t> bytes = out.take();
    job_->broadcast(bytes);
    told_ = true;
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
    const Coordinator::Traffic& t = coordinator_->traffic();
    constexpr double mib = 1 << 20;
    std::printf("ranks              %d, with %d threads in all\n", job_->size(), coordinator_->threads());
    std::printf("between ranks      %.1f MiB to rank 0, %.1f MiB from it in %llu messages; %llu tiles "
                "changed hands\n",
                static_cast<double>(t.bytes_in) / mib, static_cast<double>(t.bytes_out) / mib,
                static_cast<unsigned long long>(t.messages), static_cast<unsigned long long>(t.moved_tiles));
}

void SharedRender::end_job_if_failed(int exit_code) const {
    if (!coordinator_ || (!coordinator_->failed() && coordinator_->left_out().empty())) return;
    if (coordinator_->failed()) {
        std::fprintf(stderr, "montelux: error: %s\n", coordinator_->failure()->c_str());
        exit_code = 1;
    }
    std::fflush(nullptr);
    job_->abort(exit_code);
}

void help_rendering(Communicator& job, const RenderOptions& options, int threads) {
    try {
        std::vector<std::uint8_t> bytes;
        job.broadcast(bytes);
        if (bytes.empty()) return;
        const CancelFlag& cancel = follow_on_signals();
        SceneDescription description;
        Opening opening;
        RenderTarget target;
        {
            ByteReader in(bytes);
            opening = in.get<Opening>();
            target = in.get<RenderTarget>();
            BundledFiles files(FileBundle::from_bytes(in.get_bytes()));
            bytes = {};
            Warnings ignored;
            description = load_pbrt(options.scene, ignored, nullptr, &files);
        }
        if (description.content_hash != opening.content_hash)
            throw Error("rank " + std::to_string(job.rank()), "has read another scene than rank 0");
        apply(options, description);
        description.sampler = opening.sampler;
        const Renderer renderer(description, target);
        renderer.serve([&](const TileRenderer& tiles) {
            serve_tiles(tiles, description.film.crop, opening.tile_size, threads, job, &cancel,
                        patience_with_leader);
        });
    } catch (const std::bad_alloc&) {
        speak_up("rank " + std::to_string(job.rank()) + ": there is not enough memory");
        job.abort(1);
    } catch (const std::exception& e) {
        speak_up(e.what());
        job.abort(1);
    }
}

} // namespace montelux::app
