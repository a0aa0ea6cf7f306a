// Control of the fault injection by the process that it is linked into.
#pragma once

namespace montelux::fault {

// Reads the environment anew and counts from 0 again.
void restart();
// Calls on the folder so far.
long count();

} // namespace montelux::fault
