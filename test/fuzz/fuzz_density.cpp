// Trained densities, behind their file's checksum: the words of the payload, and a few draws of what they make.
#include "test/fuzz/fuzz_target.h"
#include <cstring>
#include <vector>

#include "montelux/mc/integrate/trained/samples.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return montelux::read_or_refuse([&] {
        std::vector<std::uint64_t> words(size / 8);
        if (!words.empty()) std::memcpy(words.data(), data, words.size() * 8);
        const montelux::TrainedDensity density = montelux::TrainedDensity::from_words(std::move(words));
        auto one = [](std::span<const double>) { return 1.0; };
        montelux::SamplingOptions options;
        options.threads = 1;
        options.max_draws = 100;
        montelux::weighted_samples(density, one, 3, options);
    });
}
