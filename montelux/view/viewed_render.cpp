#include "montelux/view/viewed_render.h"

#include <chrono>
#include <cmath>

#include "montelux/mc/math/error.h"
#include "montelux/render/sample_record_text.h"

namespace montelux {

namespace {

// Points beyond this number are thinned out, all alike.
constexpr std::size_t most_points = 512;

void add_point(std::vector<std::pair<double, double>>& curve, std::pair<double, double> point) {
    if (curve.size() >= most_points) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < curve.size(); i += 2) curve[kept++] = curve[i];
        curve.resize(kept);
    }
    curve.push_back(point);
}

// The error that the target limits: only that says when it is met.
std::optional<double> limited_error(const RenderProgress& p) {
    if (!p.error) return std::nullopt;
    const double error = p.quantile ? p.quantile->error : p.error->relative;
    return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

} // namespace

template <typename F>
void ViewedRender::request(const F& f) {
    const std::lock_guard lock(mutex_);
    f();
    ++status_.version;
    if (is_interrupted()) cancel_.request();
    changed_.notify_all();
}

void ViewedRender::pause() {
    request([&] { paused_ = true; });
}
void ViewedRender::resume() {
    request([&] { paused_ = stopped_ = false; });
}
void ViewedRender::stop() {
    request([&] { stopped_ = true; });
}
void ViewedRender::quit() {
    request([&] { quit_ = true; });
}
void ViewedRender::set_limits(double error, double time) {
    request([&] {
        RenderTarget target = new_target_.value_or(status_.target);
        target.error = error;
        target.time = time;
        if (target != status_.target) new_target_ = target;
    });
}
void ViewedRender::change(const ViewChange& change) {
    if (!settings_.restart) throw Error("this render cannot be restarted; 'montelux view' can");
    request([&] {
        if (change != status_.change) new_change_ = change;
    });
}
void ViewedRender::poll() {
    if (!is_cancelled()) return;
    cancel_.request();
    changed_.notify_all();
}

ViewStatus ViewedRender::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}
std::uint64_t ViewedRender::status_version() const {
    const std::lock_guard lock(mutex_);
    return status_.version;
}
ViewState ViewedRender::state() const {
    const std::lock_guard lock(mutex_);
    return status_.state;
}
std::shared_ptr<LivePicture> ViewedRender::picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
}
void ViewedRender::set_state(ViewState state) {
    const std::lock_guard lock(mutex_);
    status_.state = state;
    ++status_.version;
}

// A new session: a new picture, and for a restart a new epoch.
void ViewedRender::open(RenderSession& session) {
    set_state(ViewState::preparing);
    session.prepare();
    const FilmSettings& film = session.description().film;
    auto picture =
        std::make_shared<LivePicture>(film.crop, session.replicate_size(),
                                      film_layers_of(session.description()).channels(), settings_.reference);
    {
        const std::unique_lock alone(session_mutex_);
        session_ = &session;
    }
    const std::lock_guard lock(mutex_);
    if (picture_) ++status_.epoch;
    picture_ = std::move(picture);
    status_.target = session.settings().target;
    status_.progress = {};
    status_.curve.clear();
    status_.ended_by.reset();
    still_.reset();
    stopped_ = false;
    ++status_.version;
}

void ViewedRender::watch(const RenderProgress& progress, const ProgressCallback& other) {
    RenderProgress told = progress;
    {
        const std::lock_guard lock(mutex_);
        status_.progress = progress;
        const std::optional<double> error = limited_error(progress);
        if (error && (status_.curve.empty() || status_.curve.back().second != *error))
            add_point(status_.curve, {progress.seconds, *error});
        ++status_.version;
        // The end of a run is not the end of the render.
        if (is_interrupted() && !stopped_ && !quit_ && !is_cancelled()) told.ended = false;
    }
    if (other) other(told);
}

RenderSession& ViewedRender::run(RenderSession& first, const RenderCompany& company) {
    RenderSession* session = &first;
    open(first);
    RenderCompany watched = company;
    watched.keep_open = true;
    watched.cancel = &cancel_;
    watched.progress = [&](const RenderProgress& p) { watch(p, company.progress); };
    watched.tile = [&](const FinishedTile& tile) {
        picture()->update(tile);
        if (company.tile) company.tile(tile);
    };
    for (;;) {
        bool renders = false;
        {
            const std::lock_guard lock(mutex_);
            renders = !is_interrupted();
            if (renders) {
                cancel_.reset();
                status_.state = ViewState::rendering;
                status_.ended_by.reset();
                still_.reset();
                ++status_.version;
            }
        }
        RenderReport report;
        report.stop = RenderStop::cancelled;
        if (renders) {
            session->render(watched);
            report = session->report();
        }
        switch (wait(*session, report)) {
        case Next::go_on:
            break;
        case Next::leave:
            return *session;
        case Next::restart: {
            ViewChange change;
            {
                const std::lock_guard lock(mutex_);
                change = status_.change = *std::exchange(new_change_, std::nullopt);
            }
            {
                const std::unique_lock alone(session_mutex_);
                session_ = nullptr;
            }
            session = &settings_.restart(change);
            open(*session);
            break;
        }
        }
    }
}

// Between two runs of the render: what follows.
ViewedRender::Next ViewedRender::wait(RenderSession& session, const RenderReport& report) {
    using namespace std::chrono_literals;
    for (bool shown = false;;) {
        std::unique_lock lock(mutex_);
        const bool ended = stopped_ || report.stop != RenderStop::cancelled;
        if (new_change_ && !is_cancelled() && !quit_) return Next::restart;
        if (new_target_) {
            const RenderTarget target = *std::exchange(new_target_, std::nullopt);
            lock.unlock();
            const std::unique_lock alone(session_mutex_);
            session.set_target(target);
            lock.lock();
            status_.target = target;
            ++status_.version;
            // All samples were taken: other limits change nothing.
            if (report.stop != RenderStop::samples) {
                stopped_ = false;
                if (!paused_) return Next::go_on;
            }
            continue;
        }
        if (is_cancelled() || quit_ || (ended && !settings_.stays)) {
            status_.state = ViewState::ended;
            status_.ended_by = report.stop;
            ++status_.version;
            lock.unlock();
            const std::unique_lock alone(session_mutex_);
            session_ = nullptr;
            return Next::leave;
        }
        if (!ended && !paused_) return Next::go_on;
        if (!shown) { // all layers, before the state changes: a client that reads the new state finds them
            lock.unlock();
            RenderSnapshot still = session.picture();
            const std::shared_ptr<LivePicture> picture = this->picture();
            picture->update(still.image);
            lock.lock();
            still_ = std::move(still);
            shown = true;
            ++status_.version;
            continue;
        }
        if (const ViewState state = ended ? ViewState::ended : ViewState::paused; status_.state != state) {
            status_.state = state;
            ++status_.version;
        }
        if (ended) {
            status_.ended_by = report.stop;
            paused_ = false;
        }
        changed_.wait_for(lock, 100ms);
    }
}

void ViewedRender::show(const RenderSnapshot& finished) {
    if (const std::shared_ptr<LivePicture> live = picture()) live->update(finished.image);
    const std::lock_guard lock(mutex_);
    still_ = finished;
    ++status_.version;
}

std::optional<RenderSnapshot> ViewedRender::snapshot(double seconds) {
    {
        const std::lock_guard lock(mutex_);
        if (still_) return still_;
    }
    const std::shared_lock shared(session_mutex_);
    if (session_ == nullptr) return std::nullopt;
    return session_->snapshot(seconds);
}

std::string ViewedRender::replay(int x, int y, std::uint64_t index) {
    const std::shared_lock shared(session_mutex_);
    if (session_ == nullptr) throw Error("there is no render at this moment");
    const PixelBounds& crop = session_->description().film.crop;
    return sample_record_text(session_->renderer().replay(crop.x0 + x, crop.y0 + y, index),
                              session_->description());
}

} // namespace montelux
