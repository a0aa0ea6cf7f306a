// The guide of a render on its way from the leader to the other ranks, piece by piece.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "montelux/cluster/mailbox.h"
#include "montelux/cluster/rank_roster.h"
#include "montelux/transport/guiding/guiding_field.h"

namespace montelux {

// The leader's end. A rank gets the next piece when it has taken the one before: the copies that are on their way stay
// small, however many ranks there are.
class GuideSender {
  public:
    // Must outlive it.
    explicit GuideSender(RankRoster& roster);

    // Sends another guide than before to all ranks; null: they forget theirs. They must not take samples meanwhile.
    void set(const std::shared_ptr<const GuidingField>& guide);
    // Messages from a rank: its hello, and that it has taken a piece.
    void greet(int rank);
    void piece_taken(const Message& message);
    // Whether the rank has the present guide.
    bool is_known_to(int rank) const { return !ranks_[static_cast<std::size_t>(rank)].waits; }

  private:
    struct Rank {
        bool waits = false;
        std::uint64_t sent = 0; // bytes
    };
    void send_piece(int rank);

    RankRoster& roster_;
    std::shared_ptr<const GuidingField> guide_;
    std::vector<std::uint8_t> bytes_; // of the guide
    std::vector<Rank> ranks_;
};

// The end of another rank.
class GuideReceiver {
  public:
    // Takes a piece, says so to the leader, and calls `use` with the whole guide, which may be null. Throws Error for
    // what GuideSender did not send.
    void take(const Message& piece, Mailbox& mailbox,
              const std::function<void(std::shared_ptr<const GuidingField>)>& use);

  private:
    std::vector<std::uint8_t> bytes_;
};

} // namespace montelux
