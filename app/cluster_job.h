// The program as one rank of an MPI job: which rank prints, which leads, and how the job ends.
#pragma once

#include <string>

namespace montelux {
class Communicator;
}

namespace montelux::app {

// Seconds. A leader that writes a checkpoint to a slow disk does not answer meanwhile.
inline constexpr double patience_with_leader = 600;
// Default timeout of the leader for the others.
inline constexpr double patience_with_ranks = 60;

// Whether this process was started by mpirun or srun and is not rank 0, which alone prints.
bool is_silent_rank();
// Discards the output of silent ranks, which repeats that of rank 0. Call it before anything is printed.
void silence_other_ranks();
// Prints an error even from a silent rank, on the standard error that the process was started with.
void print_rank_error(const std::string& message);
// For a silent rank that cannot start. Rank 0 normally fails too, prints the reason and ends the job.
// Launchers kill all ranks when one fails, so this one waits; if rank 0 did not fail, it prints the message
// itself.
void wait_for_rank_0(const std::string& message);

// The job, where there is one: null for a program that was started alone. It lasts until leave_job(). Throws
// Error.
Communicator* join_job(double patience_seconds);
// Call at the end of a rank. Rank 0 waits for the others for `patience_seconds`, and then ends the job with
// its exit code, so that hanging ranks cannot keep a finished job running.
void leave_job(int exit_code);
// Ends the job at once, without waiting for ranks that do not answer.
[[noreturn]] void end_job(int exit_code);

} // namespace montelux::app
