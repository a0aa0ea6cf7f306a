// VEGAS+ by way of its Python package, in a process of its own whose CPU time is the method's.
#include "bench/integrate/rivals/rivals.h"
#include "bench/integrate/rivals/worker.h"
#include <memory>
#include <nlohmann/json.hpp>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

std::vector<Method> vegas_methods(const std::string& python, std::string& message) {
    if (python.empty()) {
        message = "no Python interpreter was given";
        return {};
    }
    std::shared_ptr<Worker> worker;
    try {
        worker = std::make_shared<Worker>(
            std::vector<std::string>{python, MONTELUX_VEGAS_WORKER, MONTELUX_INTEGRANDS_LIBRARY});
    } catch (const Error& error) {
        message = error.what();
        return {};
    }
    if (!worker->receive()) {
        message = "'" + python + "' cannot import the package vegas";
        return {};
    }
    auto run = [worker](const CountedIntegrand& f, const Request& request) {
        const nlohmann::json question = {{"family", static_cast<int>(f.integrand().line().family)},
                                         {"dimensions", f.dimensions()},
                                         {"parameters", f.integrand().seed()},
                                         {"relative_error", request.relative_error},
                                         {"evaluations", request.evaluations},
                                         {"seed", request.seed}};
        worker->send(question.dump());
        const std::optional<std::string> line = worker->receive();
        if (!line) throw Error("vegas", "the process has ended");
        const nlohmann::json reply = nlohmann::json::parse(*line);
        if (reply.contains("failure")) throw Error("vegas", reply["failure"].get<std::string>());
        return Answer{.value = reply["value"],
                      .error = reply["error"],
                      .converged = reply["converged"],
                      .doubtful = reply["doubtful"],
                      .chosen = {},
                      .evaluations = reply["evaluations"].get<std::uint64_t>(),
                      .cpu_seconds = reply["cpu_seconds"].get<double>()};
    };
    return {{.name = "vegas+", .run = run}};
}

} // namespace montelux::bench
