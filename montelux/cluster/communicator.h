// The ranks of an MPI job; the only file but its source that knows of MPI.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/cluster/mailbox.h"

namespace montelux {

// Was the program built with MPI? Its version if so, "" otherwise.
std::string mpi_version();

// What the launcher (mpirun, srun) says in the environment, before MPI is started.
struct LaunchedAs {
    int rank = 0, size = 1; // size 0: not said
};
// Empty for a program that was started alone.
std::optional<LaunchedAs> launched_as();

// The whole job. One lives at a time, and only one in the life of a process; its thread is the one that uses
// it. Other ranks are waited for at its end, which leave() gives a limit. An error within MPI ends the job.
class Communicator final : public Mailbox {
  public:
    // Throws Error when the program was built without MPI, or MPI does not know of the launcher.
    Communicator();
    ~Communicator() override;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    int rank() const override;
    int size() const override;
    void send(int to, int tag, std::vector<std::uint8_t> bytes) override;
    std::optional<Message> receive() override;

    // What rank 0 has becomes what every rank has. All ranks call it; waiting takes no processor time to
    // speak of. Throws Error on rank 0 where the others take nothing of it for so long; they wait for rank 0
    // without a limit.
    void broadcast(std::vector<std::uint8_t>& bytes, double patience_seconds);
    // Threads for each rank, so that those on one machine fill the processors that they may use. All ranks
    // call it.
    int fair_threads();
    // Waits until all ranks have come to this, and so long at most. True: that was the end of MPI. False:
    // some have not come, and nothing but abort() can follow.
    bool leave(double patience_seconds);
    // Ends all ranks at once.
    [[noreturn]] void abort(int exit_code);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace montelux
