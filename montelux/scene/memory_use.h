// MemoryUse: what a scene's data take, by kind, from the sizes of their containers.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace montelux {

struct Scene;

struct MemoryUse {
    std::string_view kind;
    std::size_t bytes = 0;
    std::size_t count = 0;   // of `unit`
    std::string_view unit{}; // "triangles"
    std::size_t in_file = 0; // bytes in a mapped file, of which `bytes` are resident
};

// Kinds that the scene does not use are left out.
std::vector<MemoryUse> memory_use(const Scene& scene);

} // namespace montelux
