// The integrands as a shared library with a C interface, for integrators in other languages: the same code,
// so that an evaluation costs the same.
#include "bench/integrate/method.h"
#include <string>

namespace {

struct Handle {
    explicit Handle(montelux::bench::Line line, std::uint64_t seed)
        : integrand(line, seed), counted(integrand) {}
    montelux::bench::BenchIntegrand integrand;
    montelux::bench::CountedIntegrand counted;
};

} // namespace

#define MONTELUX_BENCH_EXPORT extern "C" __attribute__((visibility("default")))

// Null for a line that there is not.
MONTELUX_BENCH_EXPORT void* montelux_bench_integrand(int family, int dimensions, std::uint64_t seed) {
    try {
        return new Handle({static_cast<montelux::bench::Family>(family), dimensions}, seed);
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
