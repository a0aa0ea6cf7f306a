// LiveFilm: snapshots of a running render's film for other threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "montelux/render/render_state.h"

namespace montelux {

// A film and a report at one moment of a render. Replicates may be open (Film::end_replicates).
struct LiveCopy {
    Film film;
    RenderReport report;
};

// The thread that takes a snapshot copies the tiles that no thread is rendering; a rendering thread copies
// its own tile between two samples. So nothing is paused, and no sample changes.
class LiveFilm {
  public:
    LiveFilm() = default;
    LiveFilm(const LiveFilm&) = delete;
    LiveFilm& operator=(const LiveFilm&) = delete;

    // The current render, every pixel between two samples. From any thread, several at once too, but not from
    // the render's own callbacks. Waits at most `seconds`, as a rule for one pixel of each thread. Empty if
    // that is too short, before the first samples, and after the end of the render.
    std::optional<LiveCopy> copy(double seconds);

    // The remaining members are for the threads of the render loop only.

    // The state outlives close(); `report` may be called from any thread.
    void open(const RenderState& state, std::span<const PixelBounds> tiles,
              std::function<RenderReport()> report);
    // Waits for copies in progress. No copies are made afterwards.
    void close();

    // Locked by the thread that changes the pixels of a tile.
    std::unique_lock<std::mutex> hold(std::size_t tile) { return std::unique_lock(tiles_[tile].held); }
    // Called by the thread that holds the tile, between two samples.
    void between_samples(std::size_t tile) {
        if (tiles_[tile].wanted.load(std::memory_order_relaxed)) hand_over(tile);
    }
    // Locked while other processes change pixels.
    std::unique_lock<std::timed_mutex> hold_all() { return std::unique_lock(film_); }
    bool is_wanted() const { return waiting_snapshots_.load(std::memory_order_relaxed) > 0; }
    // Gives waiting snapshots time for their copies. Not while the film is locked.
    void wait_for_copies() const;

  private:
    struct Tile {
        PixelBounds bounds;
        std::mutex held;
        std::mutex wish; // of `wanted`, while another thread holds the tile
        std::atomic<bool> wanted{false};
    };
    void copy_tile(const Tile& tile, Film& into) const;
    void hand_over(std::size_t tile);

    std::timed_mutex film_; // of the members below; locked while a copy is made
    const RenderState* state_ = nullptr;
    std::function<RenderReport()> report_;
    std::unique_ptr<Tile[]> tiles_;
    std::size_t tile_count_ = 0;
    Film* into_ = nullptr; // the copy in progress
    std::atomic<int> waiting_snapshots_{0};
};

} // namespace montelux
