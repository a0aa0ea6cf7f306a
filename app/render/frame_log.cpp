#include "app/render/frame_log.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>

#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/value_hash.h"

namespace montelux::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "montelux frames 1";
constexpr std::size_t most_bytes = std::size_t{256} << 20;

// Empty for a file that is not there, or cannot be read.
std::optional<ContentDigest> digest_of_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    try {
        InputFile file(path);
        ValueHash hash;
        std::vector<std::uint8_t> block(std::size_t{1} << 20);
        for (std::uint64_t left = file.size(); left > 0;) {
            const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
            const std::span<std::uint8_t> part = std::span(block).first(size);
            file.read(part);
            hash.add_bytes(part.data(), size);
            left -= size;
        }
        return hash.value();
    } catch (const Error&) {
        return std::nullopt;
    }
}

// A picture may have such a name; a line may not.
bool fits_a_line(std::string_view name) { return name.find('\n') == std::string_view::npos; }

} // namespace

FrameLog::FrameLog(const std::string& output) : path_(fs::path(output).replace_extension(".frames")) {
    read();
}

std::string FrameLog::name_of(const std::string& file) const {
    return fs::absolute(file)
        .lexically_normal()
        .lexically_relative(fs::absolute(path_).lexically_normal().parent_path())
        .string();
}

std::map<std::string, FrameLog::Entry> FrameLog::read() const {
    std::map<std::string, Entry> entries;
    std::error_code error;
    if (!fs::exists(path_, error)) return entries;
    const std::vector<std::uint8_t> bytes = read_file_bytes(path_, most_bytes);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto take_line = [&text] {
        const std::string line(text.substr(0, text.find('\n')));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        return line;
    };
    if (take_line() != first_line)
        throw Error(path_.string(), "the finished frames are kept in a file of this name, and this one is "
                                    "another; move it, or choose another output");
    while (!text.empty()) {
        const std::string line = take_line();
        Entry e;
        std::array<char, 32> exposure{};
        int name = 0;
        // Other lines are those of a log that someone edited: their frames are rendered again.
        if (std::sscanf(line.c_str(), "%16" SCNx64 " %16" SCNx64 "%16" SCNx64 " %31s %n", &e.settings,
                        &e.content.high, &e.content.low, exposure.data(), &name) != 4 ||
            name == 0)
            continue;
        char* end = nullptr;
        const float stops = std::strtof(exposure.data(), &end);
        if (end != exposure.data()) e.exposure = stops;
        entries[line.substr(static_cast<std::size_t>(name))] = e;
    }
    return entries;
}

std::optional<FrameLog::Finished> FrameLog::find(const std::vector<std::string>& files,
                                                 std::uint64_t settings) const {
    const std::map<std::string, Entry> entries = read();
    Finished finished;
    for (const std::string& file : files) {
        const auto entry = entries.find(name_of(file));
        if (entry == entries.end() || entry->second.settings != settings) return std::nullopt;
        if (digest_of_file(file) != entry->second.content) return std::nullopt;
        if (!finished.exposure) finished.exposure = entry->second.exposure;
    }
    return finished;
}

void FrameLog::add(const std::vector<std::string>& files, std::uint64_t settings,
                   std::optional<float> exposure) {
    std::map<std::string, Entry> entries = read();
    for (const std::string& file : files) {
        const std::optional<ContentDigest> content = digest_of_file(file);
        const std::string name = name_of(file);
        if (content && fits_a_line(name)) entries[name] = {settings, *content, exposure};
    }
    std::string text = std::string(first_line) + '\n';
    for (const auto& [name, e] : entries) {
        std::array<char, 128> line{};
        std::snprintf(line.data(), line.size(), "%016" PRIx64 " %016" PRIx64 "%016" PRIx64 " ", e.settings,
                      e.content.high, e.content.low);
        text += line.data();
        if (e.exposure) {
            std::snprintf(line.data(), line.size(), "%.9g ", static_cast<double>(*e.exposure));
            text += line.data();
        } else {
            text += "- ";
        }
        text += name + '\n';
    }
    AtomicFile file(path_);
    file.write(text.data(), text.size());
    file.commit();
}

} // namespace montelux::app
