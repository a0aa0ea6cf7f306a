// An integrand whose batches of points are evaluated by all ranks of a job.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/mailbox.h"
#include "montelux/mc/integrate/points.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// Evaluates a batch: a pure function, called by several threads, the same on every rank.
using BatchFunction = std::function<void(const PointBatch&, ValueBatch)>;

// The side of rank 0, which runs the estimator. Every rank computes the same values of a batch, so the result
// is that of one process, for any integrand and method. Points and values are sent (8 bytes per coordinate
// and component), which pays if an evaluation takes much longer than a microsecond.
class SharedIntegrand {
  public:
    // Waits for all ranks. `threads`: number of batches that this rank evaluates at a time.
    SharedIntegrand(Mailbox& mailbox, BatchFunction f, int components, int threads,
                    double patience_seconds = 60);
    ~SharedIntegrand();
    SharedIntegrand(const SharedIntegrand&) = delete;
    SharedIntegrand& operator=(const SharedIntegrand&) = delete;

    // Number of threads that should evaluate at a time, including those that wait for a batch elsewhere.
    int threads() const { return callers_; }
    // Callable from any thread of `work`. Throws Error if a rank throws, or is silent for too long.
    void operator()(const PointBatch& x, ValueBatch y);
    // Runs work() in a thread of its own and serves its evaluations until it ends; rethrows its exceptions.
    // on_wish() is called when another rank received a request to end.
    void lead(const std::function<void()>& work, const std::function<void()>& on_wish = {});
    // A rank that does not answer, if there is one.
    bool failed() const { return failure_.has_value(); }

  private:
    using Clock = std::chrono::steady_clock;
    struct Request {
        const PointBatch* x = nullptr;
        ValueBatch y{nullptr, 0, 0, 0};
        int rank = 0;
        bool done = false;
        std::string error;
    };
    struct Rank {
        int threads = 0;
        int in_hand = 0;
        Clock::time_point last_heard;
    };

    bool listen(const std::function<void()>& on_wish);
    bool send_requests();
    void check_silence();
    void say_alive();
    void take_values(const Message& message);
    void fail(const std::string& why);

    Mailbox& mailbox_;
    BatchFunction f_;
    int components_, callers_ = 0;
    double patience_seconds_;
    std::vector<Rank> ranks_;
    Clock::time_point last_said_;

    std::mutex mutex_; // of what follows
    std::condition_variable answered_, asked_;
    int free_here_;
    std::uint64_t next_ = 0;
    std::deque<std::uint64_t> unsent_;
    std::map<std::uint64_t, Request*> open_;
    std::optional<std::string> failure_;
};

// The side of the other ranks, until rank 0 ends it. A `cancel` requested here is passed on. Throws Error
// when rank 0 is silent for this long.
void serve_integrand(Mailbox& mailbox, const BatchFunction& f, int components, int threads,
                     const CancelFlag* cancel, double patience_seconds);

} // namespace montelux
