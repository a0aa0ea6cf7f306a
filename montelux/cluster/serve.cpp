#include "montelux/cluster/serve.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "montelux/cluster/chain_worker.h"
#include "montelux/cluster/protocol.h"
#include "montelux/cluster/rank_worker.h"
#include "montelux/cluster/run_beside.h"
#include "montelux/cluster/tile_worker.h"
#include "montelux/mc/io/byte_stream.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
// Longest reason: short messages need no waiting receiver.
constexpr std::size_t longest_reason = 1000;

// Throws when the leader has been silent since then.
void check_leader(const Mailbox& mailbox, Clock::time_point last_heard, double patience_seconds) {
    if (std::chrono::duration<double>(Clock::now() - last_heard).count() > patience_seconds)
        throw LeaderIsSilent("rank " + std::to_string(mailbox.rank()),
                             "rank 0, which leads the render, has been silent for too long");
}

void serve(RankWorker& worker, Mailbox& mailbox, const ServeSettings& settings) {
    bool cancel_sent = false;
    Clock::time_point last_heard = Clock::now();
    std::chrono::microseconds pause = shortest_poll;
    while (!worker.ended()) {
        bool heard = false;
        while (auto message = mailbox.receive()) {
            if (message->tag != protocol::beat) worker.handle(*message);
            heard = true;
        }
        if (heard) last_heard = Clock::now();
        worker.report();
        if (!cancel_sent && settings.cancel != nullptr && settings.cancel->requested()) {
            mailbox.send(leading_rank, protocol::wish, {});
            cancel_sent = true;
        }
        check_leader(mailbox, last_heard, settings.patience_seconds);
        pause = heard ? shortest_poll : std::min(2 * pause, longest_poll);
        worker.wait(pause);
    }
}

} // namespace

void serve_render(const Renderer& renderer, Mailbox& mailbox, const ServeSettings& settings) {
    renderer.serve([&](const SampleTakers& takers) {
        if (takers.chains != nullptr) {
            ChainWorker worker(*takers.chains, settings.threads, mailbox);
            return serve(worker, mailbox, settings);
        }
        const SceneDescription& description = renderer.description();
        std::optional<MergingPasses> merging;
        if (takers.context.merges())
            prepare_and_beat(mailbox, [&] {
                merging.emplace(takers.context, renderer.accelerator(), *description.integrator.merging,
                                description.film.crop);
            });
        TileWorker worker(takers.tiles, tiles_of(description.film.crop, settings.tile_size), settings.threads,
                          mailbox, TileWorker::OwnPreparation{takers.context, merging ? &*merging : nullptr});
        serve(worker, mailbox, settings);
    });
}

void prepare_and_beat(Mailbox& mailbox, const std::function<void()>& prepare) {
    run_beside(prepare, beat_interval, [&] { mailbox.send(leading_rank, protocol::beat, {}); });
}

void serve_failure(const std::string& why, Mailbox& mailbox, double patience_seconds) {
    ByteWriter out;
    out.put_text(why.substr(0, longest_reason));
    mailbox.send(leading_rank, protocol::failed, out.take());
    for (Clock::time_point last_heard = Clock::now();;) {
        while (auto message = mailbox.receive()) {
            if (message->tag == protocol::end) return;
            last_heard = Clock::now();
        }
        check_leader(mailbox, last_heard, patience_seconds);
        std::this_thread::sleep_for(longest_poll);
    }
}

} // namespace montelux
