// ViewServer: which requests it answers, and how; hostile ones change nothing.
#include "test/view/view_testing.h"
#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstring>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/view/view_server.h"

namespace montelux::testing {
namespace {

using boost::asio::ip::tcp;
using namespace std::chrono_literals;
using Json = nlohmann::json;

// A long render that is served, and ends with the test.
class ViewServerTest : public ::testing::Test {
  protected:
    ViewServerTest()
        : session_(viewed_scene(1u << 20), {}), render_({}), server_(std::in_place, render_, settings()),
          thread_([this] { render_.run(session_, {}); }) {
        const std::string url = server_->url(); // http://127.0.0.1:PORT/?token=TOKEN
        const std::size_t port = url.find(':', 7) + 1;
        port_ = static_cast<std::uint16_t>(std::stoi(url.substr(port)));
        token_ = url.substr(url.find('=') + 1);
        host_ = "127.0.0.1:" + std::to_string(port_);
        while (render_.status().progress.samples_done == 0) std::this_thread::sleep_for(1ms);
    }
    ~ViewServerTest() override { end(); }

    static ViewServerSettings settings() {
        ViewServerSettings s;
        s.introduction.name = "room";
        return s;
    }
    void end() {
        render_.stop();
        if (thread_.joinable()) thread_.join();
        server_.reset();
    }

    // While no samples are taken, connections need not wait for their share of the time.
    void pause() {
        render_.pause();
        while (render_.state() != ViewState::paused) std::this_thread::sleep_for(1ms);
    }

    tcp::socket connected() {
        tcp::socket socket(io_);
        socket.connect({boost::asio::ip::make_address("127.0.0.1"), port_});
        return socket;
    }
    // What comes until the connection is closed.
    static std::string rest_of(tcp::socket& socket) {
        std::string answer;
        boost::system::error_code error;
        boost::asio::read(socket, boost::asio::dynamic_buffer(answer), error);
        return answer;
    }
    std::string answer_to(const std::string& request) {
        tcp::socket socket = connected();
        boost::system::error_code error;
        boost::asio::write(socket, boost::asio::buffer(request), error);
        return rest_of(socket);
    }
    std::string get(const std::string& target, const std::string& more = "",
                    const std::string& method = "GET") {
        return answer_to(method + " " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + more + "\r\n");
    }
    std::string with_token(const std::string& path) const { return path + "?token=" + token_; }

    using Socket = boost::beast::websocket::stream<tcp::socket>;
    std::unique_ptr<Socket> watching() {
        auto socket = std::make_unique<Socket>(connected());
        socket->handshake(host_, with_token("/live"));
        return socket;
    }
    // The next message of a type; tiles are "tiles".
    static Json next(Socket& socket, const std::string& type) {
        for (int i = 0; i < 1000; ++i) {
            boost::beast::flat_buffer buffer;
            socket.read(buffer);
            const std::string text(static_cast<const char*>(buffer.data().data()), buffer.size());
            if (socket.got_binary() && type == "tiles") return text.size();
            if (socket.got_binary()) continue;
            Json json = Json::parse(text);
            if (json["type"] == type) return json;
        }
        return {};
    }
    static void ask(Socket& socket, const std::string& text) {
        socket.text(true);
        socket.write(boost::asio::buffer(text));
    }

    boost::asio::io_context io_;
    RenderSession session_;
    ViewedRender render_;
    std::optional<ViewServer> server_;
    std::thread thread_;
    std::uint16_t port_ = 0;
    std::string token_, host_;
};

bool is(const std::string& answer, int status) {
    return answer.starts_with("HTTP/1.1 " + std::to_string(status) + " ");
}

TEST_F(ViewServerTest, AnswersWhoKnowsTheToken) {
    pause();
    EXPECT_TRUE(is(get(with_token("/")), 200));
    EXPECT_TRUE(is(get("/page/main.js"), 200));
    EXPECT_TRUE(is(get("/"), 403));
    EXPECT_TRUE(is(get("/?token="), 403));
    EXPECT_TRUE(is(get("/?token=" + std::string(32, '0')), 403));
    EXPECT_TRUE(is(get("/live"), 403));
    EXPECT_TRUE(is(get("/picture.exr"), 403));
    EXPECT_TRUE(is(get(with_token("/live")), 426));
    const std::string page = get(with_token("/"));
    EXPECT_NE(page.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
    EXPECT_NE(page.find("Referrer-Policy: no-referrer"), std::string::npos);
    const std::string head = get(with_token("/"), "", "HEAD");
    EXPECT_TRUE(is(head, 200));
    EXPECT_TRUE(head.ends_with("\r\n\r\n"));
}

TEST_F(ViewServerTest, PathsLeadNowhereElse) {
    pause();
    for (const char* path :
         {"/page/", "/page/../view_server.cpp", "/page/..%2f..%2fetc/passwd", "/page//etc/passwd",
          "/../../../etc/passwd", "/etc/passwd", "/page/main.js/", "/page/%6dain.js", "//", "/live/"})
        EXPECT_TRUE(is(get(with_token(path)), 404)) << path;
}

TEST_F(ViewServerTest, OtherSitesAreRefused) {
    pause();
    const auto from = [&](const std::string& host, const std::string& more) {
        return answer_to("GET " + with_token("/") + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n");
    };
    EXPECT_TRUE(is(from(host_, ""), 200));
    EXPECT_TRUE(is(from("localhost:" + std::to_string(port_), ""), 200));
    EXPECT_TRUE(is(from("rebound.example:" + std::to_string(port_), ""), 403));
    EXPECT_TRUE(is(from("rebound.example", ""), 403));
    EXPECT_TRUE(is(from(host_, "Origin: http://" + host_ + "\r\n"), 200));
    EXPECT_TRUE(is(from(host_, "Origin: http://evil.example\r\n"), 403));
    EXPECT_TRUE(is(from(host_, "Origin: null\r\n"), 403));
    EXPECT_TRUE(is(from(host_, "Host: " + host_ + "\r\n"), 403)); // two of them
    EXPECT_TRUE(is(answer_to("GET " + with_token("/") + " HTTP/1.1\r\n\r\n"), 403));
    const std::string upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    EXPECT_TRUE(is(get(with_token("/live"), upgrade + "Origin: http://evil.example\r\n"), 403));
    EXPECT_TRUE(is(get("/live?token=0", upgrade), 403));
}

TEST_F(ViewServerTest, RequestsThatAreNoneAreRefused) {
    pause();
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH"})
        EXPECT_TRUE(is(get(with_token("/"), "", method), 405)) << method;
    EXPECT_TRUE(is(get(with_token("/"), "Content-Length: 104857600\r\n", "POST"), 413));
    EXPECT_TRUE(is(get("/" + std::string(100000, 'a')), 431));
    EXPECT_TRUE(is(get(with_token("/picture.png") + "&exposure=1e9"), 400));
    EXPECT_TRUE(is(get(with_token("/picture.png") + "&exposure=nan"), 400));
    EXPECT_TRUE(is(get(with_token("/picture.png") + "&tone=no"), 400));
    for (const char* garbage : {"\r\n\r\n", "GET\r\n\r\n", "\x16\x03\x01\x02", "GET / HTTP/9.9\r\n\r\n"})
        EXPECT_EQ(answer_to(garbage).find("HTTP/1.1 200"), std::string::npos);
    EXPECT_TRUE(is(get(with_token("/")), 200));
}

TEST_F(ViewServerTest, PicturesAreFiles) {
    const std::string exr = get(with_token("/picture.exr"));
    ASSERT_TRUE(is(exr, 200));
    EXPECT_EQ(exr.substr(exr.find("\r\n\r\n") + 4, 4), "\x76\x2f\x31\x01");
    EXPECT_NE(exr.find("attachment; filename=\"picture.exr\""), std::string::npos);
    const std::string png = get(with_token("/picture.png") + "&exposure=1.5&tone=agx");
    ASSERT_TRUE(is(png, 200));
    EXPECT_EQ(png.substr(png.find("\r\n\r\n") + 4, 4), "\x89PNG");
}

TEST_F(ViewServerTest, PagesAreToldWhatHappens) {
    const auto socket = watching();
    const Json scene = next(*socket, "scene");
    EXPECT_EQ(scene["name"], "room");
    EXPECT_EQ(scene["width"], 40);
    EXPECT_EQ(scene["layers"][0]["name"], "mean");
    EXPECT_EQ(scene["can_orbit"], false);
    ask(*socket, R"({"type":"show","layers":["mean","depth","no such"]})");
    EXPECT_GT(next(*socket, "tiles"), 40 * 24 * 6);
    ask(*socket, R"({"type":"pixel","x":20,"y":12})");
    const Json pixel = next(*socket, "pixel");
    EXPECT_EQ(pixel["mean"].size(), 3u);
    EXPECT_GT(pixel["samples"], 0);
    ask(*socket, R"({"type":"pixel","x":40,"y":12})");
    EXPECT_EQ(next(*socket, "refused")["request"], "pixel");
    ask(*socket, R"({"type":"replay","x":20,"y":12,"sample":3})");
    EXPECT_GT(next(*socket, "replay")["lines"].size(), 10u);
    ask(*socket, R"({"type":"orbit","azimuth":20,"elevation":12,"zoom":1})");
    EXPECT_EQ(next(*socket, "refused")["request"], "orbit");
    ask(*socket, R"({"type":"quit"})");
    EXPECT_EQ(next(*socket, "refused")["request"], "quit");
    ask(*socket, R"({"type":"pause"})");
    while (next(*socket, "progress")["state"] != "paused") continue;
    ask(*socket, R"({"type":"pixel","x":20,"y":12})");
    EXPECT_TRUE(next(*socket, "pixel")["layers"].contains("depth"));
    ask(*socket, R"({"type":"resume"})");
    while (next(*socket, "progress")["state"] != "rendering") continue;
    ask(*socket, R"({"type":"target","error":0.5,"time":100})");
    while (next(*socket, "progress")["target_error"] != 0.5) continue;
}

// The picture has 40 columns and 24 rows.
TEST_F(ViewServerTest, PixelsOutsideOfThePictureAreRefused) {
    const auto socket = watching();
    const auto is_answered = [&](int x, int y) {
        const auto ask_for = [&](int column, int row) {
            ask(*socket, Json{{"type", "pixel"}, {"x", column}, {"y", row}}.dump());
        };
        ask_for(x, y);
        ask_for(0, 0); // answers keep the order of the requests
        const Json first = next(*socket, "pixel");
        const bool answered = first["x"] == x && first["y"] == y;
        if (answered) next(*socket, "pixel");
        return answered;
    };
    EXPECT_TRUE(is_answered(39, 23));
    EXPECT_FALSE(is_answered(39, 24));
    EXPECT_FALSE(is_answered(40, 23));
    EXPECT_TRUE(is_answered(0, 23));
    EXPECT_FALSE(is_answered(0, 39));
    EXPECT_FALSE(is_answered(24, 1000));
}

TEST_F(ViewServerTest, ManyWatchAndTheLastHearGoodbye) {
    const auto a = watching(), b = watching();
    { const auto gone = watching(); } // closed without a word
    ask(*a, R"({"type":"show","layers":["mean"]})");
    ask(*b, R"({"type":"show","layers":["error"]})");
    EXPECT_GT(next(*a, "tiles"), 0);
    EXPECT_GT(next(*b, "tiles"), 0);
    std::thread ending([this] { end(); });
    EXPECT_EQ(next(*a, "goodbye")["why"], "the program has ended");
    EXPECT_EQ(next(*b, "goodbye")["type"], "goodbye");
    ending.join();
}

TEST_F(ViewServerTest, MalformedMessagesEndTheirConnectionAlone) {
    const auto good = watching();
    for (const std::string& text :
         {std::string("{"), std::string(R"({"type":"no such"})"), std::string(5000, 'x')}) {
        const auto bad = watching();
        ask(*bad, text);
        boost::system::error_code error;
        for (int i = 0; i < 1000 && !error; ++i) {
            boost::beast::flat_buffer buffer;
            bad->read(buffer, error);
        }
        EXPECT_TRUE(error) << text.substr(0, 20);
    }
    { // frames that are none
        tcp::socket raw = connected();
        const std::string request =
            "GET " + with_token("/live") + " HTTP/1.1\r\nHost: " + host_ +
            "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
        boost::asio::write(raw, boost::asio::buffer(request));
        std::string head;
        boost::asio::read_until(raw, boost::asio::dynamic_buffer(head), "\r\n\r\n");
        EXPECT_NE(head.find("101 Switching"), std::string::npos);
        const std::array<unsigned char, 10> frame{0xff, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
        boost::asio::write(raw, boost::asio::buffer(frame));
        rest_of(raw); // which ends
    }
    ask(*good, R"({"type":"pixel","x":1,"y":1})");
    EXPECT_EQ(next(*good, "pixel")["x"], 1);
}

// Silent connections are closed for new ones, beyond a number of them.
TEST_F(ViewServerTest, SilentConnectionsDoNotLockOthersOut) {
    pause();
    std::vector<tcp::socket> silent;
    for (int i = 0; i < 160; ++i) silent.push_back(connected());
    EXPECT_TRUE(is(get(with_token("/")), 200));
    const auto socket = watching();
    EXPECT_EQ(next(*socket, "scene")["type"], "scene");
}

// One who asks without reading costs no memory: it is not heard any more.
TEST_F(ViewServerTest, SlowReadersAreNotHeard) {
    const auto slow = watching();
    ask(*slow, R"({"type":"show","layers":["mean","error","samples","relative error"]})");
    slow->next_layer().non_blocking(true);
    const std::string request = R"({"type":"pixel","x":1,"y":1})";
    boost::system::error_code error;
    std::size_t sent = 0;
    for (const auto begin = std::chrono::steady_clock::now();
         std::chrono::steady_clock::now() - begin < 20s;) {
        slow->write(boost::asio::buffer(request), error);
        if (error) break;
        ++sent;
    }
    EXPECT_EQ(error, boost::asio::error::would_block) << sent; // the buffers of the system are full
    const auto other = watching();
    EXPECT_EQ(next(*other, "scene")["type"], "scene");
}

// Who connects again and again gets a share of the program's time, and the page its turn.
TEST_F(ViewServerTest, ConnectionsDoNotTakeTheRendersTime) {
    const double begin = process_cpu_seconds();
    int connections = 0;
    while (process_cpu_seconds() < begin + 1) {
        tcp::socket socket = connected();
        boost::asio::write(socket, boost::asio::buffer("GET / HTTP/1.1\r\n\r\n", 18));
        rest_of(socket);
        ++connections;
    }
    EXPECT_LT(connections, 240); // of 90 microseconds and more, for which there are 0.02 s
    EXPECT_TRUE(is(get(with_token("/")), 200));
}

TEST(ViewServer, AddressesThatCannotBeServedAreErrors) {
    ViewedRender render({});
    EXPECT_THROW(ViewServer(render, {.address = "localhost"}), Error);
    EXPECT_THROW(ViewServer(render, {.address = "203.0.113.7"}), Error);
    const ViewServer server(render, {});
    const std::string url = server.url();
    const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.find(':', 7) + 1)));
    EXPECT_THROW(ViewServer(render, {.port = port}), Error);
}

} // namespace
} // namespace montelux::testing
