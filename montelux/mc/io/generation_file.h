// A file that survives crashes and damage: checksummed, replaced atomically, kept with the previous
// generation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace montelux {

// The name of the previous generation: PATH.previous. A symbolic link is followed, as in writing.
std::filesystem::path previous_generation(const std::filesystem::path& path);

// Is there a file of either generation, whole or not?
bool generation_exists(const std::filesystem::path& path);

// Writes the payload; the present file, if it is whole and of this kind, becomes the previous generation. At
// every moment, even after the end of the process or a loss of power, at least one whole generation exists if
// there was one. `kind` names the payload, in 1 to 31 bytes. Throws Error. A failure leaves the present file
// unchanged, except a failure to make the new names permanent, which leaves the new file; the previous
// generation is then the present file or the previous one.
void write_generation(const std::filesystem::path& path, std::string_view kind,
                      std::span<const std::uint8_t> payload);

// Throws the Error that write_generation would throw for a reason known now: a missing or read-only folder, a
// path that is a folder, a name too long for the suffix.
void check_generation_writable(const std::filesystem::path& path);

struct Generation {
    std::vector<std::uint8_t> payload;
    bool previous = false;              // it is that of PATH.previous,
    std::string newest_refused_because; // for this reason: a sentence with the path
};

// The newest generation that is whole. Throws Error with the reasons if neither is: missing, not such a file,
// of another version or kind, cut short, lengthened, damaged, or of more than `max_bytes` of payload, which
// is found before memory is allocated. A file damaged at random passes with a probability of 2^-128.
Generation read_generation(const std::filesystem::path& path, std::string_view kind, std::size_t max_bytes);

} // namespace montelux
