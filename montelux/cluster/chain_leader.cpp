#include "montelux/cluster/chain_leader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Groups that are dealt out and not added yet, for each that the ranks take at once. More would let fast ranks get
// further ahead of slow ones, and takes memory.
constexpr std::uint64_t groups_ahead = 2;

} // namespace

ChainLeader::ChainLeader(RankRoster& roster, int threads)
    : roster_(roster), threads_(threads), ranks_(static_cast<std::size_t>(roster.size())) {}

void ChainLeader::run(ChainRenderer& chains, RenderState& state, std::uint32_t target_samples,
                      const ChainWatch& watch) {
    roster_.begin_listening();
    if (!worker_) worker_ = std::make_unique<ChainWorker>(chains, threads_, roster_.mailbox());
    const std::uint64_t size = chains.order().replicate_size();
    const std::uint64_t target = target_samples / size, most = chains.order().share() / size;
    pixels_ = state.film.pixels().size();
    paths_per_group_ = size * pixels_;
    std::chrono::microseconds pause = shortest_poll;
    for (;;) {
        std::uint64_t done = state.film.pixels().front().replicates().count();
        bool pauses = false;
        for (auto it = finished_.find(done); it != finished_.end() && done < target && !pauses;
             it = finished_.find(++done)) {
            watch.add([&] {
                chains.add(state, it->second.replicate);
                it->second.costs.add_to(state.report);
            });
            finished_.erase(it);
            pauses = watch.pause();
        }
        finished_.erase(finished_.begin(), finished_.lower_bound(done)); // of a render before
        if (done >= target || pauses || roster_.failure() || watch.groups.abandon()) break;
        deal(done, most);
        const bool heard = listen();
        roster_.watch();
        watch.groups.tell(paths_beyond());
        pause = heard ? shortest_poll : std::min(2 * pause, longest_poll);
        if (!heard) worker_->wait(pause);
    }
    roster_.end_listening();
}

void ChainLeader::release() {
    if (!worker_) return;
    worker_.reset();
    for (int r = 0; r < roster_.size(); ++r)
        if (!roster_.is_leader(r) && roster_.takes_part(r)) roster_.send(r, protocol::drop_groups, {});
    for (Rank& rank : ranks_) rank = {};
    finished_.clear();
    next_ = 0;
}

void ChainLeader::deal(std::uint64_t done, std::uint64_t most) {
    next_ = std::max(next_, done);
    std::uint64_t at_once = 0;
    for (int r = 0; r < roster_.size(); ++r)
        if (roster_.takes_part(r)) at_once += ChainRenderer::groups_at_once(roster_.threads(r));
    for (int r = 0; r < roster_.size(); ++r) {
        Rank& rank = ranks_[static_cast<std::size_t>(r)];
        const std::uint64_t end = std::min(most, done + groups_ahead * at_once);
        if (!roster_.takes_part(r) || rank.in_hand > 0 || next_ >= end) continue;
        const std::uint64_t count =
            std::min<std::uint64_t>(ChainRenderer::groups_at_once(roster_.threads(r)), end - next_);
        ByteWriter out;
        out.put(protocol::Groups{next_, count});
        roster_.send(r, protocol::take_groups, out.take());
        next_ += count;
        rank.in_hand = count;
    }
}

bool ChainLeader::listen() {
    bool heard = false;
    while (auto message = roster_.receive()) {
        heard = true;
        if (message->tag == protocol::take_groups)
            worker_->handle(*message);
        else
            handle(*message);
    }
    worker_->report();
    return heard;
}

void ChainLeader::handle(const Message& message) {
    Rank& rank = ranks_[static_cast<std::size_t>(message.source)];
    ByteReader in(message.bytes);
    const auto refuse = [&](const std::string& what) {
        throw Error("rank " + std::to_string(message.source), what);
    };
    switch (message.tag) {
    case protocol::paths:
        rank.paths = in.get<std::uint64_t>();
        return;
    case protocol::replicate_part: {
        const auto part = in.get<protocol::ReplicatePart>();
        if (part.first > pixels_ || part.count > pixels_ - part.first) refuse("sent a group of another size");
        if (part.first == 0) {
            rank.arriving = {.number = part.number, .pixels = {}, .tally = {}};
            rank.arriving.pixels.resize(pixels_);
            // While the group arrives, the rank can take the next one.
            rank.in_hand -= std::min<std::size_t>(rank.in_hand, 1);
            rank.paths = 0;
        }
        if (part.number != rank.arriving.number || rank.arriving.pixels.size() != pixels_)
            refuse("sent parts of a group that has not begun");
        in.get_all(std::span(rank.arriving.pixels).subspan(part.first, part.count));
        return;
    }
    case protocol::replicate: {
        const auto number = in.get<std::uint64_t>();
        if (number != rank.arriving.number || rank.arriving.pixels.size() != pixels_)
            refuse("sent the end of a group that has not begun");
        Finished& finished = finished_[number];
        finished.replicate = std::exchange(rank.arriving, {});
        finished.replicate.tally = in.get<ChainGroup::Tally>();
        finished.costs = in.get<ChainCosts>();
        return;
    }
    case protocol::hello:
    case protocol::wish:
    case protocol::failed:
    case protocol::beat:
        return;
    default:
        refuse("sent a message that rank 0 does not know: " + std::to_string(message.tag));
    }
}

std::uint64_t ChainLeader::paths_beyond() const {
    std::uint64_t paths = finished_.size() * paths_per_group_;
    for (const Rank& rank : ranks_) paths += rank.paths;
    return paths;
}

} // namespace montelux
