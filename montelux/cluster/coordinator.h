// The leader of a render: deals tiles out to all ranks, including its own, and gathers the film.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"
#include "montelux/cluster/tile_schedule.h"
#include "montelux/cluster/tile_worker.h"
#include "montelux/render/round_executor.h"

namespace montelux {

struct CoordinatorSettings {
    int tile_size = 16;
    int threads = 1; // of this rank
    // A rank that is silent for this long is given up, and the render ends with the work of the others.
    double patience_seconds = 60;
    // Wait for the ranks after the render was cancelled; short, since launchers kill soon after a signal.
    double patience_when_cancelled = 0.6;
};

// Tiles stay with the rank that rendered them last. Their pixels come to the leader at the end of a round, at
// a checkpoint, and when a rank without work gets a tile of another one.
class Coordinator final : public RoundExecutor {
  public:
    // `mailbox` is that of rank 0. on_wish() is called when another rank received a request to end; it may be
    // empty.
    Coordinator(Mailbox& mailbox, const PixelBounds& crop, const CoordinatorSettings& settings,
                std::function<void()> on_wish = {});
    ~Coordinator() override;

    void run(const TileRenderer& renderer, RenderState& state, const RoundWatch& watch) override;
    bool failed() const override { return failure_.has_value(); }
    // Why the render ended early; a sentence.
    const std::optional<std::string>& failure() const { return failure_; }
    // Ranks whose work since the last gathering is missing, because they did not answer in time.
    const std::vector<int>& left_out() const { return left_out_; }
    // Is there a rank that does not answer?
    bool someone_hangs() const { return someone_is_silent_ || !left_out_.empty(); }
    // Tells the workers that the render is over. The renderer of run() is not needed any more.
    void end();

    // Bytes sent to and received from all ranks so far, by the leader; tiles that changed ranks.
    struct Traffic {
        std::uint64_t messages = 0, bytes_out = 0, bytes_in = 0, moved_tiles = 0;
    };
    const Traffic& traffic() const { return traffic_; }
    // Of all ranks that were ready in time.
    int threads() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Rank {
        int threads = 0; // 0 until its hello
        bool gathering = false, lost = false;
        Clock::time_point last_heard;
    };
    struct Tile {
        double seconds_per_sample = 0;         // CPU time; 0 where it is not known
        int holder = TileSchedule::no_rank;    // rank with its newest pixels, unless only the film has them
        int wanted_by = TileSchedule::no_rank; // rank for which they are being fetched
        bool home = true;                      // the film has its newest pixels
        bool goals_known = false;              // to its holder, those of this round
        double luminance = 0, squared_error = 0;
        bool summed = false; // those two are known
    };

    void begin_round();
    // Gives every rank enough tasks to keep its threads busy.
    void deal();
    void assign(int rank, int tile, std::vector<std::uint8_t>& message);
    // Handles waiting messages; true if there were any.
    bool listen();
    void handle(const Message& message);
    void take_report(const protocol::TaskReport& report);
    void take_tiles(const Message& message);
    void gather();
    void check_silence();
    void give_up(int rank, const std::string& why);
    void send(int rank, protocol::Tag tag, std::vector<std::uint8_t> bytes);
    void report_progress();
    double work_of(int tile, std::uint64_t samples) const;
    std::uint32_t step_of(int tile) const;

    Mailbox& mailbox_;
    CoordinatorSettings settings_;
    std::function<void()> on_wish_;
    std::vector<PixelBounds> bounds_;
    std::vector<Tile> tiles_;
    std::vector<Rank> ranks_;
    TileSchedule schedule_;
    std::unique_ptr<TileWorker> worker_; // of this rank
    Traffic traffic_;
    std::optional<std::string> failure_;
    std::vector<int> left_out_;
    bool someone_is_silent_ = false, ended_ = false;

    // Of the present round.
    RenderState* state_ = nullptr;
    const RoundWatch* watch_ = nullptr;
    std::optional<std::uint32_t> uniform_target_;
    std::uint64_t samples_ = 0; // reported already and not in the report
    bool something_done_ = false;
    double known_seconds_ = 0; // sum over tiles whose cost is known, and their number
    int known_costs_ = 0;
    Clock::time_point last_report_, paused_; // no message was received since
};

} // namespace montelux
