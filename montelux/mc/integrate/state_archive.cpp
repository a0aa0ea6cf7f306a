#include "montelux/mc/integrate/state_archive.h"

#include <cstring>
#include <utility>

#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 32;

static_assert(std::endian::native == std::endian::little, "state files are written as they are in memory");

std::uint64_t text_word(std::string_view text) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data(), std::min<std::size_t>(text.size(), sizeof word));
    return word;
}

} // namespace

void StateWriter::put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    for (std::size_t i = 0; i < text.size(); i += 8) put(text_word(text.substr(i, 8)));
}

std::uint64_t StateReader::get_word() {
    if (next_ == words_.size()) throw Error("the saved state ends too early");
    return words_[next_++];
}

std::size_t StateReader::get_size() {
    const std::uint64_t size = get_word();
    if (size > words_.size() - next_) throw Error("the saved state ends too early");
    return size;
}

std::string StateReader::get_text() {
    const std::uint64_t size = get_word();
    if (size / 8 > words_.size() - next_) throw Error("the saved state ends too early");
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; i += 8) {
        const std::uint64_t word = get_word();
        std::memcpy(text.data() + i, &word, std::min<std::size_t>(8, size - i));
        if (word != text_word(std::string_view(text).substr(i, 8)))
            throw Error("the saved state has a text that does not end where it should");
    }
    return text;
}

std::vector<double> StateReader::get_doubles() {
    std::vector<double> values(get_size());
    for (double& x : values) x = get_double();
    return values;
}

void write_state(const std::string& path, std::string_view kind, const StateWriter& state) {
    const auto words = state.words();
    write_generation(path, kind, {reinterpret_cast<const std::uint8_t*>(words.data()), words.size_bytes()});
}

SavedState read_state(const std::string& path, std::string_view kind) {
    Generation saved = read_generation(path, kind, max_bytes);
    if (saved.payload.size() % 8 != 0) throw Error(path, "is damaged: it does not end with a whole number");
    std::vector<std::uint64_t> words(saved.payload.size() / 8);
    if (!words.empty()) std::memcpy(words.data(), saved.payload.data(), saved.payload.size());
    return {StateReader(std::move(words)), std::move(saved.newest_refused_because)};
}

} // namespace montelux
