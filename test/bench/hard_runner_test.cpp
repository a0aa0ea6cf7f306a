#include "bench/hard/hard_options.h"
#include "bench/hard/hard_report.h"
#include "bench/hard/hard_runner.h"
#include "bench/hard/hard_runs_file.h"
#include "bench/integrate/montelux_methods.h"
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "montelux/mc/math/error.h"

namespace montelux::bench {
namespace {

HardRun run_of(double value, double error, bool converged, bool warned = false) {
    HardRun run;
    run.run.exact = 2;
    run.accuracy = 1e-12;
    run.run.answer.value = value;
    run.run.answer.error = error;
    run.run.answer.converged = converged;
    run.run.answer.warned = warned;
    return run;
}

TEST(HardRun, SilentWhereItClaimsItsTargetAndIsFarFromTheTruth) {
    EXPECT_TRUE(run_of(2.005, 0.001, true).silent());
    EXPECT_FALSE(run_of(2.005, 0.001, true).honest());
    EXPECT_TRUE(run_of(2.0039, 0.001, true).honest());
    EXPECT_FALSE(run_of(2.005, 0.001, true, true).silent()); // it warned
    EXPECT_FALSE(run_of(2.005, 0.001, true, true).honest());
    EXPECT_FALSE(run_of(2.005, 0.001, false).silent());
    EXPECT_TRUE(run_of(2.005, 0.001, false).silent_at_cap());
    EXPECT_FALSE(run_of(2.0039, 0.001, false).silent_at_cap());
    // An error of 0 is believed down to the accuracy of the exact value.
    EXPECT_TRUE(run_of(2 + 1e-11, 0, true).silent());
    EXPECT_FALSE(run_of(2 + 1e-12, 0, true).silent());
    // An error that is not a number is no error.
    EXPECT_TRUE(run_of(2.005, std::nan(""), true).silent());
    EXPECT_FALSE(run_of(7, std::numeric_limits<double>::infinity(), false).silent_at_cap());
    HardRun failed = run_of(7, 0.001, true);
    failed.run.failure = "out of memory";
    EXPECT_FALSE(failed.silent());
}

Method method(std::string name, std::function<Answer(const CountedIntegrand&, const Request&)> run) {
    Method made;
    made.name = std::move(name);
    made.run = std::move(run);
    return made;
}

HardPlan small_plan() {
    HardPlan plan;
    for (const char* family : {"genz", "spike"}) plan.families.push_back(hard_family_named(family));
    plan.goals = {{1e-2, 20000}, {1e-1, 20000}};
    plan.first_seed = 3;
    plan.seeds = 3;
    return plan;
}

TEST(HardRunner, OneRunThatCrashesOrHangsCostsThatRunAlone) {
    HardPlan plan = small_plan();
    plan.patience = 8;
    plan.jobs = 2;
    plan.methods.push_back(method("good", [](const CountedIntegrand& f, const Request&) {
        const std::vector<double> u(static_cast<std::size_t>(f.dimensions()), 0.5);
        Answer answer;
        answer.value = f.on_unit_cube(u.data());
        answer.error = 1e9;
        answer.converged = true;
        return answer;
    }));
    plan.methods.push_back(method("bad", [](const CountedIntegrand& f, const Request& request) -> Answer {
        if (f.problem().seed() == 4 && request.relative_error == 1e-2) std::_Exit(3);
        if (f.problem().seed() == 5 && request.relative_error == 1e-1 && f.problem().name() == "spike")
            std::this_thread::sleep_for(std::chrono::hours(1));
        throw std::runtime_error("no\tidea");
    }));
    const std::vector<HardRun> runs = run_hard(plan, {});
    ASSERT_EQ(runs.size(), 24u);
    int crashed = 0, hung = 0, refused = 0;
    for (const HardRun& r : runs) {
        if (r.run.method == 0) {
            EXPECT_TRUE(r.honest());
            EXPECT_EQ(r.run.evaluations, 1u);
            EXPECT_FALSE(r.parameters.empty());
        }
        crashed += r.run.failure == "the process crashed";
        hung += r.run.failure == "ended by force: out of time";
        refused += r.run.failure == "no idea"; // the tab is a separator of fields
    }
    EXPECT_EQ(crashed, 2);
    EXPECT_EQ(hung, 1);
    EXPECT_EQ(refused, 9);
}

TEST(HardRunner, ResultsAreThoseOfTheMethodInWhicheverProcess) {
    HardPlan plan = small_plan();
    for (const Method& ours : montelux_methods())
        if (ours.name == "montelux-quasi") plan.methods.push_back(ours);
    ASSERT_EQ(plan.methods.size(), 1u);
    const std::vector<HardRun> one = run_hard(plan, {});
    plan.jobs = 2;
    const std::vector<HardRun> two = run_hard(plan, {});
    ASSERT_EQ(one.size(), 12u);
    ASSERT_EQ(two.size(), 12u);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].run.answer.value, two[i].run.answer.value);
        EXPECT_EQ(one[i].run.answer.error, two[i].run.answer.error);
        EXPECT_EQ(one[i].run.evaluations, two[i].run.evaluations);
        EXPECT_GT(one[i].run.evaluations, 0u);
        const HardProblem problem(*plan.families[one[i].run.line], one[i].run.seed);
        EXPECT_EQ(one[i].run.exact, problem.exact());
        EXPECT_EQ(one[i].dimensions, problem.dimensions());
    }
}

TEST(HardReport, CountsWhatTheRunsSay) {
    HardCell cell;
    for (const HardRun& run :
         {run_of(2.005, 0.001, true), run_of(2.0005, 0.001, true), run_of(2.0015, 0.001, true),
          run_of(3, 0.1, false), run_of(3, 0.1, true, true)})
        cell.add(run);
    EXPECT_EQ(cell.runs, 5);
    EXPECT_EQ(cell.silent, 1);
    EXPECT_EQ(cell.silent_at_cap, 1);
    EXPECT_EQ(cell.honest, 2);
    EXPECT_EQ(cell.converged, 3);
    EXPECT_EQ(cell.warned, 1);
    EXPECT_EQ(cell.within_one, 1);
    EXPECT_EQ(cell.within_two, 2);
    EXPECT_NEAR(cell.silent_share(), 0.2, 1e-15);

    HardPlan plan = small_plan();
    plan.methods = {method("montelux-auto", {}), method("vegas+", {})};
    std::vector<HardRun> runs;
    for (std::size_t m : {0, 1})
        for (std::size_t f : {0, 1}) {
            HardRun run = run_of(m == 1 && f == 1 ? 2.5 : 2.0001, 0.001, true);
            run.run.method = m;
            run.run.line = f;
            run.run.answer.chosen = m == 0 ? "adaptive" : "";
            runs.push_back(run);
        }
    std::ostringstream report, silent;
    print_hard_report(report, plan, runs);
    EXPECT_NE(report.str().find("Families, auto"), std::string::npos);
    EXPECT_NE(report.str().find("| 50.0 % (1) | spike"), std::string::npos) << report.str();
    print_silent_failures(silent, plan, runs);
    EXPECT_EQ(silent.str().find("silent spike seed 0 vegas+ at 1e-2"), 0u) << silent.str();
    EXPECT_NE(report.str().find("| auto: adaptive | 2 "), std::string::npos) << report.str();
    // The worst family is the first of its method's table.
    const std::string vegas = report.str().substr(report.str().find("Families, vegas+"));
    EXPECT_LT(vegas.find("spike"), vegas.find("genz"));
}

// The report of a file, or of several with different seeds, is that of the runs themselves.
TEST(HardReport, OfFilesIsThatOfTheirRuns) {
    HardPlan plan = small_plan();
    plan.methods = {method("montelux-auto", {}), method("vegas+", {})};
    plan.first_seed = 0;
    plan.seeds = 2;
    std::vector<std::vector<HardRun>> by_seed(2);
    std::vector<HardRun> all;
    for (std::uint64_t seed : {0, 1})
        for (std::size_t f = 0; f < plan.families.size(); ++f)
            for (std::size_t m : {0, 1})
                for (std::size_t g = 0; g < plan.goals.size(); ++g) {
                    HardRun run = run_of(m == 1 && f == 1 ? 2.5 : 2.0001, 0.001, seed == 0, g == 1);
                    run.run.line = f;
                    run.run.method = m;
                    run.run.goal = g;
                    run.run.seed = seed;
                    run.run.evaluations = 1000 + 17 * f + 3 * g;
                    run.run.answer.chosen = m == 0 ? "adaptive" : "";
                    run.run.answer.reason = "a \"reason\"";
                    run.accuracy = 1e-12;
                    if (m == 1 && seed == 1) run.run.answer.error = std::numeric_limits<double>::infinity();
                    by_seed[seed].push_back(run);
                    all.push_back(run);
                }
    std::vector<std::string> paths;
    for (std::size_t seed : {0, 1}) {
        HardPlan part = plan;
        part.first_seed = seed;
        part.seeds = 1;
        paths.push_back(testing::TempDir() + "hard_runs_" + std::to_string(seed) + ".json");
        write_hard_json(paths.back(), part, by_seed[seed]);
    }
    const HardRecord record = read_hard_json(paths);
    std::ostringstream expected, report, expected_silent, silent;
    print_hard_report(expected, plan, all);
    print_hard_report(report, record.plan, record.runs);
    EXPECT_EQ(report.str(), expected.str());
    print_silent_failures(expected_silent, plan, all);
    print_silent_failures(silent, record.plan, record.runs);
    EXPECT_EQ(silent.str(), expected_silent.str());
    EXPECT_FALSE(silent.str().empty());

    EXPECT_THROW(read_hard_json({paths[0], paths[0]}), Error); // each run twice
    EXPECT_THROW(read_hard_json({paths[0] + ".none"}), Error);
    HardPlan other = plan;
    other.seconds = plan.seconds + 1;
    write_hard_json(paths[1], other, by_seed[1]);
    EXPECT_THROW(read_hard_json(paths), Error); // another limit of time
    other = plan;
    for (Goal& goal : other.goals) goal.evaluations *= 2;
    write_hard_json(paths[1], other, by_seed[1]);
    EXPECT_THROW(read_hard_json(paths), Error); // another limit of evaluations
    HardRun no_error = by_seed[1][0];
    no_error.run.answer.error = std::nan("");
    write_hard_json(paths[1], plan, {no_error});
    EXPECT_THROW(read_hard_json({paths[1]}), Error); // JSON says null, as for an infinite error
    write_hard_json(paths[1], plan, {});
    EXPECT_THROW(read_hard_json({paths[1]}), Error);
    std::ofstream(paths[1]) << "{\"runs\": [{\"family\": 3}]}";
    EXPECT_THROW(read_hard_json({paths[1]}), Error);
    for (const std::string& path : paths) std::remove(path.c_str());
}

TEST(HardOptions, AreReadAndRefused) {
    const HardOptions options =
        parse_hard_options({"--families", "ring,spike", "--seeds", "3", "--jobs", "2"});
    EXPECT_EQ(options.families, (std::vector<std::string>{"ring", "spike"}));
    EXPECT_EQ(options.seeds, 3u);
    EXPECT_EQ(options.jobs, 2);
    EXPECT_EQ(options.targets.size(), 3u);
    EXPECT_EQ(parse_hard_options({"--quick"}).methods, (std::vector<std::string>{"auto", "adaptive"}));
    EXPECT_EQ(parse_hard_options({"--quick", "--seeds", "2"}).seeds, 2u);
    EXPECT_EQ(parse_hard_options({"--report", "a.json,b.json"}).report,
              (std::vector<std::string>{"a.json", "b.json"}));
    EXPECT_THROW(parse_hard_options({"--report", ","}), Error);
    EXPECT_THROW(parse_hard_options({"--seeds"}), Error);
    EXPECT_THROW(parse_hard_options({"--targets", ""}), Error);
    EXPECT_THROW(parse_hard_options({"--target", "1"}), Error);
}

} // namespace
} // namespace montelux::bench
