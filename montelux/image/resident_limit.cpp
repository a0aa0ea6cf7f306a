#include "montelux/image/resident_limit.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
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
constexpr double waiting_per_counting = 9; // where every look counts

std::atomic<int> limits_of_process{0};

double seconds_between(Clock::time_point a, Clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

std::uintptr_t address_of(std::span<const std::byte> mapping) {
    return reinterpret_cast<std::uintptr_t>(mapping.data());
}

std::span<const std::byte> mapping_at(std::uintptr_t address, std::size_t size) {
    return {reinterpret_cast<const std::byte*>(address), size}; // NOLINT(performance-no-int-to-ptr)
}

} // namespace

ResidentLimit::ResidentLimit(std::size_t bytes)
    : limit_(bytes), process_(::getpid()), shared_(std::make_unique<Shared>()) {
    // Signals go to the threads that expect them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::string error;
    try {
        shared_->thread = std::thread([this] { watch(); });
    } catch (const std::system_error& e) {
        error = e.code().message();
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (!error.empty())
        throw Error("memory of textures", "the thread that keeps the limit cannot be started: " + error);
    ++limits_of_process;
}

bool ResidentLimit::is_forked() const { return ::getpid() != process_; }

ResidentLimit::~ResidentLimit() {
    --limits_of_process;
    if (is_forked()) {
        // The thread may have held the mutex, and seems to wait for the condition for ever.
        static_cast<void>(shared_.release());
        return;
    }
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->stop = true;
    }
    shared_->changed.notify_all();
    shared_->thread.join();
}

void ResidentLimit::add(std::span<const std::byte> mapping) {
    if (is_forked()) return;
    const std::lock_guard lock(shared_->mutex);
    shared_->mappings.emplace(address_of(mapping), mapping.size());
    if (shared_->mappings.size() == 1) shared_->changed.notify_all();
}

void ResidentLimit::remove(std::span<const std::byte> mapping) {
    if (is_forked()) return;
    const std::lock_guard lock(shared_->mutex);
    shared_->mappings.erase(address_of(mapping));
}

std::size_t ResidentLimit::resident() const {
    if (is_forked()) return 0;
    const std::lock_guard lock(shared_->mutex);
    return resident_locked();
}

std::size_t ResidentLimit::resident_locked() const {
    std::size_t sum = 0;
    for (const auto& [address, size] : shared_->mappings) sum += memory_.resident(mapping_at(address, size));
    return sum;
}

std::size_t ResidentLimit::give_back(std::size_t bytes) {
    std::size_t given = 0;
    for (int ends = 0; given < bytes && ends < 2;) {
        // The mapping of the hand, or the next one.
        auto mapping = shared_->mappings.upper_bound(shared_->hand);
        if (mapping != shared_->mappings.begin())
            if (const auto before = std::prev(mapping); shared_->hand < before->first + before->second)
                mapping = before;
        if (mapping == shared_->mappings.end()) {
            shared_->hand = 0;
            ++ends;
            continue;
        }
        shared_->hand = std::max(shared_->hand, mapping->first);
        const std::size_t size = std::min(stretch, mapping->first + mapping->second - shared_->hand);
        given += memory_.give_back(mapping_at(shared_->hand, size));
        shared_->hand += size;
    }
    return given;
}

void ResidentLimit::watch() {
    std::size_t others = 0; // libraries and other files
    bool stale = true;      // `others`, because other limits give back pages of theirs
    bool was_counted = false;
    Clock::time_point counted{}, last = Clock::now();
    double wait = 0, left = 0;     // of the last look: until this one, and what was resident after it
    double rate = 0, lateness = 0; // the largest of the last looks: bytes per second, and seconds
    const auto limit = static_cast<double>(limit_);
    std::unique_lock lock(shared_->mutex);
    while (!shared_->stop) {
        if (shared_->mappings.empty()) {
            shared_->changed.wait(lock);
            last = Clock::now();
            wait = 0;
            stale = true;
            continue;
        }
        const std::optional<std::size_t> of_process = memory_.file_bytes();
        const auto now = Clock::now();
        stale = stale || limits_of_process > 1;
        const bool counts =
            !of_process || (static_cast<double>(*of_process) > limit / 2 &&
                            (stale || seconds_between(counted, now) > seconds_between_counts));
        double resident = 0, least_wait = shortest_wait;
        if (counts) {
            const std::size_t exact = resident_locked();
            others = of_process && *of_process > exact ? *of_process - exact : 0;
            resident = static_cast<double>(exact);
            counted = now;
            stale = limits_of_process > 1;
            if (stale || !of_process) // counts at every look
                least_wait = std::max(least_wait, waiting_per_counting * seconds_between(now, Clock::now()));
        } else if (*of_process > others) {
            resident = static_cast<double>(*of_process - others);
        }
        if (!counts || was_counted) { // both by the same measure
            const double seconds = seconds_between(last, now);
            rate = std::max(forgetting * rate, (resident - left) / std::max(seconds, shortest_wait));
            lateness = std::max(forgetting * lateness, seconds - wait);
        }
        was_counted = counts;
        // Room for what becomes resident until the next look.
        const double high = limit - std::clamp(rate * (least_wait + lateness), limit / 8, limit * 3 / 4);
        left = resident;
        if (resident > high)
            left -= static_cast<double>(give_back(static_cast<std::size_t>(resident - high + limit / 8)));
        wait = std::clamp((high - left) / fastest_reading, least_wait, std::max(least_wait, longest_wait));
        last = now;
        shared_->changed.wait_for(lock, std::chrono::duration<double>(wait));
    }
}

} // namespace montelux
