#include "montelux/view/view_hub.h"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <utility>
#include <vector>

#include "montelux/mc/parallel/cpu_time.h"
#include "montelux/view/view_client.h"

namespace montelux {

namespace {

constexpr std::size_t most_waiting = 16, most_clients = 16;

} // namespace

bool ViewHub::run_slow(std::function<void()> work, std::function<void()> done) {
    if (waiting_ >= most_waiting) return false;
    ++waiting_;
    boost::asio::post(pool_, [this, work = std::move(work), done = std::move(done),
                              guard = boost::asio::make_work_guard(io_)] {
        try {
            work();
        } catch (const std::exception&) {
            // Such as too little memory for a copy: pages keep what they have, and the render goes on.
        }
        boost::asio::post(io_, [this, done] {
            --waiting_;
            done();
        });
    });
    return true;
}

bool ViewHub::is_full() const { return clients_.size() >= most_clients; }
void ViewHub::remove(const ViewClient& client) {
    std::erase_if(clients_, [&](const std::shared_ptr<ViewClient>& c) { return c.get() == &client; });
}

void ViewHub::tick() {
    render_.poll();
    if (clients_.empty()) return;
    if (const std::shared_ptr<LivePicture> picture = render_.picture()) {
        refresh_statistics(picture);
        refresh_layers(picture);
    }
    const std::vector<std::shared_ptr<ViewClient>> now(clients_.begin(),
                                                       clients_.end()); // one may be removed
    for (const std::shared_ptr<ViewClient>& client : now) client->send_news();
}

void ViewHub::say_goodbye(std::string_view why) {
    const std::vector<std::shared_ptr<ViewClient>> now(clients_.begin(), clients_.end());
    for (const std::shared_ptr<ViewClient>& client : now) client->say_goodbye(goodbye_message(why));
}

bool ViewHub::all_know() const {
    return std::ranges::all_of(clients_,
                               [](const std::shared_ptr<ViewClient>& client) { return client->knows(); });
}

bool ViewHub::may_run(const Repeated& repeated) {
    return std::chrono::steady_clock::now() >= repeated.next &&
           repeated.budget.allows_work(process_cpu_seconds());
}

void ViewHub::repeat(Repeated& repeated, std::function<void()> work, std::function<void()> done) {
    const auto seconds = std::make_shared<double>();
    repeated.runs = run_slow(
        [seconds, work = std::move(work)] {
            const double begin = thread_cpu_seconds();
            work();
            *seconds = thread_cpu_seconds() - begin;
        },
        [seconds, &repeated, done = std::move(done)] {
            done();
            repeated.budget.spend(*seconds, process_cpu_seconds());
            repeated.next = std::chrono::steady_clock::now() + repeated.interval;
            repeated.runs = false;
        });
}

void ViewHub::refresh_statistics(const std::shared_ptr<LivePicture>& picture) {
    if (statistics_of_.lock() != picture) { // the render was restarted
        statistics_.reset();
        statistics_of_ = picture;
        statistics_work_.version = 0;
    }
    const std::uint64_t version = picture->version();
    const bool is_still = render_.status().state != ViewState::rendering;
    if (statistics_work_.runs || version == statistics_work_.version ||
        (!is_still && !may_run(statistics_work_)))
        return;
    const ToneCurve curve{introduction_.exposure.value_or(0), introduction_.tone};
    const auto result = std::make_shared<PictureStatistics>();
    repeat(
        statistics_work_, [=] { *result = statistics_of(picture->pixels(), curve); },
        [=, this] {
            if (statistics_of_.lock() == picture) {
                statistics_ = *result;
                statistics_work_.version = version;
            }
        });
}

// A picture with all layers while it is rendered, if someone looks at them. At other times it has them anyway.
void ViewHub::refresh_layers(const std::shared_ptr<LivePicture>& picture) {
    const bool wanted = std::ranges::any_of(clients_, [&](const std::shared_ptr<ViewClient>& client) {
        return client->shows_layers_of(*picture);
    });
    if (!wanted || layers_work_.runs || render_.status().state != ViewState::rendering ||
        !may_run(layers_work_))
        return;
    repeat(
        layers_work_,
        [=, this] {
            if (std::optional<RenderSnapshot> now = render_.snapshot(0.5);
                now && render_.picture() == picture)
                picture->update_others(now->image);
        },
        [] {});
}

} // namespace montelux
