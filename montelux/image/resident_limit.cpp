#include "montelux/image/resident_limit.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <iterator>
#include <string>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t stretch = std::size_t{1} << 20; // given back at once
// Bytes per second that become resident where a thread only hashes them; measured: 23e9.
constexpr double fastest_reading = 3e10;
constexpr double forgetting = 0.98; // per look
constexpr double shortest_wait = 0.001, longest_wait = 0.01, seconds_between_counts = 1;

std::size_t page_size() {
    static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return size;
}

// Resident memory of the process that belongs to files, from /proc/self/statm; some hundred pages off. Includes
// libraries.
std::size_t file_bytes_of_process(int statm) {
    std::array<char, 256> text{};
    if (pread(statm, text.data(), text.size() - 1, 0) <= 0) return 0;
    char* at = text.data();
    std::strtoull(at, &at, 10); // all, and the resident memory
    std::strtoull(at, &at, 10);
    return static_cast<std::size_t>(std::strtoull(at, &at, 10)) * page_size();
}

// From /proc/self/pagemap, which has 8 bytes per page; the highest bit says that it is resident.
std::size_t resident_of(int pagemap, std::uintptr_t address, std::size_t size) {
    std::array<std::uint64_t, 4096> entries;
    std::size_t page = address / page_size(), count = 0, left = (size + page_size() - 1) / page_size();
    while (left > 0) {
        const std::size_t n = std::min(left, entries.size());
        const ssize_t read = pread(pagemap, entries.data(), n * 8, static_cast<off_t>(page * 8));
        if (read <= 0) break;
        const std::size_t got = static_cast<std::size_t>(read) / 8;
        for (std::size_t i = 0; i < got; ++i) count += entries[i] >> 63;
        page += n;
        left -= n;
    }
    return count * page_size();
}

std::uintptr_t address_of(std::span<const std::byte> mapping) {
    return reinterpret_cast<std::uintptr_t>(mapping.data());
}

} // namespace

ResidentLimit::ResidentLimit(std::size_t bytes) : limit_(bytes) {
    statm_ = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    pagemap_ = ::open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC);
    const auto fail = [&](const std::string& why) {
        ::close(statm_);
        ::close(pagemap_);
        throw Error("memory of textures", why);
    };
    if (statm_ < 0 || pagemap_ < 0) fail("a limit needs Linux with /proc; leave it out");
    // Signals go to the threads that expect them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::string error;
    try {
        thread_ = std::thread([this] { watch(); });
    } catch (const std::system_error& e) {
        error = e.code().message();
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (!error.empty()) fail("the thread that keeps the limit cannot be started: " + error);
}

ResidentLimit::~ResidentLimit() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
    ::close(statm_);
    ::close(pagemap_);
}

void ResidentLimit::add(std::span<const std::byte> mapping) {
    const std::lock_guard lock(mutex_);
    mappings_.emplace(address_of(mapping), mapping.size());
    if (mappings_.size() == 1) changed_.notify_all();
}

void ResidentLimit::remove(std::span<const std::byte> mapping) {
    const std::lock_guard lock(mutex_);
    mappings_.erase(address_of(mapping));
}

std::size_t ResidentLimit::resident() const {
    const std::lock_guard lock(mutex_);
    return resident_locked();
}

std::size_t ResidentLimit::resident_locked() const {
    std::size_t sum = 0;
    for (const auto& [address, size] : mappings_) sum += resident_of(pagemap_, address, size);
    return sum;
}

std::size_t ResidentLimit::give_back(std::size_t bytes) {
    std::size_t given = 0;
    for (int ends = 0; given < bytes && ends < 2;) {
        // The mapping of the hand, or the next one.
        auto mapping = mappings_.upper_bound(hand_);
        if (mapping != mappings_.begin())
            if (const auto before = std::prev(mapping); hand_ < before->first + before->second)
                mapping = before;
        if (mapping == mappings_.end()) {
            hand_ = 0;
            ++ends;
            continue;
        }
        hand_ = std::max(hand_, mapping->first);
        const std::size_t size = std::min(stretch, mapping->first + mapping->second - hand_);
        if (const std::size_t resident = resident_of(pagemap_, hand_, size); resident > 0) {
            madvise(reinterpret_cast<void*>(hand_), size, MADV_DONTNEED); // NOLINT(performance-no-int-to-ptr)
            given += resident;
        }
        hand_ += size;
    }
    return given;
}

void ResidentLimit::watch() {
    std::size_t others = 0; // libraries and other files
    Clock::time_point counted{}, last = Clock::now();
    double wait = 0, left = 0;     // of the last look: until this one, and what was resident after it
    double rate = 0, lateness = 0; // the largest of the last looks: bytes per second, and seconds
    const auto limit = static_cast<double>(limit_);
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (mappings_.empty()) {
            changed_.wait(lock);
            last = Clock::now();
            wait = 0;
            continue;
        }
        const std::size_t of_process = file_bytes_of_process(statm_);
        double resident = static_cast<double>(of_process > others ? of_process - others : 0);
        const auto now = Clock::now();
        if (resident > limit / 2 && now - counted > std::chrono::duration<double>(seconds_between_counts)) {
            const std::size_t exact = resident_locked();
            others = of_process > exact ? of_process - exact : 0;
            resident = static_cast<double>(exact);
            counted = now;
        } else {
            const double seconds = std::chrono::duration<double>(now - last).count();
            rate = std::max(forgetting * rate, (resident - left) / std::max(seconds, shortest_wait));
            lateness = std::max(forgetting * lateness, seconds - wait);
        }
        // Room for what becomes resident until the next look.
        const double high = limit - std::clamp(rate * (shortest_wait + lateness), limit / 8, limit * 3 / 4);
        left = resident;
        if (resident > high)
            left -= static_cast<double>(give_back(static_cast<std::size_t>(resident - high + limit / 8)));
        wait = std::clamp((high - left) / fastest_reading, shortest_wait, longest_wait);
        last = now;
        changed_.wait_for(lock, std::chrono::duration<double>(wait));
    }
}

} // namespace montelux
