// ViewHub: what the connections of the viewer's server share. All members are for the server's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/view/picture_statistics.h"
#include "montelux/view/view_access.h"
#include "montelux/view/view_messages.h"
#include "montelux/view/viewed_render.h"
#include "montelux/view/work_budget.h"

namespace montelux {

class ViewClient;

class ViewHub {
  public:
    ViewHub(boost::asio::io_context& io, ViewedRender& render, ViewIntroduction introduction)
        : render_(render), introduction_(std::move(introduction)), access_(ViewAccess::new_token()), io_(io) {
    }
    ViewHub(const ViewHub&) = delete;
    ViewHub& operator=(const ViewHub&) = delete;

    ViewedRender& render() { return render_; }
    const ViewIntroduction& introduction() const { return introduction_; }
    const ViewAccess& access() const { return access_; }
    // Of the picture, as it was a moment ago; empty before the first ones.
    const std::optional<PictureStatistics>& statistics() const { return statistics_; }
    std::uint64_t statistics_version() const { return statistics_work_.version; }

    // Runs `work` on another thread, then `done` on this one, also if `work` throws. Work is done one after the other. Returns false, and does
    // nothing, if too much is waiting.
    bool run_slow(std::function<void()> work, std::function<void()> done);

    // There are as many clients as may be.
    bool is_full() const;
    void add(const std::shared_ptr<ViewClient>& client) { clients_.push_back(client); }
    void remove(const ViewClient& client);

    // Whether tiles may be sent to pages that have the whole picture, and the CPU time that it took. Pages share a budget.
    bool has_time_for_tiles() const { return tiles_budget_.allows_work(process_cpu_seconds()); }
    void spend_on_tiles(double seconds) { tiles_budget_.spend(seconds, process_cpu_seconds()); }

    // Several times a second: sends what is new, and computes what is missing.
    void tick();
    // The last message to all, and whether all have been sent it.
    void say_goodbye(std::string_view why);
    bool all_know() const;
    // Waits for slow work.
    void close() { pool_.join(); }

  private:
    // Work that is repeated while the picture changes: seldom enough to cost little.
    struct Repeated {
        WorkBudget budget;
        std::chrono::milliseconds interval; // the least one
        std::chrono::steady_clock::time_point next{};
        bool runs = false;
        std::uint64_t version = 0; // of the picture when it ran last
    };
    static bool may_run(const Repeated& repeated);
    void refresh_statistics(const std::shared_ptr<LivePicture>& picture);
    void refresh_layers(const std::shared_ptr<LivePicture>& picture);
    // As run_slow, on the work's budget.
    void repeat(Repeated& repeated, std::function<void()> work, std::function<void()> done);

    ViewedRender& render_;
    ViewIntroduction introduction_;
    ViewAccess access_;
    boost::asio::io_context& io_;
    boost::asio::thread_pool pool_{1};
    std::size_t waiting_ = 0; // slow work
    std::list<std::shared_ptr<ViewClient>> clients_;
    std::optional<PictureStatistics> statistics_;
    std::weak_ptr<const LivePicture> statistics_of_;
    Repeated statistics_work_{WorkBudget(0.005), std::chrono::milliseconds(250)},
        layers_work_{WorkBudget(0.005), std::chrono::milliseconds(500)};
    WorkBudget tiles_budget_{0.01};
};

} // namespace montelux
