#include "montelux/cluster/coordinator.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "montelux/cluster/run_beside.h"
#include "montelux/cluster/tile_worker.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

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

// Calls f(part) for what the pixels of a tile hold, in the order of messages: rows of pixels, then of sums of layers, then
// of buckets.
template <typename AnyFilm, typename F>
void for_contents(AnyFilm& film, const PixelBounds& tile, const F& f) {
    const auto rows = [&](auto all, std::size_t per_pixel) {
        for_rows(film.bounds(), tile, [&](std::size_t first, std::size_t count, std::size_t) {
            f(all.subspan(first * per_pixel, count * per_pixel));
        });
    };
    rows(film.pixels(), 1);
    rows(film.layer_sums(), film.layers().sums());
    rows(film.buckets(), film.buckets_per_pixel());
}

} // namespace

Coordinator::Coordinator(Mailbox& mailbox, const PixelBounds& crop, const CoordinatorSettings& settings,
                         std::function<void()> on_wish)
    : settings_(settings), roster_(mailbox, settings.patience_seconds, std::move(on_wish)),
      bounds_(tiles_of(crop, settings.tile_size)), tiles_(bounds_.size()), ranks_(index(mailbox.size())),
      schedule_(mailbox.size(), static_cast<int>(bounds_.size())), chains_(roster_, settings.threads),
      guide_(roster_) {}

Coordinator::~Coordinator() { end(); }

void Coordinator::release() {
    worker_.reset();
    chains_.release();
}

void Coordinator::end() {
    if (std::exchange(ended_, true)) return;
    release();
    for (int r = 1; r < roster_.size(); ++r) roster_.send(r, protocol::end, {});
}

double Coordinator::work_of(int tile, std::uint64_t samples) const {
    double cost = tiles_[index(tile)].seconds_per_sample;
    if (!(cost > 0)) cost = known_costs_ > 0 ? known_seconds_ / known_costs_ : 1e-6;
    return static_cast<double>(samples) * cost;
}

std::uint32_t Coordinator::step_of(int tile) const {
    if (state_->splats) return ~std::uint32_t{0};
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
    if (state_->splats) { // all pixels are here
        for (Tile& t : tiles_) {
            t.holder = TileSchedule::no_rank;
            t.home = true;
        }
        schedule_ = TileSchedule(roster_.size(), static_cast<int>(tiles_.size()));
    }
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
    roster_.begin_listening();
    if (!worker_)
        worker_ = std::make_unique<TileWorker>(renderer, bounds_, settings_.threads, roster_.mailbox());
    guide_.set(state.guide);
    begin_round();
    std::chrono::microseconds pause = shortest_poll;
    while (!schedule_.finished() && !failed() && !watch.stop(something_done_)) {
        deal();
        const bool heard = listen();
        roster_.watch();
        if (seconds_between(last_report_, Clock::now()) > 0.2) report_progress();
        pause = heard ? shortest_poll : std::min(2 * pause, longest_poll);
        if (!heard) worker_->wait(pause);
    }
    gather();
    roster_.end_listening();
}

void Coordinator::run(ChainRenderer& chains, RenderState& state, std::uint32_t target_samples,
                      const ChainWatch& watch) {
    chains_.run(chains, state, target_samples, watch);
}

void Coordinator::meanwhile(const std::function<void()>& work, const std::function<void()>& between) {
    roster_.begin_listening();
    run_beside([&] { with_threads(settings_.threads, work); }, longest_poll,
               [&] {
                   listen();
                   roster_.watch();
                   between();
               });
    roster_.end_listening();
}

void Coordinator::deal() {
    for (int r = 0; r < roster_.size(); ++r) {
        if (!guide_.is_known_to(r)) continue;
        std::vector<std::uint8_t> message;
        while (schedule_.in_work(r) < tasks_a_thread * roster_.threads(r)) {
            const auto pick = schedule_.next(r);
            if (!pick) break;
            Tile& t = tiles_[index(*pick)];
            if (t.holder != r && t.holder != TileSchedule::no_rank) ++moved_tiles_;
            if (t.home || t.holder == r) {
                assign(r, *pick, message);
                if (message.size() >= message_bytes)
                    roster_.send(r, protocol::assign, std::exchange(message, {}));
                continue;
            }
            t.wanted_by = r;
            ByteWriter out;
            out.put(static_cast<std::uint32_t>(*pick));
            // The holder forgets the tile, even if the round ends before the tile reaches the rank that needs
            // it.
            roster_.send(std::exchange(t.holder, TileSchedule::no_rank), protocol::release, out.take());
        }
        if (!message.empty()) roster_.send(r, protocol::assign, std::move(message));
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
    if (a.pixels == Assignment::Pixels::follow)
        for_contents(std::as_const(state_->film), bounds, [&](auto part) { out.put_all(part); });
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
    while (auto message = roster_.receive()) {
        heard = true;
        if (message->tag == protocol::assign || message->tag == protocol::release ||
            message->tag == protocol::gather)
            worker_->handle(*message);
        else
            handle(*message);
    }
    if (worker_) worker_->report();
    return heard;
}

void Coordinator::handle(const Message& message) {
    Rank& rank = ranks_[index(message.source)];
    switch (message.tag) {
    case protocol::done:
        for (ByteReader in(message.bytes); !in.at_end();) take_report(in.get<protocol::TaskReport>());
        return;
    case protocol::tiles:
        if (!state_->splats) return take_tiles(message);
        [[fallthrough]];
    case protocol::splats:
    case protocol::splat_counts:
    case protocol::bias:
        if (rank.gathering) rank.staged.push_back(message);
        return;
    case protocol::gathered:
        // An answer to an earlier request came too late: its tiles were dealt out again.
        if (!message.bytes.empty() && ByteReader(message.bytes).get<std::uint32_t>() != gatherings_) {
            rank.staged.clear();
            return;
        }
        take_staged(rank);
        rank.gathering = false;
        return;
    case protocol::guide_taken:
        return guide_.piece_taken(message);
    case protocol::hello:
        return guide_.greet(message.source);
    case protocol::wish:
    case protocol::failed:
    case protocol::beat:
        return;
    default:
        throw Error("rank " + std::to_string(message.source),
                    "sent a message that rank 0 does not know: " + std::to_string(message.tag));
    }
}

void Coordinator::take_staged(Rank& rank) {
    for (const Message& message : std::exchange(rank.staged, {}))
        message.tag == protocol::tiles ? take_tiles(message) : take_splats(message);
}

void Coordinator::take_splats(const Message& message) {
    ByteReader in(message.bytes);
    SplatFilm& splats = *state_->splats;
    if (message.tag == protocol::bias) {
        SplatFilm& open = state_->bias.value().open();
        SplatFilm part(open.bounds());
        in.get_all(part.sums());
        const auto counts = in.get<protocol::SplatCounts>();
        part.set_counts(counts.bad, counts.overflows);
        return open.merge(part);
    }
    if (message.tag == protocol::splat_counts) {
        const auto counts = in.get<protocol::SplatCounts>();
        splats.set_counts(splats.bad() + counts.bad, splats.overflows() + counts.overflows);
        return;
    }
    std::vector<std::int64_t> row;
    while (!in.at_end()) {
        const PixelBounds& tile = bounds_.at(in.get<std::uint32_t>());
        row.resize(6 * index(tile.width()));
        for (int y = tile.y0; y < tile.y1; ++y) {
            in.get_all(std::span(row));
            splats.merge_row(tile.x0, y, row);
        }
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
        for_contents(state_->film, bounds, [&](auto part) { in.get_all(part); });
        t.home = true;
        if (t.wanted_by == TileSchedule::no_rank) continue;
        std::vector<std::uint8_t> assignment;
        const int rank = std::exchange(t.wanted_by, TileSchedule::no_rank);
        assign(rank, static_cast<int>(header.tile), assignment);
        roster_.send(rank, protocol::assign, std::move(assignment));
    }
}

bool Coordinator::is_gathering(int rank) const {
    return ranks_[index(rank)].gathering && roster_.takes_part(rank);
}

void Coordinator::gather() {
    ++gatherings_;
    for (int r = 0; r < roster_.size(); ++r) {
        ranks_[index(r)] = {.gathering = roster_.takes_part(r)};
        if (!ranks_[index(r)].gathering) continue;
        ByteWriter out;
        out.put(gatherings_);
        roster_.send(r, protocol::gather, out.take());
    }
    for (Tile& t : tiles_) t.wanted_by = TileSchedule::no_rank;
    const Clock::time_point begin = Clock::now();
    const auto someone_gathers = [this] {
        for (int r = 0; r < roster_.size(); ++r)
            if (is_gathering(r)) return true;
        return false;
    };
    while (someone_gathers()) {
        if (!listen()) worker_->wait(std::chrono::microseconds(100));
        roster_.watch();
        const bool in_a_hurry = watch_->cancel != nullptr && watch_->cancel->requested();
        if (in_a_hurry && seconds_between(begin, Clock::now()) > settings_.patience_when_cancelled)
            for (int r = 0; r < roster_.size(); ++r)
                if (!roster_.is_leader(r) && is_gathering(r)) {
                    ranks_[index(r)] = {};
                    left_out_.push_back(r);
                }
    }
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
