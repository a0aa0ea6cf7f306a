// A file that outlives crashes and damage: checksummed, replaced at one stroke, with the generation before
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace montelux {

// The name of the generation before: PATH.previous. A symbolic link is followed, as in writing.
std::filesystem::path previous_generation(const std::filesystem::path& path);

// Is there a file of either generation, whole or not?
bool generation_exists(const std::filesystem::path& path);

// Writes the payload and makes the present file, if it is whole and of this kind, the generation before.
// At every moment, also after the end of the process or a loss of power, at least one whole generation
// exists if there was one. `kind` names what the payload is, in 1 to 31 bytes.
// Throws Error. A failure leaves the present file as it is, but for one in making the new names permanent,
// which leaves the new file; the generation before may then be the present one or the one before it.
void write_generation(const std::filesystem::path& path, std::string_view kind,
                      std::span<const std::uint8_t> payload);

// Throws the Error that write_generation would meet for a reason that is known now: a missing or read-only
// folder, a path that is a folder, a name that is too long with what is added to it.
void check_generation_writable(const std::filesystem::path& path);

struct Generation {
    std::vector<std::uint8_t> payload;
    bool previous = false;              // it is that of PATH.previous,
    std::string newest_refused_because; // for this reason: a sentence with the path
};

// The newest generation that is whole. Throws Error with the reasons if neither is: missing, not such a file,
// of another version or kind, cut short, lengthened, damaged, or of more than `max_bytes` of payload, which
// is found before memory is asked for. A file damaged at random passes with a probability of 2^-128.
Generation read_generation(const std::filesystem::path& path, std::string_view kind, std::size_t max_bytes);

} // namespace montelux
