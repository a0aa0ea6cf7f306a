#include "montelux/cluster/shared_integrand.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <thread>
#include <utility>

#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using Clock = std::chrono::steady_clock;
enum Tag : int { hello = 101, points, values, alive, wish, end };
constexpr std::chrono::seconds alive_interval{1};
// Polls less often while nothing happens, to leave the processor to evaluating threads.
constexpr std::chrono::microseconds shortest_pause{20}, longest_pause{1000};
// Limit on threads that wait for other ranks, which cost memory and time to wake.
constexpr int most_callers = 512;

// Points that were sent, and their results.
struct Job {
    std::uint64_t number = 0;
    PointBuffer x;
};

// The threads of a rank that helps.
class EvaluationThreads {
  public:
    EvaluationThreads(const BatchFunction& f, int components, int threads) : f_(f), components_(components) {
        for (int t = 0; t < threads; ++t) threads_.emplace_back([this] { run(); });
    }
    ~EvaluationThreads() {
        {
            std::lock_guard lock(mutex_);
            closing_ = true;
        }
        jobs_there_.notify_all();
        for (std::thread& t : threads_) t.join();
    }
    EvaluationThreads(const EvaluationThreads&) = delete;
    EvaluationThreads& operator=(const EvaluationThreads&) = delete;

    void add(Job job) {
        {
            std::lock_guard lock(mutex_);
            jobs_.push_back(std::move(job));
        }
        jobs_there_.notify_one();
    }
    // Ready messages to the leader; waits at most this long for one.
    std::vector<std::vector<std::uint8_t>> answers(std::chrono::microseconds longest) {
        std::unique_lock lock(mutex_);
        answers_there_.wait_for(lock, longest, [this] { return !answers_.empty(); });
        return std::exchange(answers_, {});
    }

  private:
    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            jobs_there_.wait(lock, [this] { return closing_ || !jobs_.empty(); });
            if (closing_) return;
            const Job job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            std::vector<std::uint8_t> answer = answer_to(job);
            lock.lock();
            answers_.push_back(std::move(answer));
            answers_there_.notify_one();
        }
    }
    std::vector<std::uint8_t> answer_to(const Job& job) const {
        ByteWriter out;
        out.put(job.number);
        ValueBuffer y(job.x.count(), components_);
        std::string error;
        try {
            f_(job.x, y);
        } catch (const std::exception& e) {
            error = e.what();
        }
        out.put_text(error);
        if (error.empty())
            for (int c = 0; c < components_; ++c) out.put_all(std::as_const(y).component(c));
        return out.take();
    }

    const BatchFunction& f_;
    int components_;
    std::mutex mutex_;
    std::condition_variable jobs_there_, answers_there_;
    std::deque<Job> jobs_;
    std::vector<std::vector<std::uint8_t>> answers_;
    bool closing_ = false;
    std::vector<std::thread> threads_;
};

} // namespace

SharedIntegrand::SharedIntegrand(Mailbox& mailbox, BatchFunction f, int components, int threads,
                                 double patience_seconds)
    : mailbox_(mailbox), f_(std::move(f)), components_(components), patience_seconds_(patience_seconds),
      ranks_(static_cast<std::size_t>(mailbox.size())), free_here_(threads) {
    ranks_.front().threads = threads;
    for (Rank& r : ranks_) r.last_heard = Clock::now();
    while (std::any_of(ranks_.begin() + 1, ranks_.end(), [](const Rank& r) { return r.threads == 0; })) {
        if (!listen({})) std::this_thread::sleep_for(longest_pause);
        check_silence();
        if (failure_) throw Error("integrate", *failure_);
    }
    for (const Rank& r : ranks_) callers_ = std::min(callers_ + r.threads, most_callers);
}

SharedIntegrand::~SharedIntegrand() {
    for (int r = 1; r < mailbox_.size(); ++r) mailbox_.send(r, end, {});
}

void SharedIntegrand::operator()(const PointBatch& x, ValueBatch y) {
    std::unique_lock lock(mutex_);
    if (free_here_ > 0 || mailbox_.size() == 1) {
        --free_here_;
        lock.unlock();
        try {
            f_(x, y);
        } catch (...) {
            lock.lock();
            ++free_here_;
            throw;
        }
        lock.lock();
        ++free_here_;
        return;
    }
    if (failure_) throw Error("integrate", *failure_);
    Request request;
    request.x = &x;
    request.y = y;
    const std::uint64_t number = next_++;
    open_.emplace(number, &request);
    unsent_.push_back(number);
    asked_.notify_one();
    answered_.wait(lock, [&] { return request.done; });
    if (!request.error.empty()) throw Error("integrate", request.error);
}

void SharedIntegrand::lead(const std::function<void()>& work, const std::function<void()>& on_wish) {
    std::exception_ptr thrown;
    bool over = false;
    std::thread worker([&] {
        try {
            work();
        } catch (...) {
            thrown = std::current_exception();
        }
        std::lock_guard lock(mutex_);
        over = true;
        asked_.notify_one();
    });
    std::chrono::microseconds pause = shortest_pause;
    for (;;) {
        const bool heard = listen(on_wish), sent = send_requests();
        check_silence();
        say_alive();
        pause = heard || sent ? shortest_pause : std::min(2 * pause, longest_pause);
        std::unique_lock lock(mutex_);
        if (over) break;
        asked_.wait_for(lock, pause, [&] { return over || !unsent_.empty(); });
    }
    worker.join();
    if (thrown) std::rethrow_exception(thrown);
}

bool SharedIntegrand::listen(const std::function<void()>& on_wish) {
    bool heard = false;
    while (auto message = mailbox_.receive()) {
        heard = true;
        Rank& rank = ranks_.at(static_cast<std::size_t>(message->source));
        rank.last_heard = Clock::now();
        if (message->tag == hello)
            rank.threads = std::max(1, ByteReader(message->bytes).get<std::int32_t>());
        else if (message->tag == values)
            take_values(*message);
        else if (message->tag == wish && on_wish)
            on_wish();
    }
    return heard;
}

// To the rank with the least work per thread.
bool SharedIntegrand::send_requests() {
    bool sent = false;
    std::unique_lock lock(mutex_);
    for (; !unsent_.empty() && !failure_; sent = true) {
        const std::uint64_t number = unsent_.front();
        unsent_.pop_front();
        Request& request = *open_.at(number);
        const auto least =
            std::min_element(ranks_.begin() + 1, ranks_.end(), [](const Rank& a, const Rank& b) {
                return static_cast<std::int64_t>(a.in_hand) * b.threads <
                       static_cast<std::int64_t>(b.in_hand) * a.threads;
            });
        ++least->in_hand;
        request.rank = static_cast<int>(least - ranks_.begin());
        ByteWriter out;
        out.put(number);
        out.put(static_cast<std::uint64_t>(request.x->count()));
        out.put(static_cast<std::int32_t>(request.x->dimensions()));
        for (int d = 0; d < request.x->dimensions(); ++d) out.put_all(request.x->coordinate(d));
        mailbox_.send(request.rank, points, out.take());
    }
    return sent;
}

void SharedIntegrand::take_values(const Message& message) {
    ByteReader in(message.bytes);
    const auto number = in.get<std::uint64_t>();
    std::lock_guard lock(mutex_);
    --ranks_.at(static_cast<std::size_t>(message.source)).in_hand;
    const auto open = open_.find(number);
    if (open == open_.end()) return; // the batch was given up
    Request& request = *open->second;
    request.error = in.get_text();
    if (request.error.empty())
        for (int c = 0; c < components_; ++c) in.get_all(request.y.component(c));
    request.done = true;
    open_.erase(open);
    answered_.notify_all();
}

void SharedIntegrand::check_silence() {
    const Clock::time_point now = Clock::now();
    for (std::size_t r = 1; r < ranks_.size(); ++r) {
        const double silent = std::chrono::duration<double>(now - ranks_[r].last_heard).count();
        if (silent <= patience_seconds_) continue;
        char text[96];
        std::snprintf(text, sizeof text, "rank %zu has not answered for %.0f s; the job ends", r, silent);
        fail(text);
    }
}

// A step may have no batch for the others.
void SharedIntegrand::say_alive() {
    const Clock::time_point now = Clock::now();
    if (now - last_said_ < alive_interval) return;
    last_said_ = now;
    for (int r = 1; r < mailbox_.size(); ++r) mailbox_.send(r, alive, {});
}

void SharedIntegrand::fail(const std::string& why) {
    std::lock_guard lock(mutex_);
    if (!failure_) failure_ = why;
    unsent_.clear();
    for (auto& [number, request] : open_) {
        request->error = *failure_;
        request->done = true;
    }
    open_.clear();
    answered_.notify_all();
}

void serve_integrand(Mailbox& mailbox, const BatchFunction& f, int components, int threads,
                     const CancelFlag* cancel, double patience_seconds) {
    EvaluationThreads helpers(f, components, threads);
    ByteWriter out;
    out.put(static_cast<std::int32_t>(threads));
    mailbox.send(leading_rank, hello, out.take());
    Clock::time_point last_heard = Clock::now(), last_sent = last_heard;
    std::chrono::microseconds pause = shortest_pause;
    bool cancel_sent = false;
    for (;;) {
        bool heard = false;
        while (auto message = mailbox.receive()) {
            heard = true;
            if (message->tag == end) return;
            if (message->tag != points) continue;
            ByteReader in(message->bytes);
            Job job;
            job.number = in.get<std::uint64_t>();
            const auto count = in.get<std::uint64_t>();
            job.x.resize(count, in.get<std::int32_t>());
            for (int d = 0; d < job.x.dimensions(); ++d) in.get_all(job.x.coordinate(d));
            helpers.add(std::move(job));
        }
        pause = heard ? shortest_pause : std::min(2 * pause, longest_pause);
        const auto answers = helpers.answers(pause);
        for (const auto& answer : answers) mailbox.send(leading_rank, values, answer);
        const Clock::time_point now = Clock::now();
        if (heard) last_heard = now;
        if (!answers.empty()) last_sent = now;
        if (now - last_sent >= alive_interval) {
            mailbox.send(leading_rank, alive, {});
            last_sent = now;
        }
        if (!cancel_sent && cancel != nullptr && cancel->requested()) {
            mailbox.send(leading_rank, wish, {});
            cancel_sent = true;
        }
        if (std::chrono::duration<double>(now - last_heard).count() > patience_seconds)
            throw Error("rank " + std::to_string(mailbox.rank()),
                        "rank 0, which leads the integration, has been silent for too long");
    }
}

} // namespace montelux
