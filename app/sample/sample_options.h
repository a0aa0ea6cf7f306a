// Options of `montelux sample` as typed, and what its kinds of samples share.
#pragma once

#include "app/table_file.h"
#include <string>
#include <vector>

namespace montelux::app {

struct SampleOptions {
    std::string set, randomisation, n = "1024", dimensions, seed = "0", threads = "0", output, format;
    std::vector<std::string> let, over, densities;
    // Of a trained density.
    std::string from, histogram, pilot, overweight_share, max_draws;
    bool unweighted = false, covariance = false;
    // Of chains.
    std::vector<std::string> formulas, starts;
    std::string sampler, chains, walkers, burn_in, thin;
    bool log = false;
    bool quiet = false;
};

// By --format, else by the name of the file, else CSV. Throws UsageError.
TableFormat format_of(const SampleOptions& options);
// By --format netcdf, else by a file name that ends in .nc; of chains only.
bool is_netcdf(const SampleOptions& options);

// Samples, or a histogram, from a density that `montelux integrate --save-density` trained. Returns the exit
// code.
int run_trained_samples(const SampleOptions& options);

// Markov chains whose states follow the density of which a formula is the logarithm.
int run_chains(const SampleOptions& options);

} // namespace montelux::app
