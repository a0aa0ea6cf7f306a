// The stream that one sample draws its numbers from.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/random/equidistant.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/prime_base.h"
#include "montelux/mc/random/sampler_settings.h"
#include "montelux/mc/random/sobol.h"
#include "montelux/mc/random/stratified.h"
#include "montelux/mc/random/uniform_bits.h"
#include "montelux/mc/random/van_der_corput.h"
#include "montelux/mc/random/z_order.h"

namespace montelux {

template <int W>
class LaneStream;

// Numbers in [0, 1): a pure function of (settings, pixel, sample index) and of how many were drawn before,
// one and two at a time. As many as wanted may be drawn. For every kind each number is uniform, the numbers
// of a sample are independent of one another, and so a single sample is unbiased. Samples of one replicate
// depend on each other (that is what makes their mean better); samples of different replicates or pixels do
// not, except that the pixels of a replicate of `sobol_blue_noise` share one point set. docs/random.md
// compares the kinds.
//
// Draw a pair with next_2d where two numbers span one region (a lens, a light, a lobe): pairs are stratified
// in the plane. In the quasi-random kinds the first numbers are the best ones.
//
//   independent       Philox4x32-7
//   stratified        jittered strata and correlated multi-jittered pairs, independent from draw to draw
//   halton            Halton points of bases 2 to 719 with nested digit scrambling, then shuffled repetitions
//   hammersley        the same after a first number that is equidistant over the replicate
//   sobol             Owen-scrambled Sobol' points of 16 dimensions, then shuffled scrambled sets of 4
//                     (Burley 2020, "Practical Hash-based Owen Scrambling")
//   sobol_blue_noise  shuffled scrambled planar Sobol' sets whose points the pixels take along a randomised Z
//                     curve (Ahmed, Wonka 2020), in tiles of 4096 x 4096 pixels
class SampleStream {
  public:
    SampleStream(const SamplerSettings& settings, std::uint32_t pixel_x, std::uint32_t pixel_y,
                 std::uint64_t sample_index)
        : kind_(settings.kind) {
        if (kind_ == SamplerKind::independent) [[likely]] {
            // The low words are exact, so that no two samples below 2^32 of a seed can collide.
            const std::uint64_t high = sample_index >> 32;
            key_ = settings.seed ^ (high == 0 ? 0 : hash_key(high));
            counter_ = {0, static_cast<std::uint32_t>(sample_index), pixel_x, pixel_y};
            return;
        }
        count_ = points_per_replicate(settings);
        const std::uint64_t replicate = replicate_of(settings, sample_index);
        index_ = index_in_replicate(settings, sample_index);
        index_bits_ = static_cast<int>(std::bit_width(count_ - 1));
        if (kind_ == SamplerKind::sobol_blue_noise) {
            key_ = hash_key(settings.seed, replicate, pixel_x / tile_width, pixel_y / tile_width);
            z_index_ = std::uint64_t{morton_code(pixel_x % tile_width, pixel_y % tile_width)} << index_bits_ |
                       index_;
        } else {
            key_ = hash_key(settings.seed, replicate, pixel_x, pixel_y);
            if (kind_ == SamplerKind::stratified) grid_ = StrataGrid(count_);
        }
    }

    float next_1d() {
        if (kind_ == SamplerKind::independent) [[likely]]
            return unit_float(next_philox());
        const std::uint32_t d = dimension_++;
        switch (kind_) {
        case SamplerKind::stratified:
            return to_float(stratified_1d(index_, count_, key_of(d)));
        case SamplerKind::halton:
            return to_float(halton(d));
        case SamplerKind::hammersley:
            return to_float(d == 0 ? turned_equidistant(index_, count_, mix64(key_)) : halton(d - 1));
        case SamplerKind::sobol:
            return unit_float(sobol(d));
        default:
            return unit_float(blue_noise_pair(d)[0]);
        }
    }

    Vec2f next_2d() {
        if (kind_ == SamplerKind::independent) [[likely]] {
            const float x = unit_float(next_philox());
            const float y = unit_float(next_philox());
            return {x, y};
        }
        switch (kind_) {
        case SamplerKind::stratified: {
            const Vec2d u = multi_jittered_2d(index_, count_, grid_, key_of(dimension_));
            ++dimension_;
            return {to_float(u.x), to_float(u.y)};
        }
        case SamplerKind::sobol: {
            // A pair must not straddle two point sets.
            if (dimension_ % padded_dimensions == padded_dimensions - 1 &&
                dimension_ >= global_dimensions - 1)
                ++dimension_;
            const float x = unit_float(sobol(dimension_));
            const float y = unit_float(sobol(dimension_ + 1));
            dimension_ += 2;
            return {x, y};
        }
        case SamplerKind::sobol_blue_noise: {
            const std::array<std::uint32_t, 2> u = blue_noise_pair(dimension_);
            ++dimension_;
            return {unit_float(u[0]), unit_float(u[1])};
        }
        default: {
            const float x = next_1d();
            const float y = next_1d();
            return {x, y};
        }
        }
    }

    // A drawn number with random bits added below its 24, for a choice among many, or of something
    // improbable. Call it once, before anything else is drawn.
    double refined(float u) {
        if (kind_ == SamplerKind::independent) [[likely]]
            return double(u) + 0x1p-24 * double(unit_float(next_philox()));
        const std::uint64_t below = hash_key(key_of(dimension_), refinement, index_, z_index_);
        return double(u) + 0x1p-24 * double(unit_float(static_cast<std::uint32_t>(below)));
    }

    // Independent numbers for a branch of the sample that begins here: a function of this stream, of how many numbers
    // were drawn from it, and of `number`.
    SampleStream branch(std::uint32_t number) const {
        SampleStream stream = *this;
        stream.kind_ = SamplerKind::independent;
        stream.key_ = hash_key(key_, branching, std::uint64_t{number} << 32 | dimension_, index_, z_index_);
        stream.dimension_ = 0;
        stream.counter_[0] = 0;
        return stream;
    }

  private:
    template <int W>
    friend class LaneStream;

    static constexpr std::uint64_t branching = 0x6272616e6368; // as `refinement`
    static constexpr std::uint64_t refinement = 0x7265666e;    // no other hash of a dimension's key has it
    static constexpr std::uint32_t global_dimensions = sobol_nibble_dimensions;
    static constexpr std::uint32_t padded_dimensions = 4;
    static constexpr std::uint32_t halton_dimensions = 128;
    static constexpr std::uint32_t tile_width = 4096;
    static constexpr int tile_bits = 24;
    static_assert(global_dimensions % padded_dimensions == 0);

    // Truncates, for rounding could reach 1.
    static float to_float(double u) {
        return static_cast<float>(static_cast<std::uint32_t>(u * 0x1p24)) * 0x1p-24f;
    }

    std::uint64_t key_of(std::uint32_t dimension) const {
        return mix64(key_ + (dimension + 1) * golden_gamma);
    }

    std::uint32_t next_philox() {
        const std::uint32_t d = dimension_++, block = d / 4;
        // LaneStream may have drawn some of a block.
        if (counter_[0] != block + 1) {
            counter_[0] = block;
            block_ = philox4x32<>(counter_,
                                  {static_cast<std::uint32_t>(key_), static_cast<std::uint32_t>(key_ >> 32)});
            counter_[0] = block + 1;
        }
        return block_[d % 4];
    }

    std::uint32_t sobol(std::uint32_t d) {
        const std::uint64_t key = key_of(d);
        std::uint32_t x;
        if (d < global_dimensions) {
            x = sobol_coordinate_reversed(index_, static_cast<int>(d));
        } else {
            const std::uint32_t within = d % padded_dimensions;
            // next_2d may have entered a set at any place but its last.
            if (within == 0)
                shuffled_ = owen_scramble(index_, static_cast<std::uint32_t>(key >> 32)) & index_mask();
            x = sobol_coordinate_reversed(shuffled_, static_cast<int>(within));
        }
        return reverse_bits(owen_scramble_reversed(x, static_cast<std::uint32_t>(key)));
    }

    // The first two Sobol' dimensions at this pixel's place of a shuffled sequence.
    std::array<std::uint32_t, 2> blue_noise_pair(std::uint32_t d) const {
        const std::uint64_t key = key_of(d);
        const std::uint64_t at = shuffle_quads(z_index_, tile_bits + index_bits_, key);
        // Not mix64(key): shuffle_quads takes that for the pixel at the start of the curve.
        const std::uint64_t seeds = mix64(key ^ golden_gamma);
        const auto x = static_cast<std::uint32_t>(at);
        const auto y = static_cast<std::uint32_t>(sobol_second_reversed(at));
        return {reverse_bits(owen_scramble_reversed(x, static_cast<std::uint32_t>(seeds))),
                reverse_bits(owen_scramble_reversed(y, static_cast<std::uint32_t>(seeds >> 32)))};
    }

    double halton(std::uint32_t d) const {
        std::uint32_t index = index_;
        const std::uint32_t repetition = d / halton_dimensions;
        if (repetition != 0) index = permute(index, count_, mix64(key_ ^ repetition));
        return scrambled_radical_inverse(index, prime_bases[d % halton_dimensions], key_of(d), count_);
    }

    std::uint32_t index_mask() const {
        return static_cast<std::uint32_t>((std::uint64_t{1} << index_bits_) - 1);
    }

    SamplerKind kind_;
    std::uint32_t dimension_ = 0; // draws so far
    std::uint64_t key_ = 0;
    std::array<std::uint32_t, 4> counter_{}; // independent; the first is the number of `block_` plus 1
    std::array<std::uint32_t, 4> block_;     // independent
    std::uint32_t index_ = 0, count_ = 1;    // within the replicate
    std::uint32_t shuffled_ = 0;             // sobol: the index within the padded set begun last
    int index_bits_ = 0;
    StrataGrid grid_;           // stratified
    std::uint64_t z_index_ = 0; // sobol_blue_noise
};

} // namespace montelux
