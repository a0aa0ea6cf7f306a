#include "montelux/render/live_film.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

namespace montelux {
namespace {

constexpr std::chrono::microseconds poll_interval{100};

} // namespace

void LiveFilm::open(const RenderState& state, std::span<const PixelBounds> tiles,
                    std::function<RenderReport()> report) {
    const auto all = hold_all();
    tile_count_ = tiles.size();
    tiles_ = std::make_unique<Tile[]>(tile_count_);
    for (std::size_t i = 0; i < tile_count_; ++i) tiles_[i].bounds = tiles[i];
    state_ = &state;
    report_ = std::move(report);
}

void LiveFilm::close() {
    const auto all = hold_all();
    state_ = nullptr;
}

void LiveFilm::wait_for_copies() const {
    // At most 20 ms: frequent snapshots must not delay the render.
    for (int i = 0; i < 200 && is_wanted(); ++i) std::this_thread::sleep_for(poll_interval);
}

void LiveFilm::copy_tile(const Tile& tile, Film& into) const {
    const Film& from = state_->film;
    for (int y = tile.bounds.y0; y < tile.bounds.y1; ++y)
        into.copy_row(from, tile.bounds.x0, y, tile.bounds.width());
}

void LiveFilm::hand_over(std::size_t tile) {
    Tile& t = tiles_[tile];
    std::lock_guard wish(t.wish);
    if (!t.wanted.load(std::memory_order_relaxed)) return; // the request was withdrawn
    copy_tile(t, *into_);
    t.wanted.store(false, std::memory_order_release);
}

std::optional<LiveCopy> LiveFilm::copy(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    struct Waiting {
        std::atomic<int>& count;
        explicit Waiting(std::atomic<int>& c) : count(c) { ++count; }
        ~Waiting() { --count; }
    } waiting(waiting_snapshots_);
    const std::unique_lock all(film_, deadline);
    if (!all.owns_lock() || state_ == nullptr) return std::nullopt;
    LiveCopy copy{Film(state_->film.settings(), state_->film.layers()), report_()};
    if (copy.report.samples == 0) return std::nullopt;
    into_ = &copy.film;
    std::vector<Tile*> held; // by threads that have been asked for a copy
    for (Tile& t : std::span(tiles_.get(), tile_count_)) {
        if (const std::unique_lock mine(t.held, std::try_to_lock); mine.owns_lock()) {
            copy_tile(t, copy.film);
        } else {
            t.wanted.store(true, std::memory_order_release);
            held.push_back(&t);
        }
    }
    for (;;) {
        std::erase_if(held, [&](Tile* t) {
            if (!t->wanted.load(std::memory_order_acquire)) return true;
            const std::unique_lock mine(t->held, std::try_to_lock);
            if (!mine.owns_lock()) return false;
            if (t->wanted.exchange(false)) copy_tile(*t, copy.film);
            return true;
        });
        if (held.empty()) return copy;
        if (Clock::now() >= deadline) break;
        std::this_thread::sleep_for(poll_interval);
    }
    for (Tile* t : held) {
        std::lock_guard wish(t->wish);
        t->wanted.store(false, std::memory_order_relaxed);
    }
    return std::nullopt;
}

} // namespace montelux
