#include "montelux/denoise/oidn_api.h"

#include <cstdlib>
#include <initializer_list>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// The name of a function in 2.x, and in 1.4 where that differs.
template <typename Function>
void find(const OidnApi& api, Function& function, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if ((function = api.library->find<Function>(name))) return;
    throw Error(api.file, std::string("this is not Open Image Denoise 1.4 or newer: it has no function ") +
                              *names.begin());
}

OidnApi functions_of(SharedLibrary library, const std::string& file) {
    OidnApi api;
    api.file = file;
    api.library = std::move(library);
    find(api, api.new_device, {"oidnNewDevice"});
    find(api, api.release_device, {"oidnReleaseDevice"});
    find(api, api.set_device_bool, {"oidnSetDeviceBool", "oidnSetDevice1b"});
    find(api, api.set_device_int, {"oidnSetDeviceInt", "oidnSetDevice1i"});
    find(api, api.get_device_int, {"oidnGetDeviceInt", "oidnGetDevice1i"});
    find(api, api.commit_device, {"oidnCommitDevice"});
    find(api, api.get_device_error, {"oidnGetDeviceError"});
    find(api, api.new_filter, {"oidnNewFilter"});
    find(api, api.release_filter, {"oidnReleaseFilter"});
    find(api, api.set_filter_image, {"oidnSetSharedFilterImage"});
    find(api, api.set_filter_bool, {"oidnSetFilterBool", "oidnSetFilter1b"});
    find(api, api.commit_filter, {"oidnCommitFilter"});
    find(api, api.execute_filter, {"oidnExecuteFilter"});
    return api;
}

} // namespace

OidnApi load_oidn() {
    std::string reason;
    // A file that was asked for by name is never replaced by another one.
    if (const char* file = std::getenv(oidn_library_variable); file && *file) {
        if (auto library = SharedLibrary::open(file, reason)) return functions_of(std::move(*library), file);
        throw Error(oidn_library_variable, "Open Image Denoise cannot be loaded from '" + std::string(file) +
                                               "', which this variable names: " + reason);
    }
    for (const char* name :
         {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "libOpenImageDenoise.so"})
        if (auto library = SharedLibrary::open(name, reason)) return functions_of(std::move(*library), name);
    throw Error(
        "Open Image Denoise",
        "the library was not found; tried libOpenImageDenoise.so.2, .so.1 and .so where the system "
        "looks for libraries. 'pip install pyoidn' brings it; Python finds it there, for the program set " +
            std::string(oidn_library_variable) +
            " to the file pyoidn/oidn/lib/libOpenImageDenoise.so.2 in the folder that 'pip show pyoidn' "
            "names as Location");
}

} // namespace montelux
