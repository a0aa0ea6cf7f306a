// The program as one rank of an MPI job: who speaks, who leads, and how the others get the scene.
#pragma once

#include <string>

namespace montelux {
class Communicator;
}

namespace montelux::app {

// Seconds. A leader that writes a checkpoint to a slow disk says nothing meanwhile.
inline constexpr double patience_with_leader = 600;
// Of the leader with the others, where no option says otherwise.
inline constexpr double patience_with_ranks = 60;

// Is this one of several processes that mpirun or srun started, and not the one that speaks, rank 0?
bool is_silent_rank();
// Sends what a silent rank prints nowhere: every rank says the same. Call it before anything is printed.
void silence_other_ranks();
// Says something all the same, on the standard error that the process was started with.
void speak_up(const std::string& message);
// For a silent rank that cannot begin: rank 0 cannot either, says why, and its end ends the job. Launchers
// kill all ranks when one ends with a mistake, so this one waits; should it be the only one, it speaks up
// after all.
void wait_for_the_speaker(const std::string& message);

// The job, where there is one: null for a program that was started alone. It lasts until leave_job(). Throws
// Error.
Communicator* join_job(double patience_seconds);
// The end of a rank that has said its last word. Rank 0 waits for the others for the patience that it joined
// with, and then ends the job with its exit code: ranks that hang must not keep what is done from its end.
void leave_job(int exit_code);
// Ends the job at once, for there are ranks that cannot be waited for.
[[noreturn]] void end_job(int exit_code);

} // namespace montelux::app
