// Samples of a density that is known up to a constant, by Markov chains: the front door to the samplers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/chains/draw_summary.h"
#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

enum class ChainSampler : std::uint8_t {
    metropolis, // random walks that adapt during burn-in (metropolis_chain.h)
    ensemble,   // walkers that stretch towards one another
    slice       // walkers that slice along one another's differences
};
inline constexpr std::array<std::string_view, 3> chain_sampler_names{"metropolis", "ensemble", "slice"};
std::optional<ChainSampler> chain_sampler(std::string_view name);

struct ChainOptions {
    ChainSampler sampler = ChainSampler::metropolis;
    int chains = 4;  // independent of one another; of `ensemble` and `slice`: ensembles
    int walkers = 0; // of each ensemble; 0: 2 (dimensions + 1), at least 8
    std::uint64_t draws = 1024;
    std::uint64_t burn_in = 2000; // states left out of each chain or walker
    std::uint64_t thin = 1;       // every thin-th state is a draw
    std::uint64_t seed = 0;
    // One for all, one for each of `chains`, or one for each walker; empty: random points of the domain, drawn by their
    // density. Walkers that share a start are scattered about it.
    std::vector<std::vector<double>> starts = {};
    std::vector<std::string> names = {}; // of the variables, for warnings; empty: x1, x2, ...
    const CancelFlag* cancel = nullptr;
};

// Fewer walkers than two for each variable, and four, do not reach all of the space.
int fewest_walkers(int dimensions);
// Of each ensemble, by default or as the options say; 1 for metropolis.
int walkers_of(const ChainOptions& options, int dimensions);

struct ChainDraws {
    int dimensions = 0;
    std::size_t chains = 0; // sequences of draws: walkers of all ensembles, one ensemble after the other
    std::uint64_t draws = 0;
    std::vector<double> states; // chain by chain, draw by draw, variable by variable
    std::vector<DrawSummary> variables;
    double acceptance_rate = 0; // states after burn-in that differ from the one before; 1 for slices
    std::uint64_t evaluations = 0;
    std::uint64_t non_finite = 0; // log densities that were NaN or +infinity, and were taken for -infinity
    bool cancelled = false;       // then states and summaries are incomplete
    std::vector<std::string> warnings;

    double state(std::size_t chain, std::uint64_t draw, int variable) const {
        return states[(chain * draws + draw) * static_cast<std::size_t>(dimensions) +
                      static_cast<std::size_t>(variable)];
    }
};

// Draws whose density is proportional to exp(log_density) on the box `domain`. The result does not depend on the number
// of threads. `log_density` is called from several threads at once; -infinity is a density of zero. Throws Error for
// options that make no sense, and where no start can be found.
ChainDraws sample_chains(const Integrand& log_density, const Domain& domain,
                         const ChainOptions& options = {});

} // namespace montelux
