#include "montelux/cluster/communicator.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "montelux/mc/math/error.h"

#ifdef MONTELUX_WITH_MPI
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
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
    // Open MPI's mpirun; launchers with PMI, such as MPICH's and Slurm's; those with PMIx only.
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
// MPI counts are ints.
constexpr std::size_t largest_message = std::size_t{256} << 20;
// Piece of a broadcast: healthy ranks take one quickly on a slow network, too.
constexpr std::size_t broadcast_piece = std::size_t{16} << 20;
constexpr double without_limit = std::numeric_limits<double>::infinity();

// Waits without busy polling, which would take a processor from other ranks; calls meanwhile() in between.
// False: not done in this time.
template <typename Done, typename Meanwhile>
bool wait_until(const Done& done, double patience_seconds, const Meanwhile& meanwhile) {
    const auto begin = std::chrono::steady_clock::now();
    std::chrono::microseconds nap = shortest_nap;
    while (!done()) {
        meanwhile();
        const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
        if (waited.count() > patience_seconds) return false;
        std::this_thread::sleep_for(nap);
        nap = std::min(2 * nap, longest_nap);
    }
    return true;
}

bool is_done(MPI_Request& request) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    return done != 0;
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
    // A communicator of its own, so that its messages are separate.
    MPI_Comm world = MPI_COMM_NULL;
    int rank = 0, size = 1;
    std::list<Outgoing> outgoing; // MPI reads the bytes until the request is done
    std::deque<Message> to_itself;
    std::vector<std::uint8_t> stuck; // a broadcast that MPI may still read
    std::uint64_t broadcast_size = 0;
    bool broken = false, left = false;

    void forget_what_was_sent() {
        std::erase_if(outgoing, [](Outgoing& o) { return is_done(o.request); });
    }
    bool broadcast_some(void* data, std::size_t bytes, double patience_seconds) const {
        MPI_Request request;
        MPI_Ibcast(data, static_cast<int>(bytes), MPI_BYTE, 0, world, &request);
        return wait_until([&] { return is_done(request); }, rank == 0 ? patience_seconds : without_limit,
                          [] {});
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
    if (!state_->left) leave(without_limit);
}

bool Communicator::leave(double patience_seconds) {
    state_->left = true;
    if (state_->broken) return false;
    // Long messages are only sent when they are received, and the receiver may have stopped listening.
    const auto listen = [this] {
        while (receive()) {
        }
    };
    const auto all_sent = [this] {
        state_->forget_what_was_sent();
        return state_->outgoing.empty();
    };
    MPI_Request request;
    bool waiting = false;
    const auto all_here = [&] {
        if (!waiting && !all_sent()) return false;
        if (!std::exchange(waiting, true)) MPI_Ibarrier(state_->world, &request);
        return is_done(request);
    };
    if (!wait_until(all_here, patience_seconds, listen)) return false;
    MPI_Comm_free(&state_->world);
    MPI_Finalize();
    return true;
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
    if (o.bytes.size() > largest_message) throw Error("MPI", "a message is too long");
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

void Communicator::broadcast(std::vector<std::uint8_t>& bytes, double patience_seconds) {
    State& s = *state_;
    s.broadcast_size = bytes.size();
    bool taken = s.broadcast_some(&s.broadcast_size, sizeof s.broadcast_size, patience_seconds);
    bytes.resize(s.broadcast_size);
    for (std::size_t at = 0; at < bytes.size() && taken; at += broadcast_piece)
        taken = s.broadcast_some(bytes.data() + at, std::min(broadcast_piece, bytes.size() - at),
                                 patience_seconds);
    if (taken) return;
    s.broken = true;
    s.stuck = std::move(bytes);
    char text[120];
    std::snprintf(text, sizeof text,
                  "a rank has taken nothing of what was sent to all for %.0f s and is given up",
                  patience_seconds);
    throw Error("MPI", text);
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
    // Launchers bind ranks to their own processors, or to sets that several share.
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
void Communicator::broadcast(std::vector<std::uint8_t>&, double) {}
bool Communicator::leave(double) { return true; }
int Communicator::fair_threads() { return 0; }
void Communicator::abort(int exit_code) { std::_Exit(exit_code); }

#endif

} // namespace montelux
