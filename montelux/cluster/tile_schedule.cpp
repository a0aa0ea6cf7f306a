#include "montelux/cluster/tile_schedule.h"

#include <algorithm>

namespace montelux {

TileSchedule::TileSchedule(int ranks, int tiles) : tiles_(index(tiles)), ranks_(index(ranks)) {}

void TileSchedule::enqueue(int tile) {
    Tile& t = tiles_[index(tile)];
    Queue& q = queue_of(t.holder);
    q.waiting.insert({t.turns, t.work, tile});
    q.work += t.work;
    t.state = State::waiting;
}

void TileSchedule::dequeue(int tile) {
    const Tile& t = tiles_[index(tile)];
    Queue& q = queue_of(t.holder);
    q.waiting.erase({t.turns, t.work, tile});
    q.work = q.waiting.empty() ? 0 : q.work - t.work;
}

void TileSchedule::begin_round(std::span<const double> work) {
    for (Queue& q : ranks_) q = {};
    home_ = {};
    unfinished_ = 0;
    for (int tile = 0; tile < static_cast<int>(tiles_.size()); ++tile) {
        Tile& t = tiles_[index(tile)];
        t.turns = 0;
        t.work = work[index(tile)];
        t.state = State::finished;
        if (!(t.work > 0)) continue;
        ++unfinished_;
        enqueue(tile);
    }
}

std::optional<int> TileSchedule::next(int rank) {
    Queue* q = &ranks_[index(rank)];
    if (q->waiting.empty() ||
        (!home_.waiting.empty() && home_.waiting.begin()->turns < q->waiting.begin()->turns))
        q = &home_;
    if (q->waiting.empty())
        q = &*std::max_element(ranks_.begin(), ranks_.end(),
                               [](const Queue& a, const Queue& b) { return a.work < b.work; });
    if (q->waiting.empty()) return std::nullopt;
    const int tile = q->waiting.begin()->tile;
    dequeue(tile);
    Tile& t = tiles_[index(tile)];
    t.state = State::in_work;
    t.holder = rank;
    ++ranks_[index(rank)].in_work;
    return tile;
}

void TileSchedule::returned(int tile, double work) {
    Tile& t = tiles_[index(tile)];
    if (t.state != State::in_work) return;
    --ranks_[index(t.holder)].in_work;
    ++t.turns;
    t.work = work;
    if (work > 0) {
        enqueue(tile);
    } else {
        t.state = State::finished;
        --unfinished_;
    }
}

} // namespace montelux
