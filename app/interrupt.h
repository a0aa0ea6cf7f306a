// Signals that ask the program to end: SIGINT, SIGTERM, and SIGHUP unless it is ignored (nohup).
#pragma once

#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux::app {

// While nothing is worth saving: a signal ends the program at once with exit_interrupted.
void end_on_signals();
// From now on the first signal sets the flag that is returned, and one that comes a second later or more ends
// the program at once with exit_interrupted: mpirun, a terminal and a shell may each pass on what was meant
// as one.
const CancelFlag& cancel_on_signals();
// While it lives, signals wait, so that temporary files of another program are removed; one that came takes effect at
// its end. Child processes get the signals of a terminal themselves.
class WaitingSignals {
  public:
    WaitingSignals();
    ~WaitingSignals();
    WaitingSignals(const WaitingSignals&) = delete;
    WaitingSignals& operator=(const WaitingSignals&) = delete;
};
// From now on all signals set the flag that is returned and do nothing else: another process decides.
const CancelFlag& follow_on_signals();
// As the first signal does.
void request_cancel();
// While files are being written: signals change nothing, for the end of the program is near and one in the
// middle of a file would leave a part of it behind.
void finish_on_signals();

} // namespace montelux::app
