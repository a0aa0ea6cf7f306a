// NVRTC, NVIDIA's compiler of CUDA C++ as a library, loaded while the program runs.
#pragma once

#include <string>
#include <vector>

#include "montelux/mc/io/shared_library.h"

namespace montelux {

class Nvrtc {
  public:
    // $MONTELUX_NVRTC names the library; otherwise libnvrtc.so of CUDA 13, 12 or 11 is looked for where the system looks
    // for libraries. Throws Error where there is none.
    Nvrtc();

    // The architectures that it compiles for, ascending: 90 is compute capability 9.0.
    std::vector<int> architectures() const;

    // Machine code for an architecture that it knows; for a newer one PTX of the newest that it knows, which the driver
    // translates; for an older one Error. `file` names the source in errors, which contain the compiler's messages.
    std::string compile(const std::string& source, const std::string& file, int architecture) const;

  private:
    // Opaque handles and result codes, as NVRTC's documentation declares them.
    using Program = struct NvrtcProgram*;
    using Result = int;

    struct Functions {
        Result (*create)(Program*, const char* source, const char* name, int headers,
                         const char* const* header_texts, const char* const* header_names);
        Result (*destroy)(Program*);
        Result (*compile)(Program, int options, const char* const* option_texts);
        Result (*log_size)(Program, std::size_t*);
        Result (*log)(Program, char*);
        Result (*ptx_size)(Program, std::size_t*);
        Result (*ptx)(Program, char*);
        Result (*cubin_size)(Program, std::size_t*);
        Result (*cubin)(Program, char*);
        Result (*count_architectures)(int*);
        Result (*list_architectures)(int*);
        const char* (*error_text)(Result);
    };
    void check(Result result, const char* what) const;

    std::vector<SharedLibrary> library_; // one
    Functions f_{};
};

} // namespace montelux
