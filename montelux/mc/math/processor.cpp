#include "montelux/mc/math/processor.h"

#include "montelux/mc/math/processor_level.h"

namespace montelux {
namespace {

constexpr unsigned instructions = 0
#ifdef __SSE4_2__
                                  | uses_sse42
#endif
#ifdef __AVX2__
                                  | uses_avx2
#endif
#ifdef __FMA__
                                  | uses_fma
#endif
#ifdef __BMI2__
                                  | uses_bmi2
#endif
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) &&       \
    defined(__AVX512VL__)
                                  | uses_avx512
#endif
    ;

} // namespace

const unsigned compiled_instructions = instructions;

const char* compiled_processor_level() {
#ifdef __x86_64__
    constexpr unsigned v3 = uses_sse42 | uses_avx2 | uses_fma | uses_bmi2;
    if ((instructions & (v3 | uses_avx512)) == (v3 | uses_avx512)) return "x86-64-v4";
    if ((instructions & v3) == v3) return "x86-64-v3";
    return (instructions & uses_sse42) != 0 ? "x86-64-v2" : "x86-64";
#else
    return "";
#endif
}

} // namespace montelux
