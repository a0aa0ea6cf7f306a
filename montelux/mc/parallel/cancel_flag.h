// CancelFlag: asks a loop, a run or a render to stop.
#pragma once

#include <atomic>

namespace montelux {

// Asked between iterations; may be requested from any thread or from a signal handler.
class CancelFlag {
  public:
    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    void reset() noexcept { requested_.store(false, std::memory_order_relaxed); }
    bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> requested_{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
};

} // namespace montelux
