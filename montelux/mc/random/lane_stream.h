// LaneStream: the streams of many samples, drawn from together.
#pragma once

#include <array>
#include <cstdint>

#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/random/sample_stream.h"

namespace montelux {

// Draws from W streams of one kind, those of the lanes in `active`; other lanes get numbers without meaning.
// Each stream gives the numbers that it would give by itself. Between construction and `store` the streams
// must not be used otherwise.
template <int W>
class LaneStream {
  public:
    using T = Lanes<W>;

    // The first `count` streams are of use.
    LaneStream(const std::array<SampleStream*, W>& streams, int count)
        : active(LaneMask<W>::first(count)), streams_(streams), count_(count) {
        independent_ = streams[0]->kind_ == SamplerKind::independent;
        if (!independent_) return;
        for (int i = 0; i < W; ++i) {
            const SampleStream& s = *streams[i];
            dimension_.set(i, s.dimension_);
            key_[0].set(i, static_cast<std::uint32_t>(s.key_));
            key_[1].set(i, static_cast<std::uint32_t>(s.key_ >> 32));
            for (int k = 0; k < 3; ++k) counter_[k].set(i, s.counter_[k + 1]);
        }
    }

    LaneMask<W> active;

    T next_1d() {
        if (independent_) return unit_float(next_philox());
        return T::from([&](int i) { return active[i] ? streams_[i]->next_1d() : 0; });
    }
    Vec2<T> next_2d() {
        Vec2<T> u;
        if (independent_) {
            u.x = unit_float(next_philox());
            u.y = unit_float(next_philox());
            return u;
        }
        for (int i = 0; i < W; ++i) {
            if (!active[i]) continue;
            const Vec2f pair = streams_[i]->next_2d();
            u.x.set(i, pair.x);
            u.y.set(i, pair.y);
        }
        return u;
    }
    // Of the active lanes.
    std::array<double, W> refined(T u) {
        std::array<double, W> result{};
        if (independent_) {
            const T below = unit_float(next_philox());
            for (int i = 0; i < W; ++i) result[i] = double(u[i]) + 0x1p-24 * double(below[i]);
        } else {
            for (int i = 0; i < W; ++i)
                if (active[i]) result[i] = streams_[i]->refined(u[i]);
        }
        return result;
    }
    void store() {
        if (!independent_) return;
        for (int i = 0; i < count_; ++i) streams_[i]->dimension_ = dimension_[i];
    }

  private:
    static T unit_float(LaneBits<W> bits) { return to_float(bits >> 8) * 0x1p-24f; }

    LaneBits<W> next_philox() {
        const LaneBits<W> block = dimension_ >> 2;
        if (any(active & !(block_number_ == block + 1u))) {
            block_ = philox4x32<7, LaneBits<W>>({block, counter_[0], counter_[1], counter_[2]}, key_);
            block_number_ = block + 1u;
        }
        const LaneBits<W> at = dimension_ & 3u;
        dimension_ = dimension_ + (active_bits() & 1u);
        return select(at == 0u, block_[0],
                      select(at == 1u, block_[1], select(at == 2u, block_[2], block_[3])));
    }
    LaneBits<W> active_bits() const {
        return LaneBits<W>(std::bit_cast<typename LaneBits<W>::Vector>(active.v));
    }

    std::array<SampleStream*, W> streams_;
    int count_;
    bool independent_ = false;
    std::array<LaneBits<W>, 2> key_;
    LaneBits<W> dimension_ = 0u, counter_[3];
    std::array<LaneBits<W>, 4> block_;
    LaneBits<W> block_number_ = 0u; // plus 1; 0 without a block
};

} // namespace montelux
