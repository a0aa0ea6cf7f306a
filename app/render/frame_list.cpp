#include "app/render/frame_list.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <unordered_set>

namespace montelux::app {
namespace {

// Takes a frame's number off the front of the text.
std::optional<std::uint32_t> take_number(std::string_view& text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 1 || number > most_frames) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
}

} // namespace

std::optional<std::vector<std::uint32_t>> parse_frames(std::string_view text) {
    std::vector<std::uint32_t> frames;
    std::unordered_set<std::uint32_t> known;
    do {
        const std::optional<std::uint32_t> first = take_number(text);
        std::optional<std::uint32_t> last = first, step = 1;
        if (take(text, '-')) {
            last = take_number(text);
            if (take(text, 'x')) step = take_number(text);
        }
        if (!first || !last || !step || *last < *first) return std::nullopt;
        for (std::uint32_t frame = *first; frame <= *last; frame += *step)
            if (known.insert(frame).second) frames.push_back(frame);
    } while (take(text, ','));
    if (!text.empty()) return std::nullopt;
    return frames;
}

std::string frames_text(const std::vector<std::uint32_t>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        text += (i == 0 ? "" : ",") + std::to_string(frames[i]);
        if (end > i + 1) text += "-" + std::to_string(frames[end - 1]);
        i = end;
    }
    return text;
}

std::string frame_file(const std::string& output, std::uint32_t frame) {
    const std::filesystem::path path = output;
    char number[16];
    std::snprintf(number, sizeof number, ".%04u", frame);
    return (path.parent_path() / (path.stem().string() + number + path.extension().string())).string();
}

} // namespace montelux::app
