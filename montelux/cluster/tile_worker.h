// A worker of a render: threads of one rank that render the tiles which the leader assigns.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "montelux/cluster/guide_exchange.h"
#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"
#include "montelux/cluster/rank_worker.h"
#include "montelux/film/splat_film.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/merging_bias.h"
#include "montelux/render/merging_passes.h"
#include "montelux/render/sample_context.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {

// All but the rendering happens in the thread that owns the mailbox.
//
// Splats of light paths are summed over all tiles of the worker, since those of a single one may reach the whole film.
// They are sent with the pixels of all these tiles, and the leader takes both or neither.
//
// Where paths merge, each rank traces all light paths of a pass.
class TileWorker final : public RankWorker {
  public:
    // Guide and light maps of ranks other than the leader's, which has them from the render loop.
    struct OwnPreparation {
        SampleContext& context;           // the renderer's; gets the guide that the leader sends
        MergingPasses* merging = nullptr; // where paths merge: the light maps of their passes
    };
    // Everything must outlive it. Tells the leader, rank 0, that it is ready. `own`: of all ranks but the leader's.
    TileWorker(const TileRenderer& renderer, std::vector<PixelBounds> tiles, int threads, Mailbox& mailbox,
               std::optional<OwnPreparation> own = {});
    ~TileWorker() override;
    TileWorker(const TileWorker&) = delete;
    TileWorker& operator=(const TileWorker&) = delete;

    void handle(const Message& message) override;
    void report() override;
    void wait(std::chrono::microseconds longest) override;
    bool ended() const override { return ended_; }

  private:
    struct Tile {
        std::vector<Pixel> pixels;
        std::vector<double> layer_sums;     // FilmLayers::sums() for each
        std::vector<BucketMoments> buckets; // of a spectral film
        std::vector<std::uint32_t> target_samples;
        TileTally tally; // since the pixels were last sent
        bool changed = false;
    };
    struct Task {
        std::uint32_t tile = 0, step = 0;
    };

    void run_thread();
    protocol::TaskReport perform(const Task& task);
    void assign(const Message& message);
    void take_guide(const Message& message);
    void send_tiles(std::span<const std::uint32_t> which);
    void finish_gathering();
    void send_splats();
    void send_bias();
    void prepare_pass(Tile& tile);
    Tile& known(std::uint32_t tile);

    const TileRenderer& renderer_;
    std::vector<PixelBounds> bounds_;
    Mailbox& mailbox_;
    std::optional<OwnPreparation> own_;
    GuideReceiver guide_;
    std::vector<std::unique_ptr<Tile>> tiles_; // those that are held
    std::optional<SplatFilm> splats_;          // of all samples since the last gathering, if they bring any
    std::optional<MergingBias> bias_;          // the same, where paths merge
    std::mutex pass_mutex_;                    // of the preparation of a pass
    std::uint32_t gathering_number_ = 0;
    bool gathering_ = false, ended_ = false;
    std::chrono::steady_clock::time_point last_sent_;

    std::mutex mutex_; // of what follows
    std::condition_variable tasks_there_, reports_there_;
    std::deque<Task> tasks_;
    std::vector<protocol::TaskReport> reports_;
    int busy_ = 0;
    std::exception_ptr failure_; // of a task
    bool closing_ = false;

    CancelFlag stop_; // tasks end as soon as they can
    std::vector<std::thread> threads_;
};

} // namespace montelux
