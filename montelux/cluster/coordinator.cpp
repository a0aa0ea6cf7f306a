#include "montelux/cluster/coordinator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Duration of a task; longer if the reports of many threads would keep the leader busy.
constexpr double task_seconds = 0.1, seconds_a_thread = 1e-4;
// Tasks per thread of a rank: one in work, one waiting.
constexpr int tasks_a_thread = 2;
constexpr std::uint32_t first_step = 4; // samples per pixel, where the cost of a tile is not known

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

// Calls f(first, count, offset) for each row of a tile: start in the film, length, and number of the tile's
// pixels before it.
template <typename F>
void for_rows(const PixelBounds& film, const PixelBounds& tile, const F& f) {
    const auto width = static_cast<std::size_t>(film.width()), count = static_cast<std::size_t>(tile.width());
    std::size_t offset = 0;
    for (int y = tile.y0; y < tile.y1; ++y, offset += count)
        f(static_cast<std::size_t>(y - film.y0) * width + static_cast<std::size_t>(tile.x0 - film.x0), count,
          offset);
}

} // namespace

Coordinator::Coordinator(Mailbox& mailbox, const PixelBounds& crop, const CoordinatorSettings& settings,
                         std::function<void()> on_wish)
    : mailbox_(mailbox), settings_(settings), on_wish_(std::move(on_wish)),
      bounds_(tiles_of(crop, settings.tile_size)), tiles_(bounds_.size()), ranks_(index(mailbox.size())),
      schedule_(mailbox.size(), static_cast<int>(bounds_.size())) {}

Coordinator::~Coordinator() { end(); }

void Coordinator::end() {
    if (std::exchange(ended_, true)) return;
    worker_.reset();
    for (int r = 1; r < mailbox_.size(); ++r) send(r, protocol::end, {});
}

void Coordinator::send(int rank, protocol::Tag tag, std::vector<std::uint8_t> bytes) {
    ++traffic_.messages;
    if (rank != mailbox_.rank()) traffic_.bytes_out += bytes.size();
    mailbox_.send(rank, tag, std::move(bytes));
}

double Coordinator::work_of(int tile, std::uint64_t samples) const {
    double cost = tiles_[index(tile)].seconds_per_sample;
    if (!(cost > 0)) cost = known_costs_ > 0 ? known_seconds_ / known_costs_ : 1e-6;
    return static_cast<double>(samples) * cost;
}

int Coordinator::threads() const {
    int threads = 0;
    for (const Rank& r : ranks_) threads += r.threads;
    return threads;
}

std::uint32_t Coordinator::step_of(int tile) const {
    const double cost = tiles_[index(tile)].seconds_per_sample;
    if (!(cost > 0)) return first_step;
    const double seconds = std::max(task_seconds, seconds_a_thread * threads());
    const double samples = seconds / (cost * static_cast<double>(pixel_count(bounds_[index(tile)])));
    return static_cast<std::uint32_t>(std::clamp(samples, 1.0, 1e9));
}

void Coordinator::begin_round() {
    const std::span<const Pixel> pixels = state_->film.pixels();
    const std::vector<std::uint32_t>& target_samples = state_->target_samples;
    uniform_target_ = target_samples.front();
    if (!std::ranges::all_of(target_samples, [&](std::uint32_t g) { return g == target_samples.front(); }))
        uniform_target_.reset();
    std::vector<double> work(tiles_.size());
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        std::uint64_t remaining = 0;
        for_rows(state_->film.bounds(), bounds_[t], [&](std::size_t first, std::size_t count, std::size_t) {
            for (std::size_t i = first; i < first + count; ++i)
                if (pixels[i].samples() < target_samples[i])
                    remaining += target_samples[i] - pixels[i].samples();
        });
        work[t] = work_of(static_cast<int>(t), remaining);
        tiles_[t].goals_known = false;
    }
    schedule_.begin_round(work);
    samples_ = 0;
    something_done_ = false;
}

void Coordinator::run(const TileRenderer& renderer, RenderState& state, const RoundWatch& watch) {
    state_ = &state;
    watch_ = &watch;
    // Between rounds the leader writes checkpoints and does not listen, so silence then does not count.
    const Clock::time_point now = Clock::now();
    for (Rank& r : ranks_) r.last_heard = worker_ ? r.last_heard + (now - paused_) : now;
    if (!worker_) worker_ = std::make_unique<TileWorker>(renderer, bounds_, settings_.threads, mailbox_);
    begin_round();
    // Polls less often while nothing happens, to leave the processor to rendering threads.
    constexpr std::chrono::microseconds shortest{50}, longest{1000};
    std::chrono::microseconds pause = shortest;
    while (!schedule_.finished() && !failed() && !watch.stop(something_done_)) {
        deal();
        const bool heard = listen();
        check_silence();
        if (seconds_between(last_report_, Clock::now()) > 0.2) report_progress();
        pause = heard ? shortest : std::min(2 * pause, longest);
        if (!heard) worker_->wait(pause);
    }
    gather();
    paused_ = Clock::now();
}

void Coordinator::deal() {
    for (int r = 0; r < mailbox_.size(); ++r) {
        std::vector<std::uint8_t> message;
        while (schedule_.in_work(r) < tasks_a_thread * ranks_[index(r)].threads) {
            const auto pick = schedule_.next(r);
            if (!pick) break;
            Tile& t = tiles_[index(*pick)];
            if (t.holder != r && t.holder != TileSchedule::no_rank) ++traffic_.moved_tiles;
            if (t.home || t.holder == r) {
                assign(r, *pick, message);
                continue;
            }
            t.wanted_by = r;
            ByteWriter out;
            out.put(static_cast<std::uint32_t>(*pick));
            // The holder forgets the tile, even if the round ends before the tile reaches the rank that needs
            // it.
            send(std::exchange(t.holder, TileSchedule::no_rank), protocol::release, out.take());
        }
        if (!message.empty()) send(r, protocol::assign, std::move(message));
    }
}

void Coordinator::assign(int rank, int tile, std::vector<std::uint8_t>& message) {
    using protocol::Assignment;
    Tile& t = tiles_[index(tile)];
    const PixelBounds& bounds = bounds_[index(tile)];
    const PixelBounds& film = state_->film.bounds();
    const std::span<const Pixel> pixels = state_->film.pixels();
    Assignment a{.tile = static_cast<std::uint32_t>(tile), .step = step_of(tile)};
    // The holder keeps its copy when the film gets one.
    const bool holds = t.holder == rank;
    if (!t.goals_known || !holds)
        a.target_samples =
            uniform_target_ ? Assignment::TargetSamples::uniform : Assignment::TargetSamples::each;
    if (!holds) {
        bool fresh = true;
        for_rows(film, bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            for (std::size_t i = first; i < first + count; ++i) fresh = fresh && pixels[i].samples() == 0;
        });
        a.pixels = fresh ? Assignment::Pixels::fresh : Assignment::Pixels::follow;
    }
    ByteWriter out;
    out.put(a);
    if (a.pixels == Assignment::Pixels::follow) {
        for_rows(film, bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            out.put_all(pixels.subspan(first, count));
        });
        const std::size_t sums = state_->film.layers().sums();
        const std::span<const double> layer_sums = std::as_const(state_->film).layer_sums();
        for_rows(film, bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            out.put_all(layer_sums.subspan(first * sums, count * sums));
        });
    }
    if (a.target_samples == Assignment::TargetSamples::uniform) {
        out.put(*uniform_target_);
    } else if (a.target_samples == Assignment::TargetSamples::each) {
        for_rows(film, bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            out.put_all(std::span<const std::uint32_t>(state_->target_samples).subspan(first, count));
        });
    }
    t.goals_known = true;
    t.home = false;
    t.holder = rank;
    const std::vector<std::uint8_t> bytes = out.take();
    message.insert(message.end(), bytes.begin(), bytes.end());
}

bool Coordinator::listen() {
    bool heard = false;
    while (auto message = mailbox_.receive()) {
        heard = true;
        if (message->tag == protocol::assign || message->tag == protocol::release ||
            message->tag == protocol::gather)
            worker_->handle(*message);
        else
            handle(*message);
    }
    worker_->report();
    return heard;
}

void Coordinator::handle(const Message& message) {
    Rank& rank = ranks_[index(message.source)];
    rank.last_heard = Clock::now();
    if (message.source != mailbox_.rank()) traffic_.bytes_in += message.bytes.size();
    ByteReader in(message.bytes);
    switch (message.tag) {
    case protocol::hello:
        rank.threads = in.get<std::int32_t>();
        return;
    case protocol::done:
        while (!in.at_end()) take_report(in.get<protocol::TaskReport>());
        return;
    case protocol::tiles:
        return take_tiles(message);
    case protocol::gathered:
        rank.gathering = false;
        return;
    case protocol::wish:
        if (on_wish_) on_wish_();
        return;
    case protocol::failed:
        return give_up(message.source, ": " + in.get_text());
    case protocol::beat:
        return;
    default:
        throw Error("rank " + std::to_string(message.source),
                    "sent a message that rank 0 does not know: " + std::to_string(message.tag));
    }
}

void Coordinator::take_report(const protocol::TaskReport& report) {
    const auto tile = static_cast<int>(report.tile);
    Tile& t = tiles_.at(report.tile);
    samples_ += report.samples;
    something_done_ = something_done_ || report.samples > 0;
    if (report.samples > 0) {
        if (t.seconds_per_sample > 0)
            known_seconds_ -= t.seconds_per_sample;
        else
            ++known_costs_;
        t.seconds_per_sample = std::max(report.cpu_seconds / static_cast<double>(report.samples), 1e-9);
        known_seconds_ += t.seconds_per_sample;
    }
    t.luminance = report.luminance;
    t.squared_error = report.squared_error;
    t.summed = true;
    schedule_.returned(tile, work_of(tile, report.remaining));
}

void Coordinator::take_tiles(const Message& message) {
    const std::span<Pixel> pixels = state_->film.pixels();
    for (ByteReader in(message.bytes); !in.at_end();) {
        const auto header = in.get<protocol::TilePixelsHeader>();
        Tile& t = tiles_.at(header.tile);
        const PixelBounds& bounds = bounds_[header.tile];
        if (header.pixels != pixel_count(bounds))
            throw Error("rank " + std::to_string(message.source), "sent a tile of another size");
        const auto tally = in.get<TileTally>();
        tally.add_to(state_->report);
        // Does not report the same ranks twice.
        samples_ -= std::min(samples_, tally.samples);
        something_done_ = something_done_ || tally.samples > 0;
        for_rows(state_->film.bounds(), bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            in.get_all(pixels.subspan(first, count));
        });
        const std::size_t sums = state_->film.layers().sums();
        for_rows(state_->film.bounds(), bounds, [&](std::size_t first, std::size_t count, std::size_t) {
            in.get_all(state_->film.layer_sums().subspan(first * sums, count * sums));
        });
        t.home = true;
        if (t.wanted_by == TileSchedule::no_rank) continue;
        std::vector<std::uint8_t> assignment;
        const int rank = std::exchange(t.wanted_by, TileSchedule::no_rank);
        assign(rank, static_cast<int>(header.tile), assignment);
        send(rank, protocol::assign, std::move(assignment));
    }
}

void Coordinator::gather() {
    for (int r = 0; r < mailbox_.size(); ++r)
        if (ranks_[index(r)].threads > 0 && !ranks_[index(r)].lost) {
            ranks_[index(r)].gathering = true;
            send(r, protocol::gather, {});
        }
    for (Tile& t : tiles_) t.wanted_by = TileSchedule::no_rank;
    const Clock::time_point begin = Clock::now();
    while (std::ranges::any_of(ranks_, [](const Rank& r) { return r.gathering; })) {
        if (!listen()) worker_->wait(std::chrono::microseconds(100));
        check_silence();
        const bool in_a_hurry = watch_->cancel != nullptr && watch_->cancel->requested();
        if (in_a_hurry && seconds_between(begin, Clock::now()) > settings_.patience_when_cancelled)
            for (int r = 0; r < mailbox_.size(); ++r)
                if (r != mailbox_.rank() && std::exchange(ranks_[index(r)].gathering, false))
                    left_out_.push_back(r);
    }
}

void Coordinator::check_silence() {
    const Clock::time_point now = Clock::now();
    for (int r = 0; r < mailbox_.size(); ++r) {
        Rank& rank = ranks_[index(r)];
        if (r == mailbox_.rank() || rank.lost) continue;
        const double silent = seconds_between(rank.last_heard, now);
        if (silent <= settings_.patience_seconds) continue;
        someone_is_silent_ = true;
        char text[80];
        std::snprintf(text, sizeof text, " has not answered for %.0f s; the job ends", silent);
        give_up(r, text);
    }
}

void Coordinator::give_up(int rank, const std::string& why) {
    ranks_[index(rank)].lost = true;
    ranks_[index(rank)].gathering = false;
    if (!failure_) failure_ = "rank " + std::to_string(rank) + why + "; what the others did is saved";
}

void Coordinator::report_progress() {
    last_report_ = Clock::now();
    double luminance = 0, squared_error = 0;
    bool known = true;
    for (const Tile& t : tiles_) {
        known = known && t.summed;
        luminance += t.luminance;
        squared_error += t.squared_error;
    }
    std::optional<FilmError> error;
    if (known && std::isfinite(squared_error)) {
        const auto pixels = static_cast<double>(state_->film.pixels().size());
        error = FilmError{.relative = std::sqrt(squared_error / pixels) / (luminance / pixels),
                          .mean_luminance = luminance / pixels,
                          .mean_samples = static_cast<double>(state_->report.samples + samples_) / pixels};
    }
    watch_->tell(samples_, error);
}

} // namespace montelux
