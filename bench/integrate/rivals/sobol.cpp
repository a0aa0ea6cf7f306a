// Eight replicates of scrambled Sobol' points, the scheme of SciPy's qmc_quad: the mean of the replicates,
// its error from their spread. A rerun of the scheme, not of SciPy's code.
//
// The scramble is that of SciPy's engine: a random lower triangular matrix over GF(2) and a random digital
// shift (Matousek 1998, "On the L2-discrepancy for anchored boxes"), points in Gray code order.
#include "montelux/mc/random/sobol.h"

#include "bench/integrate/escalation.h"
#include "bench/integrate/rivals/rivals.h"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"

namespace montelux::bench {

namespace {

constexpr int replicates = 8;
constexpr std::uint64_t first_points = 1024; // of each replicate

// One scrambled sequence, which gives its points in order.
class Replicate {
  public:
    Replicate(int dimensions, std::uint64_t seed, std::uint64_t key)
        : columns_(static_cast<std::size_t>(dimensions)), state_(columns_.size()) {
        PhiloxStream numbers(hash_key(seed, key));
        for (std::size_t j = 0; j < columns_.size(); ++j) {
            const SobolColumns& plain = sobol_columns(static_cast<int>(j));
            // Row i of the scramble: the first i digits at random, then a one.
            std::array<std::uint32_t, sobol_bits> rows;
            for (int i = 0; i < sobol_bits; ++i) {
                const std::uint32_t digit = 0x80000000u >> i;
                rows[i] = digit | (numbers.next_bits() & ~(digit | (digit - 1)));
            }
            for (int k = 0; k < sobol_bits; ++k) {
                columns_[j][k] = 0;
                for (int i = 0; i < sobol_bits; ++i)
                    if (std::popcount(rows[i] & plain[k]) & 1) columns_[j][k] |= 0x80000000u >> i;
            }
            state_[j] = numbers.next_bits();
        }
    }

    // Adds the values at the next `count` points.
    double next_sum(const CountedIntegrand& f, std::uint64_t count, Form form) {
        constexpr std::size_t block = 512;
        const std::size_t d = columns_.size();
        std::vector<double> rows(block * d), values(block);
        double sum = 0;
        for (std::uint64_t done = 0; done < count; done += block) {
            const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(block, count - done));
            for (std::size_t i = 0; i < n; ++i) {
                for (std::size_t j = 0; j < d; ++j) rows[i * d + j] = (state_[j] + 0.5) * 0x1p-32;
                ++index_;
                const int flipped = std::countr_zero(index_);
                for (std::size_t j = 0; j < d; ++j) state_[j] ^= columns_[j][flipped & 31];
            }
            if (form == Form::batch)
                f.rows_on_unit_cube(rows.data(), n, values.data());
            else
                for (std::size_t i = 0; i < n; ++i) values[i] = f.on_unit_cube(&rows[i * d]);
            for (std::size_t i = 0; i < n; ++i) sum += values[i];
        }
        return sum;
    }

  private:
    std::vector<std::array<std::uint32_t, sobol_bits>> columns_;
    std::vector<std::uint32_t> state_;
    std::uint32_t index_ = 0;
};

// The sequence is at its best at powers of two: the largest one that fits, where a tenth more counts as
// fitting.
std::uint64_t points_of_replicate(std::uint64_t evaluations) {
    return std::bit_floor(evaluations / replicates);
}

Trial mean_of(const std::array<double, replicates>& sums, std::uint64_t points) {
    RunningMoments moments;
    for (double sum : sums) moments.add(sum / static_cast<double>(points));
    return {moments.mean(), moments.standard_error()};
}

// Four times the points, all of them new, until the error is small enough.
Answer sobol8(const CountedIntegrand& f, const Request& request) {
    std::uint64_t runs = 0;
    return escalate(f, request, replicates * first_points, Growth::by(4), [&](std::uint64_t n) {
        const std::uint64_t points = points_of_replicate(n);
        std::array<double, replicates> sums;
        for (double& sum : sums)
            sum = Replicate(f.dimensions(), request.seed, runs++).next_sum(f, points, request.form);
        return mean_of(sums, points);
    });
}

// A stronger form: each replicate continues from where it stopped, to twice its points, so that nothing is thrown
// away.
Answer sobol8_doubling(const CountedIntegrand& f, const Request& request) {
    std::vector<Replicate> sequences;
    for (std::uint64_t r = 0; r < replicates; ++r) sequences.emplace_back(f.dimensions(), request.seed, r);
    std::array<double, replicates> sums{};
    std::uint64_t points = 0;
    Answer answer;
    auto extend = [&](std::uint64_t to) {
        for (std::size_t r = 0; r < sums.size(); ++r)
            sums[r] += sequences[r].next_sum(f, to - points, request.form);
        points = to;
        const Trial trial = mean_of(sums, points);
        answer.value = trial.value;
        answer.error = trial.error;
        answer.converged =
            request.relative_error > 0 && trial.error <= request.relative_error * std::abs(trial.value);
    };
    if (!(request.relative_error > 0)) {
        extend(points_of_replicate(request.evaluations));
        return answer;
    }
    for (std::uint64_t to = first_points; to * replicates <= request.evaluations && !answer.converged;
         to *= 2)
        extend(to);
    return answer;
}

} // namespace

std::vector<Method> sobol_methods() {
    return {{.name = "sobol8", .forms = {Form::batch, Form::scalar}, .run = sobol8},
            {.name = "sobol8-doubling", .forms = {Form::batch, Form::scalar}, .run = sobol8_doubling}};
}

} // namespace montelux::bench
