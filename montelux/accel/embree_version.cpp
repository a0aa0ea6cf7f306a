#include "montelux/accel/embree_version.h"

#include "montelux/accel/embree.h"

namespace montelux {

LibraryVersion embree_version() { return {"Embree", RTC_VERSION_STRING}; }

} // namespace montelux
