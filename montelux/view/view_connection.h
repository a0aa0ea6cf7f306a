// ViewConnection: one connection to the viewer's server, until it has its answer or becomes a ViewClient.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "montelux/view/view_hub.h"

namespace montelux {

class ViewConnection : public std::enable_shared_from_this<ViewConnection> {
  public:
    // `ended` is called once, when the connection is closed or handed over.
    ViewConnection(boost::asio::ip::tcp::socket socket, ViewHub& hub,
                   std::function<void(const ViewConnection&)> ended)
        : stream_(std::move(socket)), hub_(hub), ended_(std::move(ended)) {}

    void read();
    // Ends it without an answer.
    void close();
    // The whole request has been read.
    bool has_request() const { return has_request_; }

  private:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;

    void on_request();
    void upgrade();
    void send_picture(bool exr);
    void reply(boost::beast::http::status status, std::string_view content_type, std::string body,
               std::string_view file_name = {});
    void refuse(boost::beast::http::status status, std::string_view sentence);
    void end();
    bool is_own_request() const;

    boost::beast::tcp_stream stream_;
    ViewHub& hub_;
    std::function<void(const ViewConnection&)> ended_;
    boost::beast::flat_buffer buffer_;
    std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
    Request request_;
    bool has_request_ = false;
};

} // namespace montelux
