// Values of a scene refer to one another by index into the scene's flat arrays.
#pragma once

#include <cstdint>

namespace montelux {

using Index = std::uint32_t;
inline constexpr Index no_index = 0xffffffffu;

} // namespace montelux
