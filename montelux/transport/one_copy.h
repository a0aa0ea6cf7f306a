// A function of which there is one copy in the program.
#pragma once

// Neither inlined nor cloned for known arguments. With -ffp-contract=fast it is the compiler's affair which
// multiplications and additions it fuses, and so two copies of a function may differ in their last bits.
#if defined(__GNUC__) && !defined(__clang__)
#define MONTELUX_ONE_COPY [[gnu::noipa]]
#else
#define MONTELUX_ONE_COPY [[gnu::noinline]]
#endif
