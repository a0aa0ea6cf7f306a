#include "montelux/mc/integrate/metropolis/chain_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/mc/integrate/metropolis/chain_agreement.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {

ChainTrace::ChainTrace(int observables)
    : open_(static_cast<std::size_t>(observables)), closed_(open_.size() * max_batches) {}

void ChainTrace::add(std::span<const double> values) {
    ++in_open_;
    const double inverse = 1 / static_cast<double>(in_open_);
    for (std::size_t k = 0; k < open_.size(); ++k) {
        const double delta = values[k] - open_[k].mean;
        open_[k].mean += delta * inverse;
        open_[k].squares += delta * (values[k] - open_[k].mean);
    }
    if (in_open_ == length_) close();
}

void ChainTrace::close() {
    for (std::size_t k = 0; k < open_.size(); ++k) {
        closed_[k * max_batches + batches_] = open_[k];
        open_[k] = {};
    }
    in_open_ = 0;
    if (++batches_ < max_batches) return;
    for (std::size_t k = 0; k < open_.size(); ++k) {
        Batch* batch = &closed_[k * max_batches];
        for (std::size_t i = 0; i < max_batches / 2; ++i) {
            const Batch a = batch[2 * i], b = batch[2 * i + 1];
            const double delta = b.mean - a.mean;
            batch[i] = {0.5 * (a.mean + b.mean),
                        a.squares + b.squares + 0.5 * static_cast<double>(length_) * delta * delta};
        }
    }
    batches_ /= 2;
    length_ *= 2;
}

void ChainTrace::save(StateWriter& state) const {
    state.put(length_);
    state.put(in_open_);
    state.put(static_cast<std::uint64_t>(batches_));
    for (const std::vector<Batch>* part : {&open_, &closed_})
        for (const Batch& batch : *part) {
            state.put(batch.mean);
            state.put(batch.squares);
        }
}

void ChainTrace::load(StateReader& state) {
    length_ = state.get_word();
    in_open_ = state.get_word();
    batches_ = state.get_word();
    if (length_ == 0 || in_open_ >= length_ || batches_ >= max_batches)
        throw Error("the saved trace of a chain has no possible shape");
    for (std::vector<Batch>* part : {&open_, &closed_})
        for (Batch& batch : *part) {
            batch.mean = state.get_double();
            batch.squares = state.get_double();
        }
}

namespace {

// Mean and variance of single states over batches [begin, end) of a chain.
struct Part {
    double mean = 0, variance = 0;
};
Part part(const ChainTrace& chain, int k, std::size_t begin, std::size_t end) {
    RunningMoments means;
    double squares = 0;
    for (std::size_t i = begin; i < end; ++i) {
        means.add(chain.mean(k, i));
        squares += chain.squares(k, i);
    }
    const double length = static_cast<double>(chain.batch_length());
    const double states = length * static_cast<double>(end - begin);
    squares += length * means.squared_deviations()[0];
    return {means.mean(), states > 1 ? squares / (states - 1) : 0};
}

// Batches that all chains have.
std::size_t common_batches(std::span<const ChainTrace> chains) {
    std::size_t batches = chains.empty() ? 0 : chains[0].batches();
    for (const ChainTrace& chain : chains) batches = std::min(batches, chain.batches());
    return batches;
}

} // namespace

double split_r_hat(std::span<const ChainTrace> chains, int k) {
    const std::size_t batches = common_batches(chains);
    const std::size_t half = batches / 2;
    if (half < 2) return std::numeric_limits<double>::infinity();
    RunningMoments means;
    double within = 0;
    for (const ChainTrace& chain : chains)
        for (std::size_t begin : {std::size_t{0}, batches - half}) {
            const Part p = part(chain, k, begin, begin + half);
            means.add(p.mean);
            within += p.variance;
        }
    within /= static_cast<double>(2 * chains.size());
    const double n = static_cast<double>(half) * static_cast<double>(chains[0].batch_length());
    return r_hat_of(n, within, means.variance());
}

ChainSummary summarize(std::span<const ChainTrace> chains, int k) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    ChainSummary summary;
    const std::size_t batches = common_batches(chains);
    if (batches < 4) {
        summary.standard_error = summary.variance = summary.r_hat = infinite;
        return summary;
    }
    const double all = static_cast<double>(batches * chains.size());
    const double length = static_cast<double>(chains[0].batch_length());
    double squares = 0;
    for (const ChainTrace& chain : chains) {
        const Part p = part(chain, k, 0, batches);
        summary.mean += p.mean / static_cast<double>(chains.size());
    }
    for (const ChainTrace& chain : chains)
        for (std::size_t i = 0; i < batches; ++i) {
            const double delta = chain.mean(k, i) - summary.mean;
            squares += chain.squares(k, i) + length * delta * delta;
        }
    summary.variance = squares / (all * length - 1);
    summary.r_hat = split_r_hat(chains, k);
    summary.effective_sample_size = all * length;
    if (!(summary.variance > 0)) return summary;

    auto autocovariance = [&](std::size_t lag) {
        double sum = 0;
        for (const ChainTrace& chain : chains)
            for (std::size_t i = 0; i + lag < batches; ++i)
                sum += (chain.mean(k, i) - summary.mean) * (chain.mean(k, i + lag) - summary.mean);
        return sum / all;
    };
    // Sums of neighbouring autocovariances of a reversible chain are positive and fall; after the first that
    // is not, only noise follows.
    const double own = autocovariance(0);
    double asymptotic = -own, last = infinite;
    for (std::size_t lag = 0; lag + 1 < batches; lag += 2) {
        const double even = lag == 0 ? own : autocovariance(lag);
        const double pair = std::min(last, even + autocovariance(lag + 1));
        if (!(pair > 0)) break;
        asymptotic += 2 * pair;
        last = pair;
    }
    asymptotic = std::max(asymptotic, 1e-3 * own);
    // The mean was fitted to the same numbers.
    const double lost = std::min(0.5, asymptotic / (own * all));
    const double variance_of_mean = asymptotic / all / (1 - lost);
    summary.standard_error = std::sqrt(variance_of_mean);
    summary.autocorrelation_time = variance_of_mean * all * length / summary.variance;
    summary.effective_sample_size = all * length / summary.autocorrelation_time;
    return summary;
}

double correlation_of_means(std::span<const ChainTrace> chains, int a, int b) {
    const std::size_t batches = common_batches(chains), blocks = std::min<std::size_t>(16, batches);
    double aa = 0, bb = 0, ab = 0;
    RunningMoments mean_a, mean_b;
    std::vector<double> of_a, of_b;
    for (const ChainTrace& chain : chains)
        for (std::size_t j = 0; j < blocks; ++j) {
            const std::size_t begin = j * batches / blocks, end = (j + 1) * batches / blocks;
            of_a.push_back(part(chain, a, begin, end).mean);
            of_b.push_back(part(chain, b, begin, end).mean);
            mean_a.add(of_a.back());
            mean_b.add(of_b.back());
        }
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        const double da = of_a[i] - mean_a.mean(), db = of_b[i] - mean_b.mean();
        aa += da * da;
        bb += db * db;
        ab += da * db;
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

} // namespace montelux
