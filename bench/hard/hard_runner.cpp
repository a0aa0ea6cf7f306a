#include "bench/hard/hard_runner.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <optional>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"

namespace montelux::bench {

bool HardRun::within(double errors) const {
    const double off = std::abs(run.answer.value - run.exact);
    return off <= errors * run.answer.error + accuracy * std::abs(run.exact);
}

HardRun run_hard_one(const HardProblem& problem, const Method& method, const Request& request) {
    HardRun done;
    done.run = run_one(method, problem, request);
    done.run.seed = problem.seed();
    done.dimensions = problem.dimensions();
    done.accuracy = problem.accuracy();
    done.parameters = problem.parameters();
    return done;
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t memory_limit = rlim_t{8} << 30;

// The runs of a plan, counted through.
struct Index {
    std::size_t family, method, goal;
    std::uint64_t seed;
};

std::size_t count(const HardPlan& plan) {
    return plan.families.size() * plan.seeds * plan.methods.size() * plan.goals.size();
}

Index index_of(const HardPlan& plan, std::size_t number) {
    Index index;
    index.goal = number % plan.goals.size();
    number /= plan.goals.size();
    index.method = number % plan.methods.size();
    number /= plan.methods.size();
    index.seed = plan.first_seed + number % plan.seeds;
    index.family = number / plan.seeds;
    return index;
}

void set_index(HardRun& done, const Index& index) {
    done.run.line = index.family;
    done.run.method = index.method;
    done.run.goal = index.goal;
    done.run.seed = index.seed;
}

// A line of text between processes: fields separated by tabs.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
    return text;
}

std::string serialised(std::size_t number, const HardRun& done) {
    const Run& run = done.run;
    std::array<char, 400> numbers;
    std::snprintf(numbers.data(), numbers.size(), "R\t%zu\t%a\t%a\t%d\t%d\t%d\t%a\t%llu\t%a\t%d\t%a", number,
                  run.answer.value, run.answer.error, run.answer.converged, run.answer.warned,
                  run.answer.out_of_time, run.exact, static_cast<unsigned long long>(run.evaluations),
                  run.cpu_seconds, done.dimensions, done.accuracy);
    std::string line = numbers.data();
    for (const std::string* text :
         {&run.answer.chosen, &run.answer.reason, &run.answer.warnings, &run.failure, &done.parameters})
        line += "\t" + one_line(*text);
    return line + "\n";
}

HardRun parsed(const std::vector<std::string>& fields) {
    HardRun done;
    Run& run = done.run;
    auto number = [&](std::size_t i) { return std::strtod(fields[i].c_str(), nullptr); };
    run.answer.value = number(2);
    run.answer.error = number(3);
    run.answer.converged = fields[4] == "1";
    run.answer.warned = fields[5] == "1";
    run.answer.out_of_time = fields[6] == "1";
    run.exact = number(7);
    run.evaluations = std::strtoull(fields[8].c_str(), nullptr, 10);
    run.cpu_seconds = number(9);
    done.dimensions = std::atoi(fields[10].c_str());
    done.accuracy = number(11);
    run.answer.chosen = fields[12];
    run.answer.reason = fields[13];
    run.answer.warnings = fields[14];
    run.failure = fields[15];
    done.parameters = fields[16];
    return done;
}

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields(1);
    for (char c : line) {
        if (c == '\t')
            fields.emplace_back();
        else
            fields.back() += c;
    }
    return fields;
}

// Runs [first, last) in this process, which then ends; each is announced before it begins.
[[noreturn]] void serve(const HardPlan& plan, std::size_t first, std::size_t last, int to) {
    setpgid(0, 0); // with whatever a method starts, so that both can be ended together
    std::signal(SIGINT, SIG_IGN);
#ifndef __SANITIZE_ADDRESS__ // whose shadow memory is larger
    const rlimit memory{memory_limit, memory_limit};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const ThreadLimit one(1);
    std::FILE* out = fdopen(to, "w");
    std::optional<HardProblem> problem;
    std::size_t family = 0;
    for (std::size_t number = first; number < last; ++number) {
        const Index index = index_of(plan, number);
        std::fprintf(out, "B\t%zu\n", number);
        std::fflush(out);
        if (!problem || family != index.family || problem->seed() != index.seed)
            problem.emplace(*plan.families[family = index.family], index.seed);
        Request request;
        request.relative_error = plan.goals[index.goal].relative_error;
        request.evaluations = plan.goals[index.goal].evaluations;
        request.seed = hash_key(index.seed, index.goal) >> 32;
        request.seconds = plan.seconds;
        const HardRun done = run_hard_one(*problem, plan.methods[index.method], request);
        std::fputs(serialised(number, done).c_str(), out);
        std::fflush(out);
    }
    std::fclose(out);
    _exit(0);
}

// A process that serves a chunk of the runs.
struct Server {
    pid_t process;
    int from;
    std::size_t at, last; // the run in progress, or the next; the end of the chunk
    Clock::time_point since;
    std::string text; // the beginning of a line

    Server(const HardPlan& plan, std::size_t first, std::size_t end)
        : at(first), last(end), since(Clock::now()) {
        std::array<int, 2> ends;
        if (pipe(ends.data()) != 0) throw Error("bench-hard", "no pipe could be made");
        process = fork();
        if (process < 0) throw Error("bench-hard", "no process could be started");
        if (process == 0) {
            close(ends[0]);
            serve(plan, first, end, ends[1]);
        }
        close(ends[1]);
        from = ends[0];
        setpgid(process, process);
    }
    ~Server() {
        close(from);
        kill(-process, SIGKILL);
        waitpid(process, nullptr, 0);
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
};

class Pool {
  public:
    Pool(const HardPlan& plan, const HardProgress& progress)
        : plan_(plan), progress_(progress), runs_(count(plan)), done_(runs_.size(), false) {
        const std::size_t chunk =
            plan.methods.size() * plan.goals.size() * std::min<std::uint64_t>(4, plan.seeds);
        for (std::size_t first = 0; first < runs_.size(); first += chunk)
            chunks_.emplace_back(first, std::min(first + chunk, runs_.size()));
    }

    std::vector<HardRun> run(const CancelFlag* cancel) {
        while (!(cancel && cancel->requested())) {
            while (servers_.size() < static_cast<std::size_t>(plan_.jobs) && !chunks_.empty()) {
                servers_.push_back(
                    std::make_unique<Server>(plan_, chunks_.front().first, chunks_.front().second));
                chunks_.pop_front();
            }
            if (servers_.empty()) break;
            listen();
        }
        std::vector<HardRun> made;
        for (std::size_t i = 0; i < runs_.size(); ++i)
            if (done_[i]) made.push_back(std::move(runs_[i]));
        return made;
    }

  private:
    void listen() {
        std::vector<pollfd> polled;
        for (const auto& server : servers_) polled.push_back({server->from, POLLIN, 0});
        if (poll(polled.data(), polled.size(), 1000) < 0 && errno != EINTR)
            throw Error("bench-hard", "the processes cannot be listened to");
        for (std::size_t i = servers_.size(); i-- > 0;) {
            Server& server = *servers_[i];
            bool ended = false;
            if (polled[i].revents != 0) {
                std::array<char, 65536> buffer;
                const ssize_t n = read(server.from, buffer.data(), buffer.size());
                ended = n == 0;
                if (n > 0) take(server, {buffer.data(), static_cast<std::size_t>(n)});
            }
            const std::chrono::duration<double> quiet = Clock::now() - server.since;
            const bool hangs = quiet.count() > plan_.patience;
            if (!ended && !hangs) continue;
            const std::size_t at = server.at, last = server.last;
            servers_.erase(servers_.begin() + static_cast<std::ptrdiff_t>(i));
            if (at == last) continue;
            HardRun lost;
            lost.run.failure = hangs ? "ended by force: out of time" : "the process crashed";
            keep(at, std::move(lost));
            if (at + 1 < last) chunks_.emplace_front(at + 1, last);
        }
    }

    void take(Server& server, std::string_view text) {
        for (char c : text) {
            if (c != '\n') {
                server.text += c;
                continue;
            }
            const std::vector<std::string> fields = split(server.text);
            server.text.clear();
            server.since = Clock::now();
            server.at = std::strtoull(fields.at(1).c_str(), nullptr, 10);
            if (fields[0] == "R") keep(server.at++, parsed(fields));
        }
    }

    void keep(std::size_t number, HardRun done) {
        set_index(done, index_of(plan_, number));
        if (progress_) progress_(done);
        runs_[number] = std::move(done);
        done_[number] = true;
    }

    const HardPlan& plan_;
    const HardProgress& progress_;
    std::vector<HardRun> runs_;
    std::vector<bool> done_;
    std::deque<std::pair<std::size_t, std::size_t>> chunks_;
    std::vector<std::unique_ptr<Server>> servers_;
};

} // namespace

std::vector<HardRun> run_hard(const HardPlan& plan, const HardProgress& progress, const CancelFlag* cancel) {
    return Pool(plan, progress).run(cancel);
}

} // namespace montelux::bench
