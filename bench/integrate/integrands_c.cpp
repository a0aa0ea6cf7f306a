// The integrands as a shared library with a C interface, for integrators in other languages: the same code,
// so that an evaluation costs the same.
#include "bench/hard/bank.h"
#include "bench/integrate/integrands.h"
#include "bench/integrate/method.h"
#include <memory>
#include <utility>

namespace {

using namespace montelux::bench;

struct Handle {
    explicit Handle(std::unique_ptr<const BenchProblem> made) : problem(std::move(made)), counted(*problem) {}
    std::unique_ptr<const BenchProblem> problem;
    CountedIntegrand counted;
};

} // namespace

#define MONTELUX_BENCH_EXPORT extern "C" __attribute__((visibility("default")))

// A line of the tables, or a family of the bank of hard integrals; null where neither has this name.
MONTELUX_BENCH_EXPORT void* montelux_bench_integrand(const char* name, std::uint64_t seed) {
    try {
        if (const std::optional<Line> line = line_named(name))
            return new Handle(std::make_unique<BenchIntegrand>(*line, seed));
        if (const HardFamily* family = hard_family_named(name))
            return new Handle(std::make_unique<HardProblem>(*family, seed));
        return nullptr;
    } catch (const std::exception&) {
        return nullptr;
    }
}
MONTELUX_BENCH_EXPORT void montelux_bench_release(void* handle) { delete static_cast<Handle*>(handle); }
MONTELUX_BENCH_EXPORT std::uint64_t montelux_bench_evaluations(const void* handle) {
    return static_cast<const Handle*>(handle)->counted.evaluations();
}
MONTELUX_BENCH_EXPORT void montelux_bench_rows(const void* handle, const double* u, std::size_t n,
                                               double* values) {
    static_cast<const Handle*>(handle)->counted.rows_on_unit_cube(u, n, values);
}
