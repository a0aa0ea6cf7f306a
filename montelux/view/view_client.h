// ViewClient: one page that watches a render over a WebSocket.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "montelux/view/view_hub.h"

namespace montelux {

// At most one message is under way, the next one is made when it has been sent: a slow reader gets fewer and costs no
// memory.
class ViewClient : public std::enable_shared_from_this<ViewClient> {
  public:
    ViewClient(boost::beast::tcp_stream stream, ViewHub& hub) : socket_(std::move(stream)), hub_(hub) {}

    void accept(const boost::beast::http::request<boost::beast::http::string_body>& upgrade);
    // Sends what has changed since the last message, if none is under way.
    void send_news();
    // After what is still to be sent.
    void say_goodbye(std::string message);
    // The goodbye has been sent, or cannot be.
    bool knows() const { return !open_ || leaves_ || (goodbye_.empty() && is_leaving_ && !sends_); }
    // Whether it shows layers that a LivePicture does not compute itself.
    bool shows_layers_of(const LivePicture& picture) const;

  private:
    struct Shown {
        std::string layer;
        std::uint64_t version = 0; // of the picture, as sent
        bool is_whole = false;     // all tiles have been sent once
    };

    void read();
    void on_message();
    void answer(const ViewRequest& request);
    void answer(const ReplayRequest& request);
    void send(std::string message, bool binary);
    // The next tiles of a shown layer; empty if none has changed. What the page has not seen yet needs no budget.
    std::string next_tiles(bool has_budget);
    void end();

    boost::beast::websocket::stream<boost::beast::tcp_stream, /*deflateSupported=*/false> socket_;
    ViewHub& hub_;
    boost::beast::flat_buffer incoming_;
    std::deque<std::string> answers_;
    std::string outgoing_;
    bool sends_ = false, reads_ = false, leaves_ = false, open_ = false;
    bool is_leaving_ = false; // the goodbye is to be sent, or has been
    std::string goodbye_;
    std::vector<Shown> shown_;
    std::size_t next_shown_ = 0;
    std::uint32_t epoch_ = ~std::uint32_t{0};                   // of the scene message that was sent
    std::uint64_t status_version_ = 0, statistics_version_ = 0; // that were sent
    std::chrono::steady_clock::time_point last_progress_{};
};

} // namespace montelux
