// A main for fuzz targets without libFuzzer: hands each file of the folders in its arguments to the target, within
// 2 GiB of memory and 10 seconds of processor time per file.
// The last line of a run that dies names the file: "reading FILE".
#include "test/fuzz/fuzz_target.h"
#include "test/sanitized.h"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sys/resource.h>
#include <sys/time.h>
#include <vector>

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    std::vector<fs::path> files;
    for (int i = 1; i < argc; ++i)
        for (const auto& entry : fs::directory_iterator(argv[i])) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) {
        std::fprintf(stderr, "usage: %s folder... (there are no files in these)\n", argv[0]);
        return 2;
    }
    const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30}, no_core{0, 0};
    if (!montelux::under_sanitizers)
        ::setrlimit(RLIMIT_AS, &memory); // the address sanitizer reserves terabytes
    ::setrlimit(RLIMIT_CORE, &no_core);
    // Of processor time, so that a busy machine does not matter; SIGPROF ends the program.
    const itimerval limit{{0, 0}, {montelux::under_sanitizers ? 60 : 10, 0}};
    for (const fs::path& file : files) {
        std::printf("reading %s\n", file.c_str());
        std::fflush(stdout);
        std::ifstream in(file, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
        // Without the spare room of the vector, so that the address sanitizer sees reads beyond the end.
        const std::unique_ptr<std::uint8_t[]> input(new std::uint8_t[bytes.size()]);
        std::copy(bytes.begin(), bytes.end(), input.get());
        ::setitimer(ITIMER_PROF, &limit, nullptr);
        LLVMFuzzerTestOneInput(input.get(), bytes.size());
    }
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    std::printf("%zu files read or refused, at most %ld MiB\n", files.size(), used.ru_maxrss / 1024);
    return 0;
}
