// A worker of a render: threads of one rank that render the tiles which the leader assigns.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/tile_renderer.h"

namespace montelux {

// All but the rendering happens in the thread that owns the mailbox, which calls these functions.
class TileWorker {
  public:
    // Everything must outlive it. Tells the leader, rank 0, that it is ready.
    TileWorker(const TileRenderer& renderer, std::vector<PixelBounds> tiles, int threads, Mailbox& mailbox);
    ~TileWorker();
    TileWorker(const TileWorker&) = delete;
    TileWorker& operator=(const TileWorker&) = delete;

    // Handles a message to a worker. Throws Error for an invalid one.
    void handle(const Message& message);
    // Sends the waiting reports to the leader.
    void report();
    // Returns when there is something to report, and after this time.
    void wait(std::chrono::microseconds longest);
    bool ended() const { return ended_; }

  private:
    struct Tile {
        std::vector<Pixel> pixels;
        std::vector<double> layer_sums; // FilmLayers::sums() for each
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
    void send_tiles(std::span<const std::uint32_t> which);
    void finish_gathering();
    Tile& known(std::uint32_t tile);

    const TileRenderer& renderer_;
    std::vector<PixelBounds> bounds_;
    Mailbox& mailbox_;
    std::vector<std::unique_ptr<Tile>> tiles_; // those that are held
    bool gathering_ = false, ended_ = false;
    std::chrono::steady_clock::time_point last_sent_;

    std::mutex mutex_; // of what follows
    std::condition_variable tasks_there_, reports_there_;
    std::deque<Task> tasks_;
    std::vector<protocol::TaskReport> reports_;
    int busy_ = 0;
    bool closing_ = false;

    CancelFlag stop_; // tasks end as soon as they can
    std::vector<std::thread> threads_;
};

// The leader has been silent for too long.
struct LeaderIsSilent : Error {
    using Error::Error;
};

// The phases of a worker rank. Calls prepare() in a thread of its own, and meanwhile reports to the leader
// that this rank is alive: a large scene may take longer to build than the leader waits for silent ranks.
// Rethrows its exceptions.
void prepare_and_beat(Mailbox& mailbox, const std::function<void()>& prepare);
// Serves until the leader ends the render. A `cancel` requested here is passed on to the leader. Throws
// LeaderIsSilent when the leader is silent for `patience`.
void serve_tiles(const TileRenderer& renderer, const PixelBounds& crop, int tile_size, int threads,
                 Mailbox& mailbox, const CancelFlag* cancel, double patience_seconds);
// Instead of that, or after it has thrown: reports to the leader why this rank cannot continue, and waits for
// the end of the render. So only the leader prints errors, whether all ranks meet them or a single one.
// Throws LeaderIsSilent.
void serve_failure(const std::string& why, Mailbox& mailbox, double patience_seconds);

} // namespace montelux
