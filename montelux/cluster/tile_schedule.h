// Schedule of tiles: the leader chooses each rank's next tile.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace montelux {

// A tile stays with the rank that rendered it last (its holder), so that its pixels need not be sent. A rank
// without tiles gets tiles without a holder, then those of the rank with the most work left. Tiles with fewer
// turns come first, and of those the ones with the most work.
class TileSchedule {
  public:
    static constexpr int no_rank = -1;

    TileSchedule(int ranks, int tiles);

    // Remaining work of each tile. No tile may be in work.
    void begin_round(std::span<const double> work);
    bool finished() const { return unfinished_ == 0; }

    // The next tile for a rank, in work from now on.
    std::optional<int> next(int rank);
    // A tile came back from its turn with this much work left; with 0 it is finished.
    void returned(int tile, double work);

    int in_work(int rank) const { return ranks_[index(rank)].in_work; }

  private:
    enum class State : std::uint8_t { finished, waiting, in_work };
    struct Tile {
        int holder = no_rank;
        std::uint32_t turns = 0;
        double work = 0;
        State state = State::finished;
    };
    // Fewest turns first, then most work, then the lower number.
    struct Key {
        std::uint32_t turns;
        double work;
        int tile;
        bool operator<(const Key& o) const {
            if (turns != o.turns) return turns < o.turns;
            if (work != o.work) return work > o.work;
            return tile < o.tile;
        }
    };
    struct Queue {
        std::set<Key> waiting;
        double work = 0;
        int in_work = 0;
    };

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    Queue& queue_of(int holder) { return holder == no_rank ? home_ : ranks_[index(holder)]; }
    void enqueue(int tile);
    void dequeue(int tile);

    std::vector<Tile> tiles_;
    std::vector<Queue> ranks_;
    Queue home_;
    int unfinished_ = 0;
};

} // namespace montelux
