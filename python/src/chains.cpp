#include "python/src/bindings.h"
#include "python/src/c_function.h"
#include "python/src/numpy_bridge.h"
#include <string>
#include <vector>

#include "montelux/mc/integrate/chains/sample_chains.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::python {
namespace {

nb::dict dict_of(const ChainDraws& draws) {
    nb::dict d;
    auto column = [&](double DrawSummary::*member) {
        std::vector<double> values;
        for (const DrawSummary& s : draws.variables) values.push_back(s.*member);
        return new_array(values);
    };
    d["mean"] = column(&DrawSummary::mean);
    d["standard_error"] = column(&DrawSummary::standard_error);
    d["standard_deviation"] = column(&DrawSummary::standard_deviation);
    d["r_hat"] = column(&DrawSummary::r_hat);
    d["bulk_effective_size"] = column(&DrawSummary::bulk_effective_size);
    d["tail_effective_size"] = column(&DrawSummary::tail_effective_size);
    d["acceptance_rate"] = draws.acceptance_rate;
    d["evaluations"] = draws.evaluations;
    d["non_finite"] = draws.non_finite;
    d["warnings"] = draws.warnings;
    const std::size_t shape[] = {draws.chains, draws.draws, static_cast<std::size_t>(draws.dimensions)};
    NewArray states = new_array(shape);
    std::copy(draws.states.begin(), draws.states.end(), states.data);
    d["states"] = states.array;
    return d;
}

} // namespace

void bind_chains(nb::module_& m) {
    m.def(
        "chain_samplers",
        [] { return std::vector<std::string>(chain_sampler_names.begin(), chain_sampler_names.end()); },
        "The names of the samplers.");
    m.def(
        "sample_chains",
        [](const nb::object& log_density, const Domain& domain, const std::string& sampler, int chains,
           int walkers, std::uint64_t n, std::uint64_t burn_in, std::uint64_t thin, std::uint64_t seed,
           const std::vector<std::vector<double>>& starts, const std::vector<std::string>& variables,
           int threads) {
            ChainOptions options;
            options.sampler = chain_sampler(sampler).value();
            options.chains = chains;
            options.walkers = walkers;
            options.draws = n;
            options.burn_in = burn_in;
            options.thin = thin;
            options.seed = seed;
            options.starts = starts;
            options.names = variables;
            const Integrand integrand = integrand_of(log_density, 0, false);
            ChainDraws draws;
            {
                nb::gil_scoped_release unlocked;
                draws = with_threads(threads, [&] { return sample_chains(integrand, domain, options); });
            }
            return dict_of(draws);
        },
        "log_density"_a, "domain"_a, "sampler"_a, "chains"_a, "walkers"_a, "n"_a, "burn_in"_a, "thin"_a,
        "seed"_a, "starts"_a, "names"_a, "threads"_a, "montelux.sample, with everything decided.");
}

} // namespace montelux::python
