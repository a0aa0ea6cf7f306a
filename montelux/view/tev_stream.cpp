#include "montelux/view/tev_stream.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <string_view>
#include <sys/socket.h>
#include <sys/time.h>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/view/little_endian.h"

namespace montelux {

namespace {

using boost::asio::ip::tcp;

constexpr std::chrono::milliseconds interval{200};
constexpr std::size_t values_at_once = std::size_t{1} << 20;
constexpr int seconds_to_listen = 5; // of a tev that does not read

// Operations of tev's protocol.
constexpr std::uint8_t close_image = 2, create_image = 4, update_image = 6;

struct TevLayer {
    std::string_view layer;
    std::vector<std::string_view> channels;
};
const std::array<TevLayer, 2> tev_layers{{{"mean", {"R", "G", "B"}}, {"error", {"error.Y"}}}};

// The length of a packet comes first, and counts itself.
class Packet {
  public:
    explicit Packet(std::uint8_t operation) { append(bytes_, operation); }
    Packet& add(auto number) {
        append(bytes_, number);
        return *this;
    }
    Packet& add_text(std::string_view text) {
        bytes_.append(text);
        bytes_ += '\0';
        return *this;
    }
    std::string finished() const {
        std::string packet;
        append(packet, static_cast<std::uint32_t>(bytes_.size() + sizeof(std::uint32_t)));
        return packet + bytes_;
    }
    std::string& bytes() { return bytes_; }

  private:
    std::string bytes_;
};

} // namespace

class TevStream::Connection {
  public:
    explicit Connection(const std::string& where) {
        const std::size_t colon = where.rfind(':');
        if (colon == std::string::npos)
            throw Error("tev", "'" + where + "' is not HOST:PORT, such as 127.0.0.1:14158");
        boost::system::error_code error;
        std::string host = where.substr(0, colon);
        if (host.size() > 2 && host.front() == '[' && host.back() == ']')
            host = host.substr(1, host.size() - 2);
        const auto addresses = tcp::resolver(io_).resolve(host, where.substr(colon + 1), error);
        if (!error) connect(addresses, error);
        if (error)
            throw Error("tev", "nothing listens on " + where + " (" + error.message() + "); start tev first");
        const timeval timeout{seconds_to_listen, 0};
        ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout);
    }
    // False: tev is gone.
    bool send(const std::string& packet) {
        boost::system::error_code error;
        boost::asio::write(socket_, boost::asio::buffer(packet), error);
        return !error;
    }

  private:
    void connect(const tcp::resolver::results_type& addresses, boost::system::error_code& error) {
        error = boost::asio::error::host_not_found;
        for (const auto& address : addresses) {
            boost::system::error_code ignored;
            socket_.close(ignored);
            socket_.open(address.endpoint().protocol(), error);
            if (!error) socket_.connect(address.endpoint(), error);
            if (!error) return;
        }
    }

    boost::asio::io_context io_;
    tcp::socket socket_{io_};
};

TevStream::TevStream(ViewedRender& render, const std::string& where, std::string name)
    : render_(render), name_(std::move(name)), connection_(std::make_unique<Connection>(where)),
      thread_([this] { run(); }) {}

TevStream::~TevStream() {
    ends_ = true;
    thread_.join();
}

void TevStream::run() {
    try {
        send_until_the_end();
    } catch (const std::exception&) {
        // Such as too little memory for a packet: the stream ends, and the render goes on.
    }
}

void TevStream::send_until_the_end() {
    std::shared_ptr<LivePicture> shown;
    std::array<std::uint64_t, tev_layers.size()> versions{};
    const auto send_changes = [&] {
        for (std::size_t i = 0; i < tev_layers.size(); ++i) {
            const std::size_t layer = *shown->find_layer(tev_layers[i].layer);
            const auto& channels = tev_layers[i].channels;
            for (;;) {
                const std::vector<LiveTile> tiles = shown->changes_since(layer, versions[i], values_at_once);
                if (tiles.empty()) break;
                for (const LiveTile& tile : tiles) {
                    Packet packet(update_image);
                    packet.add(std::uint8_t{0})
                        .add_text(name_)
                        .add(static_cast<std::int32_t>(channels.size()));
                    for (const std::string_view channel : channels) packet.add_text(channel);
                    const PixelBounds& b = tile.bounds;
                    for (const int v : {b.x0, b.y0, b.width(), b.height()})
                        packet.add(static_cast<std::int32_t>(v));
                    for (std::size_t c = 0; c < channels.size(); ++c)
                        packet.add(static_cast<std::int64_t>(c));
                    for (std::size_t c = 0; c < channels.size(); ++c)
                        packet.add(static_cast<std::int64_t>(channels.size()));
                    for (const float v : tile.values) packet.add(v);
                    if (!connection_->send(packet.finished())) return false;
                }
            }
        }
        return true;
    };
    for (bool last = false;;) {
        if (const std::shared_ptr<LivePicture> now = render_.picture(); now && now != shown) {
            shown = now;
            versions = {};
            if (!connection_->send(Packet(close_image).add_text(name_).finished())) return;
            Packet create(create_image);
            create.add(std::uint8_t{1}).add_text(name_);
            create.add(static_cast<std::int32_t>(shown->bounds().width()));
            create.add(static_cast<std::int32_t>(shown->bounds().height()));
            std::vector<std::string_view> channels;
            for (const TevLayer& layer : tev_layers)
                channels.insert(channels.end(), layer.channels.begin(), layer.channels.end());
            create.add(static_cast<std::int32_t>(channels.size()));
            for (const std::string_view channel : channels) create.add_text(channel);
            if (!connection_->send(create.finished())) return;
        }
        if (shown && !send_changes()) return;
        if (last) return;
        last = ends_;
        if (!last) std::this_thread::sleep_for(interval);
    }
}

} // namespace montelux
