#include "montelux/view/view_connection.h"

#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "montelux/image/exposure.h"
#include "montelux/view/page_files.h"
#include "montelux/view/picture_download.h"
#include "montelux/view/view_client.h"

namespace montelux {

namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t most_header = 8192; // bytes
constexpr std::chrono::seconds time_to_ask{10}, time_to_listen{60};

std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

// Empty: not a number within the bounds of exposures. An empty text is 0.
std::optional<float> exposure_of(std::string_view text) {
    float value = 0;
    if (text.empty()) return value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !(value >= least_exposure && value <= most_exposure))
        return std::nullopt;
    return value;
}

} // namespace

void ViewConnection::read() {
    parser_.emplace();
    parser_->header_limit(most_header);
    parser_->body_limit(0);
    stream_.expires_after(time_to_ask);
    http::async_read(
        stream_, buffer_, *parser_, [self = shared_from_this()](boost::beast::error_code error, std::size_t) {
            if (error == http::error::header_limit)
                return self->refuse(http::status::request_header_fields_too_large, "the header is too long");
            if (error == http::error::body_limit)
                return self->refuse(http::status::payload_too_large, "requests have no body here");
            if (error) return self->end();
            self->has_request_ = true;
            self->request_ = self->parser_->release();
            self->on_request();
        });
}

bool ViewConnection::is_own_request() const {
    boost::beast::error_code error;
    const auto local = stream_.socket().local_endpoint(error);
    if (error || request_.count(http::field::host) != 1) return false;
    const std::string_view host = view(request_[http::field::host]);
    if (!is_own_host(host, local.address().to_string(), local.port(), local.address().is_loopback()))
        return false;
    return request_.find(http::field::origin) == request_.end() ||
           is_own_origin(view(request_[http::field::origin]), host);
}

void ViewConnection::on_request() {
    if (!is_own_request())
        return refuse(http::status::forbidden, "the Host or Origin of the request is not this viewer");
    if (request_.method() != http::verb::get && request_.method() != http::verb::head)
        return refuse(http::status::method_not_allowed, "only GET and HEAD are answered");
    const std::string_view target = view(request_.target()), path = path_of(target);
    constexpr std::string_view folder = "/page/";
    if (path.starts_with(folder)) {
        const PageFile* const file = find_page_file(path.substr(folder.size()));
        if (file == nullptr) return refuse(http::status::not_found, "there is no such page");
        return reply(http::status::ok, file->content_type, std::string(file->bytes));
    }
    const bool is_known = path == "/" || path == "/live" || path == "/picture.exr" || path == "/picture.png";
    if (!is_known) return refuse(http::status::not_found, "there is no such page");
    if (!hub_.access().knows_token(query_value(target, "token")))
        return refuse(
            http::status::forbidden,
            "the token of the address is missing or wrong; open the whole address that montelux printed");
    if (path == "/live") return upgrade();
    if (path == "/picture.exr" || path == "/picture.png") return send_picture(path.ends_with("exr"));
    const PageFile* const index = find_page_file("index.html");
    reply(http::status::ok, index->content_type, std::string(index->bytes));
}

void ViewConnection::upgrade() {
    if (!boost::beast::websocket::is_upgrade(request_))
        return refuse(http::status::upgrade_required, "this address is for WebSockets");
    if (buffer_.size() > 0) return refuse(http::status::bad_request, "nothing may follow before the answer");
    if (hub_.is_full())
        return refuse(http::status::service_unavailable,
                      "too many pages watch this render; close one of them");
    const auto client = std::make_shared<ViewClient>(std::move(stream_), hub_);
    hub_.add(client);
    client->accept(request_);
    end();
}

void ViewConnection::send_picture(bool exr) {
    const std::string_view target = view(request_.target());
    const std::optional<float> exposure = exposure_of(query_value(target, "exposure"));
    const std::string_view tone_name = query_value(target, "tone");
    const std::optional<ToneKind> tone = tone_name.empty() ? ToneKind::srgb : tone_named(tone_name);
    if (!exposure || !tone)
        return refuse(http::status::bad_request, "exposure or tone is not a value of this viewer");
    struct Result {
        std::string bytes, failure;
    };
    auto result = std::make_shared<Result>();
    const auto work = [&render = hub_.render(), exr, curve = ToneCurve{*exposure, *tone}, result] {
        try {
            const std::optional<RenderSnapshot> now = render.snapshot(2);
            if (!now)
                result->failure = "there is no picture yet";
            else
                result->bytes = exr ? exr_bytes(*now) : png_bytes(*now, curve);
        } catch (const std::exception& e) {
            result->failure = e.what();
        }
    };
    stream_.expires_never();
    const bool accepted = hub_.run_slow(work, [self = shared_from_this(), result, exr] {
        if (!result->failure.empty()) return self->refuse(http::status::service_unavailable, result->failure);
        self->reply(http::status::ok, exr ? "image/x-exr" : "image/png", std::move(result->bytes),
                    exr ? "picture.exr" : "picture.png");
    });
    if (!accepted) refuse(http::status::service_unavailable, "too many requests are waiting");
}

void ViewConnection::refuse(http::status status, std::string_view sentence) {
    reply(status, "text/plain; charset=utf-8", std::string(sentence) + "\n");
}

void ViewConnection::reply(http::status status, std::string_view content_type, std::string body,
                           std::string_view file_name) {
    const auto response = std::make_shared<http::response<http::string_body>>(status, 11);
    const auto set = [&](auto field, std::string_view value) {
        response->set(field, boost::beast::string_view(value.data(), value.size()));
    };
    set(http::field::content_type, content_type);
    set(http::field::cache_control, "no-store");
    set("Referrer-Policy", "no-referrer"); // the address has the token
    set("X-Content-Type-Options", "nosniff");
    set("Cross-Origin-Resource-Policy", "same-origin");
    if (content_type.starts_with("text/html")) {
        const std::string host(view(request_[http::field::host]));
        set("Content-Security-Policy",
            "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws://" + host +
                "; base-uri 'none'; form-action 'none'");
    }
    if (!file_name.empty())
        set(http::field::content_disposition, "attachment; filename=\"" + std::string(file_name) + "\"");
    if (status == http::status::method_not_allowed) set(http::field::allow, "GET, HEAD");
    response->keep_alive(false);
    const auto length = body.size();
    if (request_.method() != http::verb::head) response->body() = std::move(body);
    response->content_length(length);
    stream_.expires_after(time_to_listen);
    http::async_write(
        stream_, *response, [self = shared_from_this(), response](boost::beast::error_code, std::size_t) {
            boost::beast::error_code ignored;
            self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
            self->end();
        });
}

void ViewConnection::end() {
    if (ended_) std::exchange(ended_, nullptr)(*this);
}

void ViewConnection::close() { stream_.close(); }

} // namespace montelux
