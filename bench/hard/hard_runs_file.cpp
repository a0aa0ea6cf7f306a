#include "bench/hard/hard_runs_file.h"

#include "bench/integrate/markdown.h"
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "montelux/mc/math/error.h"

namespace montelux::bench {
namespace {

std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        json += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return json + "\"";
}
// JSON has no infinities.
std::string number(double x) { return std::isfinite(x) ? formatted("%.17g", x) : "null"; }

} // namespace

void write_hard_json(const std::string& path, const HardPlan& plan, const std::vector<HardRun>& runs) {
    std::ofstream out(path);
    out << "{\"first_seed\": " << plan.first_seed << ", \"seeds\": " << plan.seeds
        << ", \"seconds\": " << number(plan.seconds) << ", \"runs\": [\n";
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const HardRun& r = runs[i];
        const Answer& answer = r.run.answer;
        auto truth = [](bool b) { return b ? "true" : "false"; };
        out << "{\"family\": " << quoted(std::string(plan.families[r.run.line]->name))
            << ", \"method\": " << quoted(plan.methods[r.run.method].name) << ", \"seed\": " << r.run.seed
            << ", \"target\": " << number(plan.goals[r.run.goal].relative_error)
            << ", \"cap\": " << plan.goals[r.run.goal].evaluations << ", \"dimensions\": " << r.dimensions
            << ", \"parameters\": " << quoted(r.parameters) << ", \"exact\": " << number(r.run.exact)
            << ", \"accuracy\": " << number(r.accuracy) << ", \"value\": " << number(answer.value)
            << ", \"error\": " << number(answer.error) << ", \"evaluations\": " << r.run.evaluations
            << ", \"cpu_seconds\": " << number(r.run.cpu_seconds)
            << ", \"converged\": " << truth(answer.converged) << ", \"warned\": " << truth(answer.warned)
            << ", \"out_of_time\": " << truth(answer.out_of_time) << ", \"silent\": " << truth(r.silent())
            << ", \"silent_at_cap\": " << truth(r.silent_at_cap()) << ", \"honest\": " << truth(r.honest())
            << ", \"chosen\": " << quoted(answer.chosen) << ", \"reason\": " << quoted(answer.reason)
            << ", \"warnings\": " << quoted(answer.warnings) << ", \"failure\": " << quoted(r.run.failure)
            << (i + 1 < runs.size() ? "},\n" : "}\n");
    }
    out << "]}\n";
    if (!out.flush()) throw Error(path, "cannot be written");
}

namespace {

using Json = nlohmann::json;

// What `number` wrote; `instead` for null.
double number_in(const Json& run, const char* name,
                 double instead = std::numeric_limits<double>::quiet_NaN()) {
    const Json& value = run.at(name);
    return value.is_null() ? instead : value.get<double>();
}

// The index of the first element that `is_it`; one is made where there is none.
template <typename T, typename IsIt, typename Make>
std::size_t place_in(std::vector<T>& list, const IsIt& is_it, const Make& make) {
    const auto found = std::find_if(list.begin(), list.end(), is_it);
    if (found != list.end()) return static_cast<std::size_t>(found - list.begin());
    list.push_back(make());
    return list.size() - 1;
}

HardRun run_in(const Json& json, HardPlan& plan) {
    const auto family = json.at("family").get<std::string>(), method = json.at("method").get<std::string>();
    const HardFamily* known = hard_family_named(family);
    if (known == nullptr) throw Error("family", "there is no family '" + family + "' in the bank");
    const Goal goal{number_in(json, "target"), json.at("cap").get<std::uint64_t>()};
    HardRun run;
    run.run.line = place_in(
        plan.families, [&](const HardFamily* f) { return f == known; }, [&] { return known; });
    run.run.method = place_in(
        plan.methods, [&](const Method& m) { return m.name == method; },
        [&] {
            Method named;
            named.name = method;
            return named;
        });
    run.run.goal = place_in(
        plan.goals, [&](const Goal& g) { return g == goal; }, [&] { return goal; });
    run.run.seed = json.at("seed").get<std::uint64_t>();
    run.run.exact = number_in(json, "exact");
    run.run.evaluations = json.at("evaluations").get<std::uint64_t>();
    run.run.cpu_seconds = number_in(json, "cpu_seconds");
    run.run.failure = json.at("failure").get<std::string>();
    Answer& answer = run.run.answer;
    answer.value = number_in(json, "value");
    answer.error = number_in(json, "error", std::numeric_limits<double>::infinity());
    answer.converged = json.at("converged").get<bool>();
    answer.warned = json.at("warned").get<bool>();
    answer.out_of_time = json.at("out_of_time").get<bool>();
    answer.chosen = json.at("chosen").get<std::string>();
    answer.reason = json.at("reason").get<std::string>();
    answer.warnings = json.at("warnings").get<std::string>();
    run.dimensions = json.at("dimensions").get<int>();
    run.parameters = json.at("parameters").get<std::string>();
    run.accuracy = number_in(json, "accuracy");
    // A file of another definition of silence, or an error that was NaN, not infinite.
    if (json.at("silent").get<bool>() != run.silent() ||
        json.at("silent_at_cap").get<bool>() != run.silent_at_cap() ||
        json.at("honest").get<bool>() != run.honest())
        throw Error("runs", "a run of " + family + " by " + method +
                                " is judged otherwise by its value and error than the file says");
    return run;
}

} // namespace

HardRecord read_hard_json(const std::vector<std::string>& paths) {
    HardRecord record;
    record.plan.seconds = 0;
    using Key = std::tuple<std::size_t, std::size_t, std::size_t, std::uint64_t>;
    std::set<Key> known;
    std::set<std::uint64_t> seeds;
    for (const std::string& path : paths) {
        std::ifstream in(path);
        if (!in) throw Error(path, "cannot be read");
        try {
            const Json file = Json::parse(in);
            const double seconds = number_in(file, "seconds");
            if (record.plan.seconds > 0 && seconds != record.plan.seconds)
                throw Error("seconds", "the runs have another limit of time than those of " + paths.front());
            record.plan.seconds = seconds;
            for (const Json& json : file.at("runs")) {
                HardRun run = run_in(json, record.plan);
                if (!known.emplace(run.run.line, run.run.method, run.run.goal, run.run.seed).second)
                    throw Error("runs", "seed " + std::to_string(run.run.seed) + " of " +
                                            json.at("family").get<std::string>() + " by " +
                                            json.at("method").get<std::string>() + " is there twice");
                seeds.insert(run.run.seed);
                record.runs.push_back(std::move(run));
            }
        } catch (const Json::exception&) {
            throw Error(path, "is not a file that --json wrote");
        } catch (const Error& error) {
            throw Error(path, error.what());
        }
    }
    if (record.runs.empty()) throw Error("--report", "there are no runs in these files");
    for (const Goal& goal : record.plan.goals)
        if (goal.evaluations != record.plan.goals.front().evaluations)
            throw Error("--report", "the runs have different limits of evaluations");
    record.plan.first_seed = *seeds.begin();
    record.plan.seeds = seeds.size();
    return record;
}

} // namespace montelux::bench
