// Compiled for the oldest processor of the architecture (CMakeLists.txt), and without anything inline that
// another file could have compiled for a newer one.
#include "montelux/mc/math/processor.h"
#include "montelux/mc/math/processor_level.h"

namespace montelux {

const char* missing_instructions() {
#ifdef __x86_64__
    __builtin_cpu_init();
    const unsigned needed = compiled_instructions;
    if ((needed & uses_sse42) != 0 && __builtin_cpu_supports("sse4.2") == 0) return "SSE4.2";
    if ((needed & uses_avx2) != 0 && __builtin_cpu_supports("avx2") == 0) return "AVX2";
    if ((needed & uses_fma) != 0 && __builtin_cpu_supports("fma") == 0) return "FMA";
    if ((needed & uses_bmi2) != 0 && __builtin_cpu_supports("bmi2") == 0) return "BMI2";
    if ((needed & uses_avx512) != 0 &&
        (__builtin_cpu_supports("avx512f") == 0 || __builtin_cpu_supports("avx512bw") == 0 ||
         __builtin_cpu_supports("avx512cd") == 0 || __builtin_cpu_supports("avx512dq") == 0 ||
         __builtin_cpu_supports("avx512vl") == 0))
        return "AVX-512";
#endif
    return nullptr;
}

} // namespace montelux
