// Time per uniform number of every kind of sample stream, in the renderer's pattern of draws.
#include <benchmark/benchmark.h>
#include <cstdint>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/random/sample_stream.h"

namespace {

// Arguments: kind, samples per pixel. Opens a stream per sample and draws eight times a pair and a number.
void sample_stream(benchmark::State& state) {
    const montelux::SamplerSettings settings{static_cast<montelux::SamplerKind>(state.range(0)), 1,
                                             static_cast<std::uint32_t>(state.range(1)), 4};
    std::uint64_t sample = 0;
    for (auto _ : state) {
        const auto pixel = static_cast<std::uint32_t>(sample / settings.spp);
        montelux::SampleStream stream(settings, pixel % 1024, pixel / 1024, sample % settings.spp);
        float sum = 0;
        for (int k = 0; k < 8; ++k) {
            const montelux::Vec2f pair = stream.next_2d();
            const float single = stream.next_1d();
            sum += pair.x + pair.y + single;
        }
        benchmark::DoNotOptimize(sum);
        ++sample;
    }
    state.SetItemsProcessed(state.iterations() * 24);
}
BENCHMARK(sample_stream)->ArgNames({"kind", "samples"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {64, 1024}});

void philox_stream(benchmark::State& state) {
    montelux::PhiloxStream stream(1);
    for (auto _ : state) benchmark::DoNotOptimize(stream.next_1d());
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(philox_stream);

} // namespace
