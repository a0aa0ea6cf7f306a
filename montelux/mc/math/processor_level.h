// Instructions that the compiler was allowed, as bits: constants, which any processor can read.
#pragma once

namespace montelux {

enum InstructionSet : unsigned {
    uses_sse42 = 1,
    uses_avx2 = 2,
    uses_fma = 4,
    uses_bmi2 = 8,
    uses_avx512 = 16, // F, BW, CD, DQ and VL
};
extern const unsigned compiled_instructions;

} // namespace montelux
