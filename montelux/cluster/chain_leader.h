// The leader of a Metropolis render: deals groups of chains out to all ranks, and adds them to the film in order.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "montelux/cluster/chain_worker.h"
#include "montelux/cluster/rank_roster.h"

namespace montelux {

// A rank takes whole groups, each a pure function of its number. Those that are finished before their turn wait here:
// fewer than twice as many as the ranks take at once. Ranks work on while the leader writes checkpoints, and beyond the end of a round.
class ChainLeader {
  public:
    // With so many threads on this rank. The roster must outlive it.
    ChainLeader(RankRoster& roster, int threads);

    // As RoundExecutor::run.
    void run(ChainRenderer& chains, RenderState& state, std::uint32_t target_samples,
             const ChainWatch& watch);
    // Gives up the groups that are not added yet.
    void release();

  private:
    struct Rank {
        std::size_t in_hand = 0; // groups
        std::uint64_t paths = 0; // of them, taken
        ChainReplicate arriving;
    };
    struct Finished {
        ChainReplicate replicate;
        ChainCosts costs;
    };

    void deal(std::uint64_t done, std::uint64_t most);
    bool listen();
    void handle(const Message& message);
    std::uint64_t paths_beyond() const;

    RankRoster& roster_;
    int threads_;
    std::unique_ptr<ChainWorker> worker_; // of this rank
    std::vector<Rank> ranks_;
    std::map<std::uint64_t, Finished> finished_; // by number
    std::uint64_t next_ = 0;                     // group to deal out
    std::size_t pixels_ = 0;
    std::uint64_t paths_per_group_ = 0;
};

} // namespace montelux
