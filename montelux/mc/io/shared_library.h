// A shared library that is opened while the program runs, not linked.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace montelux {

class SharedLibrary {
  public:
    // `name` is a path, or a file name that the system looks for where it looks for libraries. Nothing comes
    // back when it cannot be opened; `reason` then says why.
    static std::optional<SharedLibrary> open(const std::string& name, std::string& reason);

    // The function with that name, or a null pointer. Function must be its type; nothing can check it.
    template <typename Function>
    Function find(const char* name) const {
        return reinterpret_cast<Function>(address_of(name));
    }

  private:
    struct Close {
        void operator()(void* handle) const;
    };

    explicit SharedLibrary(void* handle) : handle_(handle) {}
    void* address_of(const char* name) const;

    std::unique_ptr<void, Close> handle_;
};

} // namespace montelux
