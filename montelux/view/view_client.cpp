#include "montelux/view/view_client.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/view/tile_message.h"

namespace montelux {

namespace {

namespace websocket = boost::beast::websocket;

constexpr std::size_t most_incoming = 4096;                     // bytes of a message
constexpr std::size_t most_answers = 64;                        // that wait to be sent
constexpr std::size_t values_of_message = std::size_t{1} << 18; // of tiles
constexpr std::chrono::milliseconds least_progress_interval{200};

std::size_t values_in(const std::vector<LiveTile>& tiles) {
    std::size_t values = 0;
    for (const LiveTile& tile : tiles) values += tile.values.size();
    return values;
}

} // namespace

void ViewClient::accept(const boost::beast::http::request<boost::beast::http::string_body>& upgrade) {
    // The WebSocket has timeouts of its own: pings find clients that are gone.
    boost::beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout timeout =
        websocket::stream_base::timeout::suggested(boost::beast::role_type::server);
    timeout.idle_timeout = std::chrono::seconds(60);
    socket_.set_option(timeout);
    socket_.read_message_max(most_incoming);
    socket_.auto_fragment(false); // else a frame, a copy and a system call for each 4 kB
    socket_.async_accept(upgrade, [self = shared_from_this()](boost::beast::error_code error) {
        if (error) return self->end();
        self->open_ = true;
        self->read();
        self->send_news();
    });
}

void ViewClient::end() {
    open_ = false;
    leaves_ = true;
    boost::beast::get_lowest_layer(socket_).close(); // ends what is under way
    hub_.remove(*this);
}

void ViewClient::read() {
    // One who asks and does not listen is not heard until the answers are sent.
    if (reads_ || leaves_ || answers_.size() >= most_answers) return;
    reads_ = true;
    socket_.async_read(incoming_, [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
        self->reads_ = false;
        if (error) return self->end();
        self->on_message();
        self->read();
    });
}

void ViewClient::on_message() {
    const auto bytes = incoming_.data();
    const std::string text(static_cast<const char*>(bytes.data()), bytes.size());
    incoming_.consume(incoming_.size());
    const std::optional<ViewRequest> request = socket_.got_text() ? parse_request(text) : std::nullopt;
    if (!request) {
        leaves_ = true;
        socket_.async_close(websocket::close_code::policy_error,
                            [self = shared_from_this()](boost::beast::error_code) { self->end(); });
        return;
    }
    answer(*request);
    send_news();
}

void ViewClient::answer(const ViewRequest& request) {
    ViewedRender& render = hub_.render();
    const std::shared_ptr<LivePicture> picture = render.picture();
    const auto is_inside = [&](int x, int y) {
        return picture && x < picture->bounds().width() && y < picture->bounds().height();
    };
    const auto refuse_unless_done = [&](const char* what, const auto& action) {
        try {
            action();
        } catch (const Error& e) {
            answers_.push_back(refused_message(what, e.what()));
        }
    };
    std::visit(
        Overloaded{[&](const ShowRequest& r) {
                       shown_.clear();
                       for (const std::string& layer : r.layers) shown_.push_back({layer});
                   },
                   [&](const PixelRequest& r) {
                       answers_.push_back(is_inside(r.x, r.y)
                                              ? pixel_message(*picture, r.x, r.y)
                                              : refused_message("pixel", "the picture has no such pixel"));
                   },
                   [&](const ReplayRequest& r) { answer(r); },
                   [&](const LimitsRequest& r) { render.set_limits(r.error, r.time); },
                   [&](const OrbitRequest& r) {
                       refuse_unless_done("orbit", [&] {
                           render.change({r.orbit, render.status().change.light_groups});
                       });
                   },
                   [&](const LightGroupsRequest& r) {
                       refuse_unless_done("light groups", [&] {
                           render.change({render.status().change.orbit, r.on});
                       });
                   },
                   [&](PlainRequest r) {
                       if (r == PlainRequest::pause) render.pause();
                       if (r == PlainRequest::resume) render.resume();
                       if (r == PlainRequest::stop) render.stop();
                       if (r == PlainRequest::quit && render.settings().stays) render.quit();
                       if (r == PlainRequest::quit && !render.settings().stays)
                           answers_.push_back(
                               refused_message("quit", "the program ends with its render; 'stop' ends that"));
                   }},
        request);
}

void ViewClient::answer(const ReplayRequest& r) {
    auto result = std::make_shared<std::string>();
    const auto work = [&render = hub_.render(), r, result] {
        try {
            *result = replay_message(r.x, r.y, r.sample, render.replay(r.x, r.y, r.sample));
        } catch (const std::exception& e) {
            *result = refused_message("replay", e.what());
        }
    };
    const bool accepted = hub_.run_slow(work, [self = shared_from_this(), result] {
        self->answers_.push_back(std::move(*result));
        self->send_news();
    });
    if (!accepted) answers_.push_back(refused_message("replay", "too many requests are waiting"));
}

bool ViewClient::shows_layers_of(const LivePicture& picture) const {
    return std::ranges::any_of(shown_, [&](const Shown& s) {
        const std::optional<std::size_t> layer = picture.find_layer(s.layer);
        return layer && !picture.layers()[*layer].of.empty();
    });
}

std::string ViewClient::next_tiles(bool has_budget) {
    const std::shared_ptr<LivePicture> picture = hub_.render().picture();
    for (std::size_t i = 0; picture && i < shown_.size(); ++i) {
        next_shown_ = (next_shown_ + 1) % shown_.size();
        Shown& shown = shown_[next_shown_];
        const std::optional<std::size_t> layer = picture->find_layer(shown.layer);
        if (!layer || (shown.is_whole && !has_budget)) continue;
        const std::vector<LiveTile> tiles = picture->changes_since(*layer, shown.version, values_of_message);
        shown.is_whole = shown.is_whole || values_in(tiles) < values_of_message;
        if (!tiles.empty()) return tile_message(*layer, picture->layers()[*layer], epoch_, tiles);
    }
    return {};
}

void ViewClient::send_news() {
    if (!open_ || sends_ || leaves_) return;
    const ViewedRender& render = hub_.render();
    const std::shared_ptr<LivePicture> picture = render.picture();
    const std::uint64_t version = render.status_version();
    if (picture) {
        const ViewStatus status = render.status();
        if (status.epoch != epoch_) {
            epoch_ = status.epoch;
            for (Shown& shown : shown_) shown.version = 0, shown.is_whole = false;
            return send(scene_message(hub_.introduction(), render, *picture, status), false);
        }
    }
    if (!answers_.empty()) {
        std::string answer = std::move(answers_.front());
        answers_.pop_front();
        return send(std::move(answer), false);
    }
    const auto now = std::chrono::steady_clock::now();
    const PictureStatistics* const statistics = hub_.statistics() ? &*hub_.statistics() : nullptr;
    if ((version != status_version_ || hub_.statistics_version() != statistics_version_) &&
        (is_leaving_ || now - last_progress_ >= least_progress_interval)) {
        status_version_ = version;
        statistics_version_ = hub_.statistics_version();
        last_progress_ = now;
        return send(progress_message(render.status(), statistics), false);
    }
    const bool has_budget =
        is_leaving_ || hub_.has_time_for_tiles() || render.state() != ViewState::rendering;
    const double begin = thread_cpu_seconds();
    if (std::string tiles = next_tiles(has_budget); !tiles.empty()) {
        send(std::move(tiles), true);
        return hub_.spend_on_tiles(thread_cpu_seconds() - begin);
    }
    if (!goodbye_.empty()) send(std::exchange(goodbye_, {}), false);
}

void ViewClient::send(std::string message, bool binary) {
    outgoing_ = std::move(message);
    sends_ = true;
    socket_.binary(binary);
    socket_.async_write(boost::asio::buffer(outgoing_),
                        [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
                            self->sends_ = false;
                            if (error) return self->end();
                            self->read();
                            self->send_news();
                        });
}

void ViewClient::say_goodbye(std::string message) {
    if (!open_ || leaves_) return;
    goodbye_ = std::move(message);
    is_leaving_ = true;
    send_news();
}

} // namespace montelux
