// Controls the fault injection from within the process that it is linked into.
#pragma once

namespace montelux::fault {

// Reads the environment again and restarts the count.
void restart();
// Calls on the folder so far.
long count();

} // namespace montelux::fault
