#include "montelux/view/view_server.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <list>
#include <optional>
#include <thread>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/view/view_connection.h"
#include "montelux/view/view_hub.h"
#include "montelux/view/work_budget.h"

namespace montelux {

namespace {

using boost::asio::ip::tcp;

// Beyond it the oldest one is closed, rather one that has not yet asked for anything. Pages that watch do not count.
constexpr std::size_t most_connections = 128;
constexpr std::chrono::milliseconds tick_interval{50}, pause_after_failure{100};
constexpr std::chrono::seconds time_for_goodbyes{1};
// That wait to be accepted: while attacks fill them, a page needs some luck; afterwards they are soon gone.
constexpr int most_waiting_connections = 128;
// Of the program's CPU time while it renders. Beyond this many seconds the thread did other work meanwhile.
constexpr double share_of_connections = 0.02, most_for_connection = 1e-3;
constexpr std::chrono::milliseconds pause_without_budget{5};

} // namespace

class ViewServer::Implementation {
  public:
    Implementation(ViewedRender& render, const ViewServerSettings& settings)
        : hub_(io_, render, settings.introduction), acceptor_(io_), timer_(io_), retry_(io_) {
        listen(settings);
        accept();
        tick();
        thread_ = std::thread([this] { run(); });
    }
    ~Implementation() {
        boost::asio::post(io_, [this] { hub_.say_goodbye("the program has ended"); });
        const auto deadline = std::chrono::steady_clock::now() + time_for_goodbyes;
        boost::asio::post(io_, [this, deadline] { leave(deadline); });
        thread_.join();
        hub_.close();
    }
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    std::string url() const {
        const tcp::endpoint at = acceptor_.local_endpoint();
        std::string host = at.address().to_string();
        if (at.address().is_v6()) host = "[" + host + "]";
        return "http://" + host + ":" + std::to_string(at.port()) + "/?token=" + hub_.access().token();
    }

  private:
    void run() {
        for (;;) {
            try {
                io_.run();
                return;
            } catch (const std::exception&) {
                // Such as too little memory for a message: that one is lost, and the render goes on.
            }
        }
    }

    void listen(const ViewServerSettings& settings) {
        boost::system::error_code error;
        const auto address = boost::asio::ip::make_address(settings.address, error);
        if (error) throw Error("view", "'" + settings.address + "' is not an IP address, such as 127.0.0.1");
        const tcp::endpoint endpoint(address, settings.port);
        acceptor_.open(endpoint.protocol(), error);
        if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
        if (!error) acceptor_.bind(endpoint, error);
        if (!error) acceptor_.listen(most_waiting_connections, error);
        if (error)
            throw Error("view", settings.address + ":" + std::to_string(settings.port) +
                                    " cannot be served: " + error.message());
    }

    void accept() {
        acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
            if (error == boost::asio::error::operation_aborted) return;
            if (error)
                return accept_after(pause_after_failure); // others will be closed: files may be used up
            add(std::move(socket));
            const double cpu = thread_cpu_seconds();
            connections_budget_.spend(
                std::min(cpu - std::exchange(cpu_at_connection_, cpu), most_for_connection),
                process_cpu_seconds());
            accept_within_budget();
        });
    }
    void accept_after(std::chrono::milliseconds pause) {
        retry_.expires_after(pause);
        retry_.async_wait([this](boost::system::error_code stopped) {
            if (!stopped) accept_within_budget();
        });
    }
    void accept_within_budget() {
        if (hub_.render().state() == ViewState::rendering &&
            !connections_budget_.allows_work(process_cpu_seconds()))
            return accept_after(pause_without_budget);
        accept();
    }

    void add(tcp::socket socket) {
        const auto connection =
            std::make_shared<ViewConnection>(std::move(socket), hub_, [this](const ViewConnection& ended) {
                std::erase_if(connections_, [&](const auto& c) { return c.get() == &ended; });
            });
        connections_.push_back(connection);
        if (connections_.size() > most_connections) {
            const auto silent =
                std::ranges::find_if(connections_, [](const auto& c) { return !c->has_request(); });
            const auto oldest = silent != connections_.end() ? silent : connections_.begin();
            (*oldest)->close();
            connections_.erase(oldest);
        }
        connection->read();
    }

    void tick() {
        timer_.expires_after(tick_interval);
        timer_.async_wait([this](boost::system::error_code stopped) {
            if (stopped) return;
            hub_.tick();
            tick();
        });
    }

    // Stops the thread once all pages know, or at the deadline.
    void leave(std::chrono::steady_clock::time_point deadline) {
        boost::system::error_code ignored;
        acceptor_.close(ignored);
        if (!hub_.all_know() && std::chrono::steady_clock::now() < deadline) {
            retry_.expires_after(std::chrono::milliseconds(10));
            retry_.async_wait([this, deadline](boost::system::error_code) { leave(deadline); });
            return;
        }
        io_.stop();
    }

    boost::asio::io_context io_{1};
    ViewHub hub_;
    tcp::acceptor acceptor_;
    boost::asio::steady_timer timer_, retry_;
    std::list<std::shared_ptr<ViewConnection>> connections_;
    WorkBudget connections_budget_{share_of_connections};
    double cpu_at_connection_ = 0; // of the thread
    std::thread thread_;
};

ViewServer::ViewServer(ViewedRender& render, const ViewServerSettings& settings)
    : implementation_(std::make_unique<Implementation>(render, settings)) {}
ViewServer::~ViewServer() = default;

std::string ViewServer::url() const { return implementation_->url(); }

} // namespace montelux
