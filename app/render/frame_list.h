// Frames of a sequence: which ones, and the names of their files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::app {

inline constexpr std::uint32_t most_frames = 1'000'000;

// "1-48", "1-48x2" (every second one), "1,5,9", and lists of these; frames from 1 to most_frames, each once, in the
// order given. Empty for other text.
std::optional<std::vector<std::uint32_t>> parse_frames(std::string_view text);

// The shortest such list of growing frames: "1-20,22".
std::string frames_text(const std::vector<std::uint32_t>& frames);

// out.png -> out.0001.png: the number, of four digits or more, before the extension.
std::string frame_file(const std::string& output, std::uint32_t frame);

} // namespace montelux::app
