// under_sanitizers: whether the address sanitizer slows the tests down and reserves terabytes.
#pragma once

extern "C" void __asan_init() __attribute__((weak)); // of its library

namespace montelux {

// Known when a program is linked: the same object of a test is linked with plain and with sanitized code.
inline const bool under_sanitizers = __asan_init != nullptr;

} // namespace montelux
