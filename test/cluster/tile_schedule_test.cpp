// Every tile gets its turns, stays where it was, and moves to those who have nothing to do.
#include <algorithm>
#include <gtest/gtest.h>
#include <map>

#include "montelux/cluster/tile_schedule.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

TEST(TileSchedule, LargestWorkFirstAndEachTileOnce) {
    TileSchedule schedule(2, 4);
    schedule.begin_round(std::vector<double>{1, 0, 3, 2});
    EXPECT_EQ(schedule.next(0), 2);
    EXPECT_EQ(schedule.next(1), 3);
    EXPECT_EQ(schedule.next(0), 0);
    EXPECT_EQ(schedule.next(1), std::nullopt);
    EXPECT_EQ(schedule.in_work(0), 2);
    EXPECT_FALSE(schedule.finished());
    for (int tile : {2, 3, 0}) schedule.returned(tile, 0);
    EXPECT_TRUE(schedule.finished());
    EXPECT_EQ(schedule.in_work(0), 0);
}

TEST(TileSchedule, TilesStayWithTheirRank) {
    TileSchedule schedule(2, 6);
    const std::vector<double> work(6, 1.0);
    std::map<int, int> rank_of;
    schedule.begin_round(work);
    for (int i = 0; i < 6; ++i) {
        const int rank = i < 2 ? 1 : 0;
        rank_of[*schedule.next(rank)] = rank;
    }
    for (int tile = 0; tile < 6; ++tile) schedule.returned(tile, 0);
    schedule.begin_round(work);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(rank_of[*schedule.next(1)], 1);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(rank_of[*schedule.next(0)], 0);
}

TEST(TileSchedule, FewestTurnsFirst) {
    TileSchedule schedule(1, 3);
    schedule.begin_round(std::vector<double>{1, 2, 3});
    EXPECT_EQ(schedule.next(0), 2);
    schedule.returned(2, 100);
    EXPECT_EQ(schedule.next(0), 1);
    EXPECT_EQ(schedule.next(0), 0);
    EXPECT_EQ(schedule.next(0), 2);
}

TEST(TileSchedule, IdleRanksTakeFromTheOneWithMostWork) {
    TileSchedule schedule(3, 5);
    schedule.begin_round(std::vector<double>{1, 1, 1, 1, 1});
    for (int rank : {0, 0, 0, 1, 1}) schedule.next(rank);
    for (int tile = 0; tile < 5; ++tile) schedule.returned(tile, 0);
    // Rank 0 holds 0, 1, 2 and rank 1 holds 3, 4.
    schedule.begin_round(std::vector<double>{1, 2, 3, 4, 5});
    EXPECT_EQ(schedule.next(2), 4);
    EXPECT_EQ(schedule.next(2), 2);
    EXPECT_EQ(schedule.next(1), 3);
    EXPECT_EQ(schedule.next(1), 1);
    EXPECT_EQ(schedule.next(0), 0);
    EXPECT_EQ(schedule.next(0), std::nullopt);
}

// Random ranks ask, random tasks return: all the work is done, by no two at a time.
TEST(TileSchedule, NothingIsLostOrDoneTwice) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        constexpr int tiles = 40, ranks = 5;
        TileSchedule schedule(ranks, tiles);
        for (int round = 0; round < 3; ++round) {
            std::vector<double> left(tiles);
            for (int t = 0; t < tiles; ++t)
                left[static_cast<std::size_t>(t)] = static_cast<double>(hash_key(seed, round, t) % 4);
            schedule.begin_round(left);
            std::vector<int> in_work;
            for (std::uint64_t step = 0; !schedule.finished(); ++step) {
                ASSERT_LT(step, 10'000u);
                const std::uint64_t draw = hash_key(seed, round, 1000 + step);
                if (draw % 2 == 0) {
                    const auto tile = schedule.next(static_cast<int>(draw / 2 % ranks));
                    if (!tile) continue;
                    ASSERT_EQ(std::count(in_work.begin(), in_work.end(), *tile), 0);
                    ASSERT_GT(left[static_cast<std::size_t>(*tile)], 0);
                    in_work.push_back(*tile);
                } else if (!in_work.empty()) {
                    const std::size_t which = draw / 2 % in_work.size();
                    const int tile = in_work[which];
                    in_work.erase(in_work.begin() + static_cast<std::ptrdiff_t>(which));
                    schedule.returned(tile, left[static_cast<std::size_t>(tile)] -= 1);
                }
            }
            for (double w : left) EXPECT_EQ(w, 0);
            EXPECT_TRUE(in_work.empty());
        }
    }
}

} // namespace
} // namespace montelux
