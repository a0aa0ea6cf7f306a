#include "montelux/formats/decoders.h"

#include <string>
#ifdef MONTELUX_BLOSC
#include <blosc.h>
#endif
#ifdef MONTELUX_DRACO
#include <draco/core/draco_version.h>
#endif
#ifdef MONTELUX_MESHOPT
#include <meshoptimizer.h>
#endif

namespace montelux {

std::vector<LibraryVersion> decoders() {
    std::string draco, meshoptimizer, blosc;
#ifdef MONTELUX_DRACO
    draco = draco::kDracoVersion;
#endif
#ifdef MONTELUX_MESHOPT
    constexpr int v = MESHOPTIMIZER_VERSION;
    meshoptimizer = std::to_string(v / 1000) + "." + std::to_string(v % 1000 / 10);
#endif
#ifdef MONTELUX_BLOSC
    blosc = BLOSC_VERSION_STRING;
#endif
    return {{"Draco", draco}, {"meshoptimizer", meshoptimizer}, {"Blosc", blosc}};
}

} // namespace montelux
