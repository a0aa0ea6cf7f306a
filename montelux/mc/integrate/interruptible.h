// An integrand that can be stopped between points, however slow it is: by a flag or at a point in time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

// Thrown by the integrand after a request to stop. Not a std::exception, so that no handler of errors catches
// it.
struct IntegrandInterrupted {};

// Requests an integrand to stop, and counts its evaluations; outlives it.
class Interruption {
  public:
    using Clock = std::chrono::steady_clock;

    explicit Interruption(const CancelFlag* cancel) : cancel_(cancel) {}
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    // Not while the integrand is being evaluated.
    void set_deadline(Clock::time_point deadline) { deadline_ = deadline; }
    void clear_deadline() { deadline_ = Clock::time_point::max(); }

    bool cancelled() const { return cancel_ && cancel_->requested(); }
    bool late() const { return deadline_ != Clock::time_point::max() && Clock::now() >= deadline_; }
    std::uint64_t evaluations() const { return evaluations_.load(std::memory_order_relaxed); }

  private:
    friend Integrand interruptible(const Integrand& f, Interruption& interruption);
    void evaluate(const Integrand& f, const PointBatch& x, ValueBatch y);
    // Throws IntegrandInterrupted, or counts points that are evaluated next.
    void begin(std::size_t points);
    void evaluate_in_parallel(const Integrand& f, const PointBatch& x, ValueBatch y, std::size_t slice);
    void evaluate_slice(const Integrand& f, const PointBatch& x, ValueBatch y, std::size_t whole,
                        std::size_t slice);

    const CancelFlag* cancel_;
    Clock::time_point deadline_ = Clock::time_point::max();
    std::atomic<std::uint64_t> evaluations_{0};
    // Points that take about a fiftieth of a second; learned from what they took so far.
    std::atomic<std::size_t> slice_{8};
    std::atomic<double> point_seconds_{0}; // of the last slice that was timed
};

// f, called for slices of a batch that take about a fiftieth of a second each. Before each slice it checks
// for an interruption and throws IntegrandInterrupted. Slices are multiples of eight points if eight fit into
// that time, so that vectorised functions get no extra remainders. If a point takes more than 20
// microseconds, the slices of a batch are evaluated in parallel and are short enough for each thread to get
// some; otherwise a large batch would keep only one thread busy.
Integrand interruptible(const Integrand& f, Interruption& interruption);

} // namespace montelux
