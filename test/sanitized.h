// under_sanitizers: whether the address sanitizer slows the tests down and reserves terabytes.
#pragma once

extern "C" void __asan_init() __attribute__((weak)); // defined by the sanitizer's library

namespace montelux {

// Determined at link time: plain and sanitized programs share the objects of the tests.
inline const bool under_sanitizers = __asan_init != nullptr;

} // namespace montelux
