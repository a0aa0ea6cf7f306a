#include "montelux/mc/integrate/trained/target_draws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::uint64_t samples_tag = 0x73616d706c6573; // sequences of their own, apart from the training's
constexpr std::uint64_t scale_draws = 1024;
constexpr std::uint64_t most_blocks = 256; // drawn at a time,
constexpr std::uint64_t least_blocks = 4;
constexpr std::uint64_t most_block_numbers = 1
                                             << 24; // which keep at most so many numbers, unless they are few

// log2 of the change of volume at the middle of the domain, roughly.
double volume_exponent_of(const Domain& domain) {
    const double volume = domain.constant_volume();
    return volume > 0 && std::isfinite(volume) ? std::log2(volume) : 0;
}

} // namespace

Target::Target(const TrainedDensity& density, const Integrand& f, const SamplingOptions& options)
    : density_(density), scale_(f.components(), options.form, false, volume_exponent_of(density.domain())),
      evaluator_(scaled(f, scale_), density.domain(), options.non_finite),
      key_(hash_key(options.seed, samples_tag)) {
    if (options.form == IntegrandForm::logarithm && f.components() != 1)
        throw Error("sample",
                    "expected one logarithm, got " + std::to_string(f.components()) + " components");
}

void Target::draw(Stream stream, std::uint64_t first, std::uint64_t count, TargetDraws& draws) const {
    const Domain& domain = density_.domain();
    const int n = domain.uniforms();
    // One more number chooses the part of a mixture, the last one is free.
    PointBuffer v(count, n + 2);
    fill_random(v, key_, static_cast<std::uint32_t>(stream), first);
    UnitDraws unit;
    density_.unit().draw(v, unit);
    const std::size_t inside = unit.index.size();
    draws.index = std::move(unit.index);
    draws.choice.resize(inside);
    for (std::size_t i = 0; i < inside; ++i) draws.choice[i] = v(draws.index[i], n + 1);

    draws.x.resize(inside, domain.dimensions());
    draws.f.resize(inside, components());
    std::vector<double> volume(inside, 1.0);
    domain.map(unit.u, draws.x, volume);
    draws.non_finite = {};
    if (inside > 0) evaluator_.at_points(draws.x, draws.f, draws.non_finite);
    draws.weight.resize(inside);
    for (std::size_t i = 0; i < inside; ++i) {
        const double f = draws.f(i);
        // Far out f may underflow where the volume overflows.
        draws.weight[i] = f == 0 ? 0 : f * (volume[i] / unit.density[i]);
        if (std::isfinite(draws.weight[i])) continue;
        draws.weight[i] = 0;
        std::vector<double> point(static_cast<std::size_t>(domain.dimensions()));
        draws.x.view().gather(i, point.data());
        draws.non_finite.merge({1, std::move(point)});
    }
}

std::uint64_t Target::block_numbers() const {
    const auto of_draw = static_cast<std::uint64_t>(density_.domain().dimensions() + components() + 3);
    return block * of_draw;
}

std::uint64_t Target::find_scale() {
    if (scale_.form() != IntegrandForm::logarithm) return 0;
    std::uint64_t made = 0;
    TargetDraws draws;
    do {
        draw(Stream::scale, 0, scale_draws, draws);
        made += draws.index.size();
    } while (scale_.adjust());
    return made;
}

double Target::unscaled(double x, int component) const {
    return scale_.form() == IntegrandForm::logarithm
               ? x
               : scale_.unscaled(x, static_cast<std::size_t>(component));
}

double Target::unscaled_product(double x, int a, int b) const {
    if (scale_.form() == IntegrandForm::logarithm) return x;
    return scale_.unscaled_product(x, static_cast<std::size_t>(a), static_cast<std::size_t>(b));
}

double Target::log_reference() const {
    return scale_.form() == IntegrandForm::logarithm ? scale_.exponent(0) * std::numbers::ln2 : 0;
}

bool draw_blocks(const Target& target, Target::Stream stream, const SamplingOptions& options,
                 const std::function<std::uint64_t(std::uint64_t)>& expected,
                 const std::function<bool(TargetDraws&, std::uint64_t, std::uint64_t)>& take) {
    const std::uint64_t limit =
        options.max_draws > 0 ? options.max_draws : std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t most =
        std::clamp(most_block_numbers / target.block_numbers(), least_blocks, most_blocks);
    std::uint64_t done = 0;
    std::vector<TargetDraws> blocks;
    while (done < limit) {
        const std::uint64_t wanted =
            std::min({std::max<std::uint64_t>(1, expected(done)), limit - done, most * Target::block});
        const std::uint64_t count = (wanted - 1) / Target::block + 1;
        blocks.resize(count);
        auto size_of = [&](std::uint64_t b) { return std::min(Target::block, wanted - b * Target::block); };
        const bool complete = parallel_for(
            static_cast<std::int64_t>(count),
            [&](std::int64_t b) {
                const auto at = static_cast<std::uint64_t>(b);
                target.draw(stream, done + at * Target::block, size_of(at), blocks[at]);
            },
            options.cancel);
        if (!complete) return false;
        std::uint64_t first = done;
        for (std::uint64_t b = 0; b < count; ++b) {
            const std::uint64_t drawn = size_of(b);
            if (!take(blocks[b], first, drawn)) return true;
            first += drawn;
        }
        done = first;
    }
    return true;
}

} // namespace montelux
