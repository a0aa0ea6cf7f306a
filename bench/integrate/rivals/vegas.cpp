// VEGAS+ by way of its Python package, in a process of its own whose CPU time is the method's.
#include "bench/integrate/rivals/rivals.h"
#include "bench/integrate/rivals/worker.h"
#include <memory>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

namespace {

// The worker of this process: one that a parent started does not answer its children.
class VegasWorker {
  public:
    explicit VegasWorker(std::string python) : python_(std::move(python)) {}

    // Null where the package cannot be imported.
    Worker* get() {
        if (owner_ == getpid()) return worker_.get();
        static_cast<void>(worker_.release()); // its pipes are the parent's
        owner_ = getpid();
        worker_ = std::make_unique<Worker>(
            std::vector<std::string>{python_, MONTELUX_VEGAS_WORKER, MONTELUX_INTEGRANDS_LIBRARY});
        if (!worker_->receive()) worker_.reset();
        return worker_.get();
    }

  private:
    std::string python_;
    pid_t owner_ = -1;
    std::unique_ptr<Worker> worker_;
};

} // namespace

std::vector<Method> vegas_methods(const std::string& python, std::string& message) {
    if (python.empty()) {
        message = "no Python interpreter was given";
        return {};
    }
    const auto vegas = std::make_shared<VegasWorker>(python);
    try {
        if (!vegas->get()) message = "'" + python + "' cannot import the package vegas";
    } catch (const Error& error) {
        message = error.what();
    }
    if (!message.empty()) return {};
    auto run = [vegas](const CountedIntegrand& f, const Request& request) {
        const nlohmann::json question = {
            {"problem", f.problem().name()},      {"dimensions", f.dimensions()},
            {"parameters", f.problem().seed()},   {"relative_error", request.relative_error},
            {"evaluations", request.evaluations}, {"seed", request.seed}};
        Worker* worker = vegas->get();
        if (!worker) throw Error("vegas", "the process could not be started");
        worker->send(question.dump());
        const std::optional<std::string> line = worker->receive();
        if (!line) throw Error("vegas", "the process has ended");
        const nlohmann::json reply = nlohmann::json::parse(*line);
        if (reply.contains("failure")) throw Error("vegas", reply["failure"].get<std::string>());
        return Answer{.value = reply["value"],
                      .error = reply["error"],
                      .converged = reply["converged"],
                      .warned = reply["warned"],
                      .chosen = {},
                      .reason = {},
                      .warnings = {},
                      .evaluations = reply["evaluations"].get<std::uint64_t>(),
                      .cpu_seconds = reply["cpu_seconds"].get<double>()};
    };
    return {{.name = "vegas+", .run = run}};
}

} // namespace montelux::bench
