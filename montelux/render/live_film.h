// LiveFilm: the film of a running render, to be looked at by other threads while its tiles are rendered.
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

// Who looks copies the tiles that nobody renders; a thread that renders a tile copies its own, between two
// samples. So nothing is paused, and no sample is changed.
class LiveFilm {
  public:
    LiveFilm() = default;
    LiveFilm(const LiveFilm&) = delete;
    LiveFilm& operator=(const LiveFilm&) = delete;

    // The render as it is now, every pixel between two samples. From any thread, several at once too, but not
    // from the render's own callbacks. Waits at most `seconds`, as a rule for one pixel of each thread. Empty
    // where that is too short, before the first samples, and after the end of the render.
    std::optional<LiveCopy> copy(double seconds);

    // The rest is for the loop that renders, and called by its threads alone.

    // The state outlives close(); `report` may be called from any thread.
    void open(const RenderState& state, std::span<const PixelBounds> tiles,
              std::function<RenderReport()> report);
    // Waits for copies that are being made. Nothing may be copied from then on.
    void close();

    // Held by the thread that changes the pixels of a tile.
    std::unique_lock<std::mutex> hold(std::size_t tile) { return std::unique_lock(tiles_[tile].held); }
    // By the thread that holds the tile, between two samples.
    void between_samples(std::size_t tile) {
        if (tiles_[tile].wanted.load(std::memory_order_relaxed)) hand_over(tile);
    }
    // Held while others than the threads of this process change pixels.
    std::unique_lock<std::timed_mutex> hold_all() { return std::unique_lock(film_); }
    bool is_wanted() const { return looking_.load(std::memory_order_relaxed) > 0; }
    // Gives those who look time for their copies. Not while the film is held.
    void wait_for_copies() const;

  private:
    struct Tile {
        PixelBounds bounds;
        std::mutex held;
        std::mutex wish; // of what follows, where the tile is held by somebody else
        std::atomic<bool> wanted{false};
    };
    void copy_tile(const Tile& tile, Film& into) const;
    void hand_over(std::size_t tile);

    std::timed_mutex film_; // of the members below; held while a copy is made
    const RenderState* state_ = nullptr;
    std::function<RenderReport()> report_;
    std::unique_ptr<Tile[]> tiles_;
    std::size_t tile_count_ = 0;
    Film* into_ = nullptr; // the copy that is being made
    std::atomic<int> looking_{0};
};

} // namespace montelux
