// ResidentLimit: keeps the resident part of mapped files below a number of bytes, by a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <sys/types.h>
#include <thread>

#include "montelux/image/process_memory.h"

namespace montelux {

// Mappings must be clean, read-only and shared: what is given back comes from the file again when it is next read,
// so that no reader waits for this class or sees a difference. The thread looks at the resident memory every 1 to
// 10 ms, more often the closer it is to the limit. It gives back pages, in the order of their addresses, where more
// than 7/8 of the limit is resident; at high rates of reading earlier, from 1/4 on, so that the limit is not reached
// before the next look. Readers that are faster than that exceed the limit for some milliseconds.
//
// The order of addresses stands for the order of use, which the kernel does not tell: each page of all mappings is given
// back once before any is given back again.
//
// Limits of the same process do not share what is resident: each one is kept for its own mappings alone. While there are
// several, their threads count the pages of all mappings at each look (about 10 ns per page), and look no more often than that
// takes a tenth of their time.
// A process that is forked off has no such thread: there the limit is not kept, and the object does nothing.
class ResidentLimit {
  public:
    // Throws Error where the system does not tell what is resident, or starts no thread.
    explicit ResidentLimit(std::size_t bytes);
    ~ResidentLimit();
    ResidentLimit(const ResidentLimit&) = delete;
    ResidentLimit& operator=(const ResidentLimit&) = delete;

    std::size_t bytes() const { return limit_; }
    void add(std::span<const std::byte> mapping);
    // Call before it is unmapped.
    void remove(std::span<const std::byte> mapping);
    // Bytes of all mappings that are resident. 0 in a process that is forked off.
    std::size_t resident() const;

  private:
    // What the thread shares with the callers.
    struct Shared {
        std::mutex mutex; // of what follows
        std::condition_variable changed;
        bool stop = false;
        std::map<std::uintptr_t, std::size_t> mappings; // their sizes by their addresses
        std::uintptr_t hand = 0;                        // what is given back next
        std::thread thread;
    };

    bool is_forked() const;
    void watch();
    std::size_t resident_locked() const;
    // Continues at the hand until that many resident bytes are given back, or none is left. Returns how many were.
    std::size_t give_back(std::size_t bytes);

    std::size_t limit_;
    pid_t process_;
    ProcessMemory memory_;
    std::unique_ptr<Shared> shared_;
};

} // namespace montelux
