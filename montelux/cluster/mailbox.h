// Messages between the ranks of a job.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace montelux {

// The rank that decides, prints and writes.
inline constexpr int leading_rank = 0;

struct Message {
    int source = 0;
    int tag = 0;
    std::vector<std::uint8_t> bytes;
};

// One rank's end. Used by one thread.
class Mailbox {
  public:
    virtual ~Mailbox() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    // Does not wait. Messages from one rank to another, or to itself, arrive in the order of sending.
    virtual void send(int to, int tag, std::vector<std::uint8_t> bytes) = 0;
    // The next message, if one is there.
    virtual std::optional<Message> receive() = 0;
};

} // namespace montelux
