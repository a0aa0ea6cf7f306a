// RankWorker: the part of a rank that takes samples for the leader, in threads of its own.
#pragma once

#include <chrono>
#include <cstddef>

#include "montelux/cluster/mailbox.h"

namespace montelux {

// The thread that owns the mailbox calls these functions.
class RankWorker {
  public:
    virtual ~RankWorker() = default;
    // Handles a message to a worker. Throws Error for an invalid one.
    virtual void handle(const Message& message) = 0;
    // Sends the waiting results to the leader.
    virtual void report() = 0;
    // Returns when there is something to report, and after this time.
    virtual void wait(std::chrono::microseconds longest) = 0;
    virtual bool ended() const = 0;
};

// Bytes of pixels in one message, which bounds memory at both ends.
inline constexpr std::size_t message_bytes = std::size_t{8} << 20;
// A worker that has nothing to say says that it is alive.
inline constexpr std::chrono::seconds beat_interval{1};
// Polls less often while nothing happens, to leave the processor to rendering threads.
inline constexpr std::chrono::microseconds shortest_poll{50}, longest_poll{1000};

} // namespace montelux
