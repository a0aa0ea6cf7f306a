// A worker of a Metropolis render: one rank that takes the groups of chains which the leader assigns.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"
#include "montelux/cluster/rank_worker.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/render/metropolis/chain_renderer.h"

namespace montelux {

class ChainWorker final : public RankWorker {
  public:
    // Everything must outlive it. Tells the leader, rank 0, that it is ready.
    ChainWorker(ChainRenderer& chains, int threads, Mailbox& mailbox);
    // Gives up the groups that are being taken.
    ~ChainWorker() override;
    ChainWorker(const ChainWorker&) = delete;
    ChainWorker& operator=(const ChainWorker&) = delete;

    void handle(const Message& message) override;
    // Rethrows what taking groups threw.
    void report() override;
    void wait(std::chrono::microseconds longest) override;
    bool ended() const override { return ended_; }

  private:
    struct Result {
        ChainReplicate replicate;
        ChainCosts costs;
    };

    void run_thread();
    void forget_groups();
    void send(const Result& result);

    ChainRenderer& chains_;
    int threads_;
    Mailbox& mailbox_;
    bool ended_ = false;
    std::chrono::steady_clock::time_point last_sent_;

    std::mutex mutex_; // of what follows
    std::condition_variable groups_there_, results_there_;
    std::deque<protocol::Groups> groups_;
    std::deque<Result> results_;
    std::exception_ptr failure_;
    bool closing_ = false;

    std::atomic<std::uint64_t> paths_{0}; // of the groups that are being taken
    CancelFlag stop_;                     // they are given up
    std::thread thread_;
};

} // namespace montelux
