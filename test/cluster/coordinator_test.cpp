// The leader of a render among ranks whose every word is chosen by the test.
#include "test/cluster/local_job.h"
#include "test/render/mixed_scene.h"
#include <atomic>
#include <gtest/gtest.h>
#include <string>
#include <thread>

#include "montelux/cluster/coordinator.h"
#include "montelux/cluster/serve.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/renderer.h"
#include "montelux/render/tile_renderer.h"

namespace montelux::testing {
namespace {

using protocol::Assignment;

constexpr int edge = 4, tile_pixels = edge * edge;

// A rank without threads of its own.
class PlayedRank {
  public:
    explicit PlayedRank(Mailbox& mailbox) : mailbox_(mailbox) {}

    void say(protocol::Tag tag) { mailbox_.send(leading_rank, tag, {}); }
    void say_hello() {
        ByteWriter out;
        out.put(std::int32_t{1});
        mailbox_.send(leading_rank, protocol::hello, out.take());
    }
    void say_counts(std::uint64_t bad, std::uint64_t overflows) {
        ByteWriter out;
        out.put(protocol::SplatCounts{bad, overflows});
        mailbox_.send(leading_rank, protocol::splat_counts, out.take());
    }
    void say_done(std::uint32_t tile, std::uint64_t remaining) {
        ByteWriter out;
        out.put(protocol::TaskReport{.tile = tile, .remaining = remaining});
        mailbox_.send(leading_rank, protocol::done, out.take());
    }
    void send_empty_tile(std::uint32_t tile) {
        const std::vector<Pixel> pixels(tile_pixels);
        ByteWriter out;
        out.put(protocol::TilePixelsHeader{tile, tile_pixels});
        out.put(TileTally{});
        out.put_all(std::span<const Pixel>(pixels));
        mailbox_.send(leading_rank, protocol::tiles, out.take());
    }
    std::optional<Message> hear() { return mailbox_.receive(); }
    // Assigned since it last received.
    std::vector<Assignment> hear_assignments() {
        std::vector<Assignment> heard;
        while (auto message = hear())
            for (ByteReader in(message->bytes); message->tag == protocol::assign && !in.at_end();) {
                heard.push_back(in.get<Assignment>());
                std::vector<Pixel> pixels(tile_pixels);
                if (heard.back().pixels == Assignment::Pixels::follow) in.get_all(std::span(pixels));
                if (heard.back().target_samples == Assignment::TargetSamples::uniform)
                    in.get<std::uint32_t>();
                std::vector<std::uint32_t> target_samples(tile_pixels);
                if (heard.back().target_samples == Assignment::TargetSamples::each)
                    in.get_all(std::span(target_samples));
            }
        return heard;
    }

  private:
    Mailbox& mailbox_;
};

// A leader with no threads to render with, over a film of three tiles side by side.
class CoordinatorTest : public ::testing::Test {
  protected:
    static SceneBuilder scene() { return mixed_scene(1, 3 * edge, edge); }
    // One round. stop() is called before tiles are dealt out, again and again.
    void run(Coordinator& coordinator, const std::function<bool()>& stop) {
        const RoundWatch watch{[&](bool) { return stop(); },
                               [](std::uint64_t, const std::optional<FilmError>&) {}};
        renderer_.serve([&](const SampleTakers& takers) { coordinator.run(takers.tiles, state_, watch); });
    }
    CoordinatorSettings settings(double patience_seconds = 60) const {
        return {.tile_size = edge, .threads = 0, .patience_seconds = patience_seconds};
    }
    const PixelBounds& crop() const { return builder_.description.film.crop; }

    SceneBuilder builder_ = scene();
    Renderer renderer_{builder_.description};
    RenderState state_{builder_.description.film};
};

// The round ends while a tile is on its way from one rank to another. In the next round it is the first
// rank's turn again, which has forgotten the tile.
TEST_F(CoordinatorTest, TilesInTransitAtTheEndOfARoundAreNotForgotten) {
    LocalJob job(3);
    PlayedRank first(job.mailbox(1)), second(job.mailbox(2));
    Coordinator coordinator(job.mailbox(0), crop(), settings());
    state_.target_samples.assign(state_.film.pixels().size(), 8);
    std::optional<std::uint32_t> moved;
    first.say_hello();
    run(coordinator, [&] {
        if (!moved) {
            // With two of three tiles in hand it gives one back before its end, gets the third, and the other
            // rank has none left but the one that was given back.
            const std::vector<Assignment> heard = first.hear_assignments();
            if (heard.empty()) return false;
            EXPECT_EQ(heard.size(), 2u);
            moved = heard.front().tile;
            first.say_done(*moved, 1);
            return false;
        }
        while (auto message = first.hear()) {
            if (message->tag == protocol::assign) second.say_hello();
            if (message->tag != protocol::release) continue;
            EXPECT_EQ(ByteReader(message->bytes).get<std::uint32_t>(), *moved);
            first.send_empty_tile(*moved);
            first.say(protocol::gathered);
            second.say(protocol::gathered);
            return true;
        }
        return false;
    });
    ASSERT_TRUE(moved);

    // Nothing else is left to do, and ranks are polled in their order.
    state_.target_samples.assign(state_.film.pixels().size(), 0);
    for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x)
            state_.target_samples[static_cast<std::size_t>(y * crop().width()) + *moved * edge +
                                  static_cast<std::size_t>(x)] = 8;
    std::vector<Assignment> heard;
    run(coordinator, [&] {
        heard = first.hear_assignments();
        if (heard.empty()) return false;
        first.say(protocol::gathered);
        second.say(protocol::gathered);
        return true;
    });
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard.front().tile, *moved);
    EXPECT_NE(heard.front().pixels, Assignment::Pixels::known);
}

TEST_F(CoordinatorTest, CountsOfSplatsAreThoseOfAllRanksAndRounds) {
    LocalJob job(3);
    PlayedRank first(job.mailbox(1)), second(job.mailbox(2));
    Coordinator coordinator(job.mailbox(0), crop(), settings());
    state_.splats.emplace(crop());
    first.say_hello();
    second.say_hello();
    for (int round = 0; round < 2; ++round) {
        state_.target_samples.assign(state_.film.pixels().size(), 8);
        run(coordinator, [&] {
            if (first.hear_assignments().empty()) return false;
            first.say_counts(1, 2);
            second.say_counts(30, 40);
            first.say(protocol::gathered);
            second.say(protocol::gathered);
            return true;
        });
    }
    EXPECT_EQ(state_.splats->bad(), 62u);
    EXPECT_EQ(state_.splats->overflows(), 84u);
}

// Rounds, and what the leader does between them, are shorter and longer than its patience.
TEST_F(CoordinatorTest, RanksThatNeverSayHelloAreGivenUp) {
    LocalJob job(2);
    Coordinator coordinator(job.mailbox(0), crop(), settings(0.1));
    state_.target_samples.assign(state_.film.pixels().size(), 8);
    int rounds = 0;
    for (; !coordinator.failed() && rounds < 100; ++rounds) {
        int calls = 0;
        run(coordinator, [&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            return calls++ == 4;
        });
        if (rounds == 0) std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    ASSERT_TRUE(coordinator.failed());
    EXPECT_GT(rounds, 2);
    EXPECT_NE(coordinator.failure()->find("rank 1 has not answered"), std::string::npos);
    EXPECT_TRUE(coordinator.someone_hangs());
}

// A rank that takes longer to prepare than the leader's patience, and says that it is alive.
TEST_F(CoordinatorTest, RanksThatPrepareForLongAreWaitedFor) {
    LocalJob job(2);
    PlayedRank rank(job.mailbox(1));
    Coordinator coordinator(job.mailbox(0), crop(), settings(1.5));
    state_.target_samples.assign(state_.film.pixels().size(), 8);
    std::thread helper([&] {
        prepare_and_beat(job.mailbox(1), [] { std::this_thread::sleep_for(std::chrono::seconds(3)); });
        rank.say_hello();
    });
    bool waited_for = false;
    run(coordinator, [&] {
        waited_for = coordinator.threads() > 0;
        if (waited_for) rank.say(protocol::gathered);
        return waited_for;
    });
    helper.join();
    EXPECT_TRUE(waited_for);
    EXPECT_FALSE(coordinator.failed()) << *coordinator.failure();
}

// A guide is trained by the leader alone: it hears the others meanwhile, and does without those that are silent.
TEST_F(CoordinatorTest, RanksAreHeardWhileTheLeaderWorks) {
    LocalJob job(3);
    PlayedRank first(job.mailbox(1)), second(job.mailbox(2));
    int wishes = 0, turns = 0;
    Coordinator coordinator(job.mailbox(0), crop(), settings(0.2), [&] { ++wishes; });
    first.say_hello();
    second.say_hello();
    std::atomic<bool> ended{false};
    coordinator.meanwhile(
        [&] {
            while (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        },
        [&] {
            first.say(turns++ == 0 ? protocol::wish : protocol::beat);
            ended = coordinator.failed();
        });
    EXPECT_EQ(wishes, 1);
    EXPECT_GT(turns, 10);
    ASSERT_TRUE(coordinator.failed());
    EXPECT_NE(coordinator.failure()->find("rank 2 has not answered"), std::string::npos);
    EXPECT_THROW(coordinator.meanwhile([] { throw Error("guide", "is bad"); }, [] {}), Error);
}

TEST_F(CoordinatorTest, WhatPreparationThrowsComesThrough) {
    LocalJob job(2);
    EXPECT_THROW(prepare_and_beat(job.mailbox(1), [] { throw Error("scene", "is bad"); }), Error);
}

// The leader says why, for the rank that failed as for all.
TEST_F(CoordinatorTest, RanksThatFailEndTheRender) {
    LocalJob job(2);
    Coordinator coordinator(job.mailbox(0), crop(), settings());
    state_.target_samples.assign(state_.film.pixels().size(), 8);
    std::thread failing([&] { serve_failure("there is not enough memory", job.mailbox(1), 60); });
    const auto begin = std::chrono::steady_clock::now();
    run(coordinator, [&] { return std::chrono::steady_clock::now() - begin > std::chrono::seconds(20); });
    coordinator.end();
    failing.join();
    ASSERT_TRUE(coordinator.failed());
    EXPECT_EQ(*coordinator.failure(), "rank 1: there is not enough memory; what the others did is saved");
    EXPECT_FALSE(coordinator.someone_hangs());
}

TEST_F(CoordinatorTest, SilentLeadersAreNotWaitedForByRanksThatFailed) {
    LocalJob job(2);
    EXPECT_THROW(serve_failure("there is not enough memory", job.mailbox(1), 0.1), LeaderIsSilent);
}

} // namespace
} // namespace montelux::testing
