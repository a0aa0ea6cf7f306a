// MONTELUX_ONE_COPY: a function with a single copy in the program.
#pragma once

// Neither inlined nor cloned for constant arguments. With -ffp-contract=fast the compiler chooses which
// multiplications and additions to fuse, so two copies of a function may differ in their last bits.
#if defined(__GNUC__) && !defined(__clang__)
#define MONTELUX_ONE_COPY [[gnu::noipa]]
#else
#define MONTELUX_ONE_COPY [[gnu::noinline]]
#endif
