// RankRoster: the ranks of a job as its leader sees them: which of them are ready, silent or lost.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/protocol.h"

namespace montelux {

// Used by the leader's one thread, as its mailbox is.
class RankRoster {
  public:
    // `mailbox` is that of the leader. A rank that is silent for this long is lost. on_wish() is called when another
    // rank received a request to end; it may be empty.
    RankRoster(Mailbox& mailbox, double patience_seconds, std::function<void()> on_wish);

    Mailbox& mailbox() { return mailbox_; }
    int size() const { return mailbox_.size(); }
    bool is_leader(int rank) const { return rank == mailbox_.rank(); }
    // 0 until its hello.
    int threads(int rank) const { return ranks_[index(rank)].threads; }
    int threads() const;
    bool takes_part(int rank) const { return threads(rank) > 0 && !ranks_[index(rank)].lost; }

    void send(int rank, protocol::Tag tag, std::vector<std::uint8_t> bytes);
    // The next message, if one is there. Those about the rank itself (hello, beat, wish, failed) are dealt with already.
    std::optional<Message> receive();

    // Between these calls the leader listens. Silence at other times does not count: it writes checkpoints then.
    void begin_listening();
    void end_listening();
    // Call often while the leader listens: gives silent ranks up, and tells the others that the leader is alive.
    void watch();

    // Why the job must end early; a sentence.
    const std::optional<std::string>& failure() const { return failure_; }
    // Is there a rank that does not answer?
    bool someone_is_silent() const { return someone_is_silent_; }

    // Bytes sent to and received from other ranks so far.
    struct Traffic {
        std::uint64_t messages = 0, bytes_out = 0, bytes_in = 0;
    };
    const Traffic& traffic() const { return traffic_; }

  private:
    using Clock = std::chrono::steady_clock;
    struct Rank {
        int threads = 0;
        bool lost = false;
        Clock::time_point last_heard;
    };

    static std::size_t index(int rank) { return static_cast<std::size_t>(rank); }
    void note(const Message& message);
    void give_up(int rank, const std::string& why);

    Mailbox& mailbox_;
    double patience_seconds_;
    std::function<void()> on_wish_;
    std::vector<Rank> ranks_;
    Traffic traffic_;
    std::optional<std::string> failure_;
    bool someone_is_silent_ = false;
    std::optional<Clock::time_point> paused_; // no message was received since; empty: it has not listened yet
    Clock::time_point last_beat_;
};

} // namespace montelux
