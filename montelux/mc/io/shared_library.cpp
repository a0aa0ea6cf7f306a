#include "montelux/mc/io/shared_library.h"

#include <dlfcn.h>

namespace montelux {

std::optional<SharedLibrary> SharedLibrary::open(const std::string& name, std::string& reason) {
    // RTLD_NODELETE: a library may have threads and destructors that outlive the last handle; its code stays.
    if (void* handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
        return SharedLibrary(handle);
    const char* message = dlerror();
    reason = message ? message : "it cannot be opened";
    return std::nullopt;
}

void* SharedLibrary::address_of(const char* name) const { return dlsym(handle_.get(), name); }

void SharedLibrary::Close::operator()(void* handle) const { dlclose(handle); }

} // namespace montelux
