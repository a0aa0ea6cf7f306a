// The instructions that this build may use, and whether the processor has them.
#pragma once

namespace montelux {

// The level of x86-64 whose instructions the build uses, such as "x86-64-v3"; empty on other architectures.
const char* compiled_processor_level();

// What the build needs and the processor lacks, for instance "AVX2"; null if nothing. Uses none of it itself,
// so it can be asked first.
const char* missing_instructions();

} // namespace montelux
