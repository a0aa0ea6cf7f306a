#include "montelux/cluster/chain_worker.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

constexpr std::chrono::milliseconds progress_interval{250};

} // namespace

ChainWorker::ChainWorker(ChainRenderer& chains, int threads, Mailbox& mailbox)
    : chains_(chains), threads_(threads), mailbox_(mailbox), last_sent_(std::chrono::steady_clock::now()) {
    thread_ = std::thread([this] { run_thread(); });
    ByteWriter out;
    out.put(static_cast<std::int32_t>(threads));
    mailbox_.send(leading_rank, protocol::hello, out.take());
}

ChainWorker::~ChainWorker() {
    {
        std::lock_guard lock(mutex_);
        closing_ = true;
    }
    forget_groups();
    groups_there_.notify_all();
    thread_.join();
}

void ChainWorker::forget_groups() {
    std::lock_guard lock(mutex_);
    groups_.clear();
    results_.clear();
    stop_.request();
}

void ChainWorker::run_thread() {
    std::unique_lock lock(mutex_);
    for (;;) {
        groups_there_.wait(lock, [this] { return closing_ || !groups_.empty(); });
        if (closing_) return;
        const protocol::Groups groups = groups_.front();
        groups_.pop_front();
        stop_.reset();
        lock.unlock();
        std::vector<ChainReplicate> replicates;
        std::exception_ptr failure;
        try {
            with_threads(threads_, [&] {
                replicates = chains_.take(
                    groups.first, groups.count,
                    {[this] { return stop_.requested(); },
                     [this](std::uint64_t paths) { paths_.store(paths, std::memory_order_relaxed); }});
            });
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        paths_ = 0;
        if (failure) failure_ = failure;
        if (!stop_.requested())
            for (ChainReplicate& replicate : replicates)
                results_.push_back({std::move(replicate), chains_.take_costs()});
        results_there_.notify_one();
    }
}

void ChainWorker::handle(const Message& message) {
    switch (message.tag) {
    case protocol::take_groups: {
        const auto groups = ByteReader(message.bytes).get<protocol::Groups>();
        {
            std::lock_guard lock(mutex_);
            groups_.push_back(groups);
        }
        groups_there_.notify_all();
        return;
    }
    case protocol::drop_groups:
        return forget_groups();
    case protocol::end:
        ended_ = true;
        return forget_groups();
    default:
        throw Error("a message came that is not known: " + std::to_string(message.tag));
    }
}

void ChainWorker::send(const Result& result) {
    const std::span<const ChainReplicate::PixelValue> pixels = result.replicate.pixels;
    const std::size_t most = message_bytes / sizeof(ChainReplicate::PixelValue);
    for (std::size_t first = 0; first < pixels.size(); first += most) {
        ByteWriter out;
        const auto part = pixels.subspan(first, std::min(most, pixels.size() - first));
        out.put(protocol::ReplicatePart{result.replicate.number, first, part.size()});
        out.put_all(part);
        mailbox_.send(leading_rank, protocol::replicate_part, out.take());
    }
    ByteWriter out;
    out.put(result.replicate.number);
    out.put(result.replicate.tally);
    out.put(result.costs);
    mailbox_.send(leading_rank, protocol::replicate, out.take());
}

void ChainWorker::report() {
    std::deque<Result> results;
    {
        std::lock_guard lock(mutex_);
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
        results.swap(results_);
    }
    for (const Result& result : results) send(result);
    const auto now = std::chrono::steady_clock::now();
    const std::uint64_t paths = paths_.load(std::memory_order_relaxed);
    if (!results.empty()) {
        last_sent_ = now;
    } else if (paths > 0 && now - last_sent_ >= progress_interval) {
        ByteWriter out;
        out.put(paths);
        mailbox_.send(leading_rank, protocol::paths, out.take());
        last_sent_ = now;
    } else if (now - last_sent_ >= beat_interval) {
        mailbox_.send(leading_rank, protocol::beat, {});
        last_sent_ = now;
    }
}

void ChainWorker::wait(std::chrono::microseconds longest) {
    std::unique_lock lock(mutex_);
    results_there_.wait_for(lock, longest, [this] { return !results_.empty() || failure_ != nullptr; });
}

} // namespace montelux
