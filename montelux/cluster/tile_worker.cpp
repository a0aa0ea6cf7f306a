#include "montelux/cluster/tile_worker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "montelux/film/film_error.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;

} // namespace

TileWorker::TileWorker(const TileRenderer& renderer, std::vector<PixelBounds> tiles, int threads,
                       Mailbox& mailbox, std::optional<OwnPreparation> own)
    : renderer_(renderer), bounds_(std::move(tiles)), mailbox_(mailbox), own_(own), tiles_(bounds_.size()),
      last_sent_(Clock::now()) {
    const PixelBounds film{bounds_.front().x0, bounds_.front().y0, bounds_.back().x1, bounds_.back().y1};
    if (renderer.makes_splats()) splats_.emplace(film);
    if (renderer.merges()) bias_.emplace(film);
    for (int t = 0; t < threads; ++t) threads_.emplace_back([this] { run_thread(); });
    ByteWriter out;
    out.put(static_cast<std::int32_t>(threads));
    mailbox_.send(leading_rank, protocol::hello, out.take());
}

TileWorker::~TileWorker() {
    stop_.request();
    {
        std::lock_guard lock(mutex_);
        closing_ = true;
        tasks_.clear();
    }
    tasks_there_.notify_all();
    for (std::thread& t : threads_) t.join();
}

TileWorker::Tile& TileWorker::known(std::uint32_t tile) {
    if (tile >= tiles_.size() || !tiles_[tile])
        throw Error("tile " + std::to_string(tile), "it was asked for, and is not here");
    return *tiles_[tile];
}

void TileWorker::run_thread() {
    std::unique_lock lock(mutex_);
    for (;;) {
        tasks_there_.wait(lock, [this] { return closing_ || !tasks_.empty(); });
        if (closing_) return;
        const Task task = tasks_.front();
        tasks_.pop_front();
        ++busy_;
        lock.unlock();
        protocol::TaskReport report{.tile = task.tile};
        std::exception_ptr failure;
        try {
            report = perform(task);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        if (failure) failure_ = failure;
        reports_.push_back(report);
        --busy_;
        reports_there_.notify_one();
    }
}

protocol::TaskReport TileWorker::perform(const Task& task) {
    Tile& tile = *tiles_[task.tile];
    const PixelBounds& bounds = bounds_[task.tile];
    const auto stride = static_cast<std::size_t>(bounds.width());
    if (own_ && own_->merging != nullptr) prepare_pass(tile);
    TileTally tally;
    auto stop = [this] { return stop_.requested(); };
    renderer_.render({.bounds = bounds,
                      .pixels = tile.pixels.data(),
                      .stride = stride,
                      .buckets = tile.buckets.empty() ? nullptr : tile.buckets.data(),
                      .bucket_count = renderer_.buckets_per_pixel(),
                      .target_samples = tile.target_samples.data(),
                      .target_stride = stride,
                      .layer_sums = tile.layer_sums.data(),
                      .splats = splats_ ? &*splats_ : nullptr,
                      .bias = bias_ ? &*bias_ : nullptr,
                      .most = task.step},
                     tally, stop, stop);
    tile.tally.merge(tally);
    tile.changed = tile.changed || tally.samples > 0;
    protocol::TaskReport report{
        .tile = task.tile, .samples = tally.samples, .cpu_seconds = tally.cpu_seconds};
    for (std::size_t i = 0; i < tile.pixels.size(); ++i) {
        const Pixel& p = tile.pixels[i];
        if (p.samples() < tile.target_samples[i]) report.remaining += tile.target_samples[i] - p.samples();
        for (int c = 0; c < 3; ++c) report.luminance += luminance_weight[c] * p.replicates().mean(c);
        report.squared_error += std::pow(luminance_error(p), 2);
    }
    return report;
}

// The light map of the samples that the tile lacks, all of the same index. The first thread that needs it makes it, on
// all threads, while the others wait for it.
void TileWorker::prepare_pass(Tile& tile) {
    std::size_t lacking = 0;
    while (lacking < tile.pixels.size() && tile.pixels[lacking].samples() >= tile.target_samples[lacking])
        ++lacking;
    if (lacking == tile.pixels.size()) return;
    const std::uint64_t index = renderer_.order().index(tile.pixels[lacking].samples());
    RenderReport report;
    std::mutex of_report;
    {
        std::lock_guard lock(pass_mutex_);
        with_threads(static_cast<int>(threads_.size()),
                     [&] { own_->merging->prepare(index, report, of_report, &stop_); });
    }
    tile.tally.rays.merge(report.rays);
    tile.tally.cpu_seconds += report.cpu_seconds;
}

void TileWorker::handle(const Message& message) {
    ByteReader in(message.bytes);
    switch (message.tag) {
    case protocol::assign:
        return assign(message);
    case protocol::release: {
        const auto tile = in.get<std::uint32_t>();
        known(tile);
        send_tiles({&tile, 1});
        tiles_[tile].reset();
        return;
    }
    case protocol::gather: {
        gathering_number_ = in.get<std::uint32_t>();
        stop_.request();
        gathering_ = true;
        std::lock_guard lock(mutex_);
        tasks_.clear();
        return;
    }
    case protocol::guide:
        return take_guide(message);
    case protocol::end:
        ended_ = true;
        stop_.request();
        return;
    default:
        throw Error("a message came that is not known: " + std::to_string(message.tag));
    }
}

void TileWorker::take_guide(const Message& message) {
    guide_.take(message, mailbox_, [this](std::shared_ptr<const GuidingField> guide) {
        std::lock_guard lock(mutex_);
        if (!own_ || busy_ > 0 || !tasks_.empty()) throw Error("guide", "it came while samples are taken");
        own_->context.set_guide(std::move(guide));
    });
}

void TileWorker::assign(const Message& message) {
    using protocol::Assignment;
    std::vector<Task> tasks;
    for (ByteReader in(message.bytes); !in.at_end();) {
        const auto a = in.get<Assignment>();
        if (a.tile >= tiles_.size()) known(a.tile);
        const std::size_t count = pixel_count(bounds_[a.tile]);
        if (a.pixels != Assignment::Pixels::known) {
            tiles_[a.tile] = std::make_unique<Tile>();
            Tile& fresh = *tiles_[a.tile];
            fresh.pixels.resize(count);
            fresh.layer_sums.resize(count * renderer_.layers().sums());
            fresh.buckets.resize(count * renderer_.buckets_per_pixel());
            if (a.pixels == Assignment::Pixels::follow) {
                in.get_all(std::span<Pixel>(fresh.pixels));
                in.get_all(std::span<double>(fresh.layer_sums));
                in.get_all(std::span<BucketMoments>(fresh.buckets));
            }
        }
        Tile& tile = known(a.tile);
        if (a.target_samples == Assignment::TargetSamples::uniform) {
            tile.target_samples.assign(count, in.get<std::uint32_t>());
        } else if (a.target_samples == Assignment::TargetSamples::each) {
            tile.target_samples.resize(count);
            in.get_all(std::span<std::uint32_t>(tile.target_samples));
        }
        if (tile.target_samples.size() != count) known(~std::uint32_t{0});
        tasks.push_back({a.tile, a.step});
    }
    {
        std::lock_guard lock(mutex_);
        tasks_.insert(tasks_.end(), tasks.begin(), tasks.end());
    }
    tasks_there_.notify_all();
}

void TileWorker::send_tiles(std::span<const std::uint32_t> which) {
    ByteWriter out;
    for (std::uint32_t t : which) {
        Tile& tile = *tiles_[t];
        out.put(protocol::TilePixelsHeader{t, static_cast<std::uint32_t>(tile.pixels.size())});
        out.put(tile.tally);
        out.put_all(std::span<const Pixel>(tile.pixels));
        out.put_all(std::span<const double>(tile.layer_sums));
        out.put_all(std::span<const BucketMoments>(tile.buckets));
        tile.tally = {};
        tile.changed = false;
        if (out.size() < message_bytes) continue;
        mailbox_.send(leading_rank, protocol::tiles, out.take());
    }
    if (out.size() > 0) mailbox_.send(leading_rank, protocol::tiles, out.take());
}

void TileWorker::finish_gathering() {
    std::vector<std::uint32_t> changed;
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        if (tiles_[t] && tiles_[t]->changed) changed.push_back(static_cast<std::uint32_t>(t));
    send_tiles(changed);
    if (splats_) send_splats();
    ByteWriter out;
    out.put(gathering_number_);
    mailbox_.send(leading_rank, protocol::gathered, out.take());
    gathering_ = false;
    stop_.reset();
}

void TileWorker::send_splats() {
    ByteWriter out;
    const auto flush = [&] { mailbox_.send(leading_rank, protocol::splats, out.take()); };
    for (std::size_t t = 0; t < bounds_.size(); ++t) {
        const PixelBounds& tile = bounds_[t];
        if (splats_->is_zero(tile)) continue;
        out.put(static_cast<std::uint32_t>(t));
        for (int y = tile.y0; y < tile.y1; ++y)
            out.put_all(std::as_const(*splats_).sums(tile.x0, y, tile.width()));
        if (out.size() >= message_bytes) flush();
    }
    if (out.size() > 0) flush();
    out.put(protocol::SplatCounts{splats_->bad(), splats_->overflows()});
    mailbox_.send(leading_rank, protocol::splat_counts, out.take());
    splats_->clear();
    if (bias_) send_bias();
    // The leader ends replicates when it has all splats, and sends the pixels anew.
    for (std::unique_ptr<Tile>& tile : tiles_) tile.reset();
}

void TileWorker::send_bias() {
    SplatFilm& open = bias_->open();
    ByteWriter out;
    out.put_all(std::as_const(open).sums());
    out.put(protocol::SplatCounts{open.bad(), open.overflows()});
    mailbox_.send(leading_rank, protocol::bias, out.take());
    open.clear();
}

void TileWorker::report() {
    std::vector<protocol::TaskReport> reports;
    bool idle = false;
    {
        std::lock_guard lock(mutex_);
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
        reports.swap(reports_);
        idle = busy_ == 0;
    }
    const Clock::time_point now = Clock::now();
    if (!reports.empty()) {
        ByteWriter out;
        out.put_all(std::span<const protocol::TaskReport>(reports));
        mailbox_.send(leading_rank, protocol::done, out.take());
        last_sent_ = now;
    }
    if (gathering_ && idle) {
        finish_gathering();
        last_sent_ = now;
    }
    if (now - last_sent_ >= beat_interval) {
        mailbox_.send(leading_rank, protocol::beat, {});
        last_sent_ = now;
    }
}

void TileWorker::wait(std::chrono::microseconds longest) {
    std::unique_lock lock(mutex_);
    reports_there_.wait_for(lock, longest, [this] { return !reports_.empty(); });
}

} // namespace montelux
