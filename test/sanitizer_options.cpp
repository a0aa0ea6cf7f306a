// Options of the address sanitizer for every program of the tests.

// The runtimes of GCC 12 and Clang 14 may take memory of a library that was loaded late for a thread's storage
// under a glibc before 2.25, and then crash when they look for leaks (sanitizers' issue 1322).
extern "C" __attribute__((visibility("default"))) const char* __asan_default_options() { // NOLINT(bugprone-*)
    return "intercept_tls_get_addr=0";
}
