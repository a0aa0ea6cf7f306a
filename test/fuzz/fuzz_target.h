// What every fuzz target does: hand untrusted bytes to a loader, which reads them or refuses them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "montelux/mc/math/error.h"

// libFuzzer calls it for each input, and so does run_corpus.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace montelux {

// An Error is the one way to refuse; every other exception ends the program.
template <typename Load>
int read_or_refuse(Load load) {
    try {
        load();
    } catch (const Error&) {
    }
    return 0;
}

} // namespace montelux
