// Signals that ask the program to end: SIGINT, SIGTERM, and SIGHUP unless it is ignored (nohup).
#pragma once

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::app {

// While nothing is worth saving: a signal ends the program at once with exit_interrupted.
void end_on_signals();
// From now on the first signal sets the flag that is returned; the second one ends the program at once.
const CancelFlag& cancel_on_signals();
// While files are being written: signals change nothing, for the end of the program is near and one in the
// middle of a file would leave a part of it behind.
void finish_on_signals();

} // namespace montelux::app
