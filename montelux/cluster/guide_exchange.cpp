#include "montelux/cluster/guide_exchange.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "montelux/cluster/protocol.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::uint64_t guide_piece = std::uint64_t{1} << 20;

} // namespace

GuideSender::GuideSender(RankRoster& roster)
    : roster_(roster), ranks_(static_cast<std::size_t>(roster.size())) {}

void GuideSender::set(const std::shared_ptr<const GuidingField>& guide) {
    if (guide == guide_) return;
    guide_ = guide;
    ByteWriter out;
    if (guide) guide->save(out);
    bytes_ = out.take();
    for (int r = 0; r < roster_.size(); ++r) {
        ranks_[static_cast<std::size_t>(r)] = {};
        if (!roster_.is_leader(r) && roster_.takes_part(r)) send_piece(r);
    }
}

void GuideSender::greet(int rank) {
    if (!guide_ || roster_.is_leader(rank)) return;
    ranks_[static_cast<std::size_t>(rank)] = {};
    send_piece(rank);
}

void GuideSender::send_piece(int rank) {
    Rank& r = ranks_[static_cast<std::size_t>(rank)];
    r.waits = true;
    const std::uint64_t size = std::min(guide_piece, bytes_.size() - r.sent);
    ByteWriter out;
    out.put(protocol::GuidePiece{r.sent, bytes_.size()});
    out.put_all(std::span<const std::uint8_t>(bytes_).subspan(r.sent, size));
    r.sent += size;
    roster_.send(rank, protocol::guide, out.take());
}

void GuideSender::piece_taken(const Message& message) {
    Rank& r = ranks_[static_cast<std::size_t>(message.source)];
    if (!r.waits)
        throw Error("rank " + std::to_string(message.source), "has taken a guide that was not sent");
    if (r.sent < bytes_.size())
        send_piece(message.source);
    else
        r.waits = false;
}

void GuideReceiver::take(const Message& piece, Mailbox& mailbox,
                         const std::function<void(std::shared_ptr<const GuidingField>)>& use) {
    ByteReader in(piece.bytes, "guide");
    const auto head = in.get<protocol::GuidePiece>();
    if (head.first == 0) bytes_.clear();
    if (head.first != bytes_.size() || in.remaining() > head.size - head.first)
        throw Error("guide", "a piece of it is missing");
    bytes_.resize(head.first + in.remaining());
    in.get_all(std::span(bytes_).subspan(head.first));
    if (bytes_.size() == head.size) {
        ByteReader whole(bytes_, "guide");
        use(head.size == 0 ? nullptr : std::make_shared<const GuidingField>(GuidingField::load(whole)));
        bytes_ = std::vector<std::uint8_t>(); // {} would keep the memory
    }
    mailbox.send(leading_rank, protocol::guide_taken, {});
}

} // namespace montelux
