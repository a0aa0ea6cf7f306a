// The ranks of an MPI job; only this file and its source use MPI.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/mailbox.h"

namespace montelux {

// Was the program built with MPI? Its version if so, "" otherwise.
std::string mpi_version();

// Rank and size by the launcher's (mpirun, srun) environment, before MPI is started.
struct LaunchedAs {
    int rank = 0, size = 1; // size 0: unknown
};
// Empty for a program started without a launcher.
std::optional<LaunchedAs> launched_as();

// The whole job. One per process, used by one thread. Its destructor waits for the other ranks; leave() sets
// a limit. An error within MPI ends the job.
class Communicator final : public Mailbox {
  public:
    // Throws Error when the program was built without MPI, or MPI does not recognise the launcher.
    Communicator();
    ~Communicator() override;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    int rank() const override;
    int size() const override;
    void send(int to, int tag, std::vector<std::uint8_t> bytes) override;
    std::optional<Message> receive() override;

    // Broadcasts the bytes of rank 0. All ranks call it; waiting takes hardly any processor time. Throws
    // Error on rank 0 if the others take nothing for this time; they wait for rank 0 without a limit.
    void broadcast(std::vector<std::uint8_t>& bytes, double patience_seconds);
    // Threads for each rank, so that those on one machine fill the processors that they may use. All ranks
    // call it.
    int fair_threads();
    // Waits for all ranks to call it, at most this long. True: MPI has ended. False: some are missing, and
    // only abort() can follow.
    bool leave(double patience_seconds);
    // Ends all ranks at once.
    [[noreturn]] void abort(int exit_code);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace montelux
