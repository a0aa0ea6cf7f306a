// under_sanitizers: whether the address sanitizer slows the tests down and reserves terabytes.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define MONTELUX_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MONTELUX_ADDRESS_SANITIZER 1
#endif
#endif

namespace montelux {

#if defined(MONTELUX_ADDRESS_SANITIZER)
inline constexpr bool under_sanitizers = true;
#else
inline constexpr bool under_sanitizers = false;
#endif

} // namespace montelux
