// The leader of a render: deals tiles out to all ranks, including its own, and gathers the film.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/chain_leader.h"
#include "montelux/cluster/guide_exchange.h"
#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"
#include "montelux/cluster/rank_roster.h"
#include "montelux/cluster/rank_worker.h"
#include "montelux/cluster/tile_schedule.h"
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
//
// If samples bring splats to other pixels, each tile is dealt out once in a round, for all its samples. At the end the
// pixels and the splats of a rank are taken together, when all of them are here, so a rank that is lost leaves no splats
// without their samples.
class Coordinator final : public RoundExecutor {
  public:
    // `mailbox` is that of rank 0. on_wish() is called when another rank received a request to end; it may be
    // empty.
    Coordinator(Mailbox& mailbox, const PixelBounds& crop, const CoordinatorSettings& settings,
                std::function<void()> on_wish = {});
    ~Coordinator() override;

    void run(const TileRenderer& renderer, RenderState& state, const RoundWatch& watch) override;
    void run(ChainRenderer& chains, RenderState& state, std::uint32_t target_samples,
             const ChainWatch& watch) override;
    void meanwhile(const std::function<void()>& work, const std::function<void()>& between) override;
    void release() override;
    bool failed() const override { return failure().has_value(); }
    // Why the render ended early; a sentence.
    const std::optional<std::string>& failure() const { return roster_.failure(); }
    // Ranks whose work since the last gathering is missing, because they did not answer in time.
    const std::vector<int>& left_out() const { return left_out_; }
    // Is there a rank that does not answer?
    bool someone_hangs() const { return roster_.someone_is_silent() || !left_out_.empty(); }
    // Tells the workers that the render is over.
    void end();

    const RankRoster::Traffic& traffic() const { return roster_.traffic(); }
    // Tiles that changed ranks.
    std::uint64_t moved_tiles() const { return moved_tiles_; }
    // Of all ranks that were ready in time.
    int threads() const { return roster_.threads(); }

  private:
    using Clock = std::chrono::steady_clock;
    struct Rank {
        bool gathering = false;
        std::vector<Message> staged{}; // of this gathering, if there are splats
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
    void take_splats(const Message& message);
    void take_staged(Rank& rank);
    void gather();
    bool is_gathering(int rank) const;
    void report_progress();
    double work_of(int tile, std::uint64_t samples) const;
    std::uint32_t step_of(int tile) const;

    CoordinatorSettings settings_;
    RankRoster roster_;
    std::vector<PixelBounds> bounds_;
    std::vector<Tile> tiles_;
    std::vector<Rank> ranks_;
    TileSchedule schedule_;
    std::unique_ptr<RankWorker> worker_; // of this rank
    ChainLeader chains_;                 // of a Metropolis render
    GuideSender guide_;
    std::uint64_t moved_tiles_ = 0;
    std::uint32_t gatherings_ = 0;
    std::vector<int> left_out_;
    bool ended_ = false;

    // Of the present round.
    RenderState* state_ = nullptr;
    const RoundWatch* watch_ = nullptr;
    std::optional<std::uint32_t> uniform_target_;
    std::uint64_t samples_ = 0; // reported already and not in the report
    bool something_done_ = false;
    double known_seconds_ = 0; // sum over tiles whose cost is known, and their number
    int known_costs_ = 0;
    Clock::time_point last_report_;
};

} // namespace montelux
