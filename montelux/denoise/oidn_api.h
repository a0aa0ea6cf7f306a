// The functions of Open Image Denoise that are used, found in its shared library while the program runs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "montelux/mc/io/shared_library.h"

namespace montelux {

struct OidnDevice; // known to the library alone
struct OidnFilter;

// The C interface, the same in 1.4 and 2.x but for three names (api documentation, "Small API Changes").
// The library keeps errors until get_device_error reads them.
struct OidnApi {
    static constexpr int cpu_device = 1, float3_format = 3, no_error = 0;

    OidnDevice* (*new_device)(int type) = nullptr;
    void (*release_device)(OidnDevice*) = nullptr;
    void (*set_device_bool)(OidnDevice*, const char* name, bool value) = nullptr;
    void (*set_device_int)(OidnDevice*, const char* name, int value) = nullptr;
    int (*get_device_int)(OidnDevice*, const char* name) = nullptr;
    void (*commit_device)(OidnDevice*) = nullptr;
    // With a null device: why none could be made. The text lives until the next call.
    int (*get_device_error)(OidnDevice*, const char** message) = nullptr;
    OidnFilter* (*new_filter)(OidnDevice*, const char* type) = nullptr;
    void (*release_filter)(OidnFilter*) = nullptr;
    // Strides of 0: pixels and rows follow one another without gaps.
    void (*set_filter_image)(OidnFilter*, const char* name, void* pixels, int format, std::size_t width,
                             std::size_t height, std::size_t byte_offset, std::size_t byte_pixel_stride,
                             std::size_t byte_row_stride) = nullptr;
    void (*set_filter_bool)(OidnFilter*, const char* name, bool value) = nullptr;
    void (*commit_filter)(OidnFilter*) = nullptr;
    void (*execute_filter)(OidnFilter*) = nullptr;

    std::string file; // as it was opened
    std::optional<SharedLibrary> library;
};

// Names the file to open, instead of those that the system knows.
inline constexpr const char* oidn_library_variable = "MONTELUX_OIDN_LIBRARY";

// Throws Error, with what was tried and how to get the library, when there is none or it is not what its name
// says.
OidnApi load_oidn();

} // namespace montelux
