#include "montelux/cluster/rank_roster.h"

#include <cstdio>
#include <utility>

#include "montelux/mc/io/byte_stream.h"

namespace montelux {
namespace {

constexpr std::chrono::seconds time_between_beats{5};

} // namespace

RankRoster::RankRoster(Mailbox& mailbox, double patience_seconds, std::function<void()> on_wish)
    : mailbox_(mailbox), patience_seconds_(patience_seconds), on_wish_(std::move(on_wish)),
      ranks_(index(mailbox.size())) {}

int RankRoster::threads() const {
    int threads = 0;
    for (const Rank& r : ranks_) threads += r.threads;
    return threads;
}

void RankRoster::send(int rank, protocol::Tag tag, std::vector<std::uint8_t> bytes) {
    ++traffic_.messages;
    if (!is_leader(rank)) traffic_.bytes_out += bytes.size();
    mailbox_.send(rank, tag, std::move(bytes));
}

std::optional<Message> RankRoster::receive() {
    std::optional<Message> message = mailbox_.receive();
    if (message) note(*message);
    return message;
}

void RankRoster::note(const Message& message) {
    Rank& rank = ranks_[index(message.source)];
    rank.last_heard = Clock::now();
    if (!is_leader(message.source)) traffic_.bytes_in += message.bytes.size();
    ByteReader in(message.bytes);
    switch (message.tag) {
    case protocol::hello:
        rank.threads = in.get<std::int32_t>();
        return;
    case protocol::wish:
        if (on_wish_) on_wish_();
        return;
    case protocol::failed:
        return give_up(message.source, ": " + in.get_text());
    default:
        return;
    }
}

void RankRoster::begin_listening() {
    const Clock::time_point now = Clock::now();
    for (Rank& r : ranks_) r.last_heard = paused_ ? r.last_heard + (now - *paused_) : now;
    last_beat_ = now;
}

void RankRoster::end_listening() { paused_ = Clock::now(); }

void RankRoster::watch() {
    const Clock::time_point now = Clock::now();
    const bool beats = now - last_beat_ >= time_between_beats;
    if (beats) last_beat_ = now;
    for (int r = 0; r < size(); ++r) {
        Rank& rank = ranks_[index(r)];
        if (is_leader(r) || rank.lost) continue;
        if (beats && takes_part(r)) send(r, protocol::beat, {});
        const double silent = std::chrono::duration<double>(now - rank.last_heard).count();
        if (silent <= patience_seconds_) continue;
        someone_is_silent_ = true;
        char text[80];
        std::snprintf(text, sizeof text, " has not answered for %.0f s; the job ends", silent);
        give_up(r, text);
    }
}

void RankRoster::give_up(int rank, const std::string& why) {
    ranks_[index(rank)].lost = true;
    if (!failure_) failure_ = "rank " + std::to_string(rank) + why + "; what the others did is saved";
}

} // namespace montelux
