#include "montelux/cluster/communicator.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "montelux/mc/math/error.h"

#ifdef MONTELUX_WITH_MPI
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <algorithm>
#include <chrono>
#include <deque>
#include <list>
#include <mpi.h>
#include <sched.h>
#include <thread>
#include <utility>
#endif

namespace montelux {
namespace {

std::optional<int> number_in_environment(const char* name) {
    const char* text = std::getenv(name);
    if (text == nullptr) return std::nullopt;
    const std::string_view s(text);
    int value = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
    if (error != std::errc() || end != s.data() + s.size() || value < 0) return std::nullopt;
    return value;
}

} // namespace

std::optional<LaunchedAs> launched_as() {
    // Open MPI's mpirun; launchers that speak PMI, as MPICH's and Slurm's do; those that speak PMIx alone.
    constexpr const char* names[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                        {"PMI_RANK", "PMI_SIZE"},
                                        {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}};
    for (const auto& [rank, size] : names)
        if (const auto r = number_in_environment(rank))
            return LaunchedAs{*r, number_in_environment(size).value_or(0)};
    return std::nullopt;
}

#ifdef MONTELUX_WITH_MPI

namespace {

constexpr std::chrono::microseconds shortest_nap{50}, longest_nap{5000};
// What MPI counts is an int.
constexpr std::size_t largest_piece = std::size_t{256} << 20;

// Waits without the polling that would take a processor away from ranks beside this one.
void wait_for(MPI_Request& request) {
    int done = 0;
    std::chrono::microseconds nap = shortest_nap;
    for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); done == 0;
         MPI_Test(&request, &done, MPI_STATUS_IGNORE)) {
        std::this_thread::sleep_for(nap);
        nap = std::min(2 * nap, longest_nap);
    }
}

void broadcast_piece(void* data, std::size_t size, MPI_Comm world) {
    MPI_Request request;
    MPI_Ibcast(data, static_cast<int>(size), MPI_BYTE, 0, world, &request);
    wait_for(request);
}

} // namespace

std::string mpi_version() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING] = "";
    int length = 0;
    MPI_Get_library_version(text, &length);
    const std::string_view version(text, static_cast<std::size_t>(length));
    return std::string(version.substr(0, version.find_first_of(",\n")));
}

struct Communicator::State {
    struct Outgoing {
        std::vector<std::uint8_t> bytes;
        MPI_Request request;
    };
    // A communicator of its own, so that nobody else's messages are met.
    MPI_Comm world = MPI_COMM_NULL;
    int rank = 0, size = 1;
    std::list<Outgoing> outgoing; // MPI reads the bytes until the request is done
    std::deque<Message> to_itself;

    void forget_what_was_sent() {
        std::erase_if(outgoing, [](Outgoing& o) {
            int done = 0;
            MPI_Test(&o.request, &done, MPI_STATUS_IGNORE);
            return done != 0;
        });
    }
};

Communicator::Communicator() : state_(std::make_unique<State>()) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    if (provided < MPI_THREAD_FUNNELED) throw Error("MPI", "knows nothing of threads (MPI_THREAD_FUNNELED)");
    MPI_Comm_dup(MPI_COMM_WORLD, &state_->world);
    MPI_Comm_rank(state_->world, &state_->rank);
    MPI_Comm_size(state_->world, &state_->size);
    const auto launched = launched_as();
    if (launched &&
        (launched->rank != state_->rank || (launched->size > 0 && launched->size != state_->size)))
        throw Error("MPI", "the program was built with " + mpi_version() +
                               ", which does not know the launcher of this job; start it with the mpirun "
                               "that belongs to it, or with srun --mpi=pmix");
}

Communicator::~Communicator() {
    while (!state_->outgoing.empty()) {
        state_->forget_what_was_sent();
        std::this_thread::sleep_for(shortest_nap);
    }
    MPI_Request request;
    MPI_Ibarrier(state_->world, &request);
    wait_for(request);
    MPI_Comm_free(&state_->world);
    MPI_Finalize();
}

int Communicator::rank() const { return state_->rank; }
int Communicator::size() const { return state_->size; }

void Communicator::send(int to, int tag, std::vector<std::uint8_t> bytes) {
    if (to == state_->rank) {
        state_->to_itself.push_back({to, tag, std::move(bytes)});
        return;
    }
    state_->forget_what_was_sent();
    auto& o = state_->outgoing.emplace_back(State::Outgoing{std::move(bytes), MPI_REQUEST_NULL});
    if (o.bytes.size() > largest_piece) throw Error("MPI", "a message is too long");
    MPI_Isend(o.bytes.data(), static_cast<int>(o.bytes.size()), MPI_BYTE, to, tag, state_->world, &o.request);
}

std::optional<Message> Communicator::receive() {
    if (!state_->to_itself.empty()) {
        Message message = std::move(state_->to_itself.front());
        state_->to_itself.pop_front();
        return message;
    }
    state_->forget_what_was_sent();
    int there = 0;
    MPI_Message handle;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, state_->world, &there, &handle, &status);
    if (there == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Message message{status.MPI_SOURCE, status.MPI_TAG, {}};
    message.bytes.resize(static_cast<std::size_t>(size));
    MPI_Mrecv(message.bytes.data(), size, MPI_BYTE, &handle, &status);
    return message;
}

void Communicator::broadcast(std::vector<std::uint8_t>& bytes) {
    std::uint64_t size = bytes.size();
    broadcast_piece(&size, sizeof size, state_->world);
    bytes.resize(size);
    for (std::size_t at = 0; at < bytes.size(); at += largest_piece)
        broadcast_piece(bytes.data() + at, std::min(largest_piece, bytes.size() - at), state_->world);
}

int Communicator::fair_threads() {
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(state_->world, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    int ranks = 1;
    MPI_Comm_size(machine, &ranks);
    cpu_set_t mine;
    CPU_ZERO(&mine);
    sched_getaffinity(0, sizeof mine, &mine);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(ranks));
    MPI_Allgather(&mine, sizeof mine, MPI_BYTE, all.data(), sizeof mine, MPI_BYTE, machine);
    MPI_Comm_free(&machine);
    // Launchers bind ranks to processors of their own, or to sets that some of them share.
    const auto sharing = std::count_if(all.begin(), all.end(),
                                       [&](const cpu_set_t& other) { return CPU_EQUAL(&mine, &other); });
    return std::max(1, CPU_COUNT(&mine) / static_cast<int>(sharing));
}

void Communicator::abort(int exit_code) {
    MPI_Abort(state_->world, exit_code);
    std::_Exit(exit_code);
}

#else

std::string mpi_version() { return ""; }

struct Communicator::State {};

Communicator::Communicator() {
    throw Error("MPI", "the program was built without it, and renders in one process alone; build it where "
                       "Open MPI is installed (libopenmpi-dev), or start it without mpirun");
}
Communicator::~Communicator() = default;
int Communicator::rank() const { return 0; }
int Communicator::size() const { return 1; }
void Communicator::send(int, int, std::vector<std::uint8_t>) {}
std::optional<Message> Communicator::receive() { return std::nullopt; }
void Communicator::broadcast(std::vector<std::uint8_t>&) {}
int Communicator::fair_threads() { return 0; }
void Communicator::abort(int exit_code) { std::_Exit(exit_code); }

#endif

} // namespace montelux
