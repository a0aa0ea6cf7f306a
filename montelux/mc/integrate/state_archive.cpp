#include "montelux/mc/integrate/state_archive.h"

#include <cstring>
#include <utility>

#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::string_view magic = "montelux";
constexpr std::uint64_t version = 1;
constexpr std::size_t max_bytes = std::size_t{1} << 32;

static_assert(std::endian::native == std::endian::little, "state files are written as they stand in memory");

std::uint64_t checksum(std::span<const std::uint64_t> words) {
    std::uint64_t sum = hash_key(words.size());
    for (std::uint64_t w : words) sum = mix64(sum ^ w) + golden_gamma;
    return sum;
}

std::uint64_t name_word(std::string_view text) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data(), std::min<std::size_t>(text.size(), sizeof word));
    return word;
}

} // namespace

void StateWriter::put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    for (std::size_t i = 0; i < text.size(); i += 8) put(name_word(text.substr(i, 8)));
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
        if (word != name_word(std::string_view(text).substr(i, 8)))
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
    StateWriter header;
    header.put(name_word(magic));
    header.put(version);
    header.put(kind);
    header.put(static_cast<std::uint64_t>(state.words().size()));
    header.put(checksum(state.words()));
    AtomicFile file(path);
    for (std::span<const std::uint64_t> words : {header.words(), state.words()})
        file.write(words.data(), words.size_bytes());
    file.commit();
}

StateReader read_state(const std::string& path, std::string_view kind) {
    const std::vector<std::uint8_t> bytes = read_file_bytes(path, max_bytes);
    std::vector<std::uint64_t> words(bytes.size() / 8);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 8);
    StateReader reader(std::move(words));
    try {
        if (reader.at_end() || reader.get_word() != name_word(magic))
            throw Error(path, "is not a saved state of Montelux");
        if (bytes.size() % 8 != 0) throw Error(path, "is damaged: it does not end with a whole number");
        const std::uint64_t found = reader.get_word();
        if (found != version)
            throw Error(path, "was saved in version " + std::to_string(found) + " of the format; expected " +
                                  std::to_string(version));
        const std::string of = reader.get_text();
        if (of != kind)
            throw Error(path, "holds the state of '" + of + "'; expected '" + std::string(kind) + "'");
        const std::uint64_t size = reader.get_word(), sum = reader.get_word();
        std::vector<std::uint64_t> rest;
        while (!reader.at_end()) rest.push_back(reader.get_word());
        if (rest.size() != size || checksum(rest) != sum)
            throw Error(path, "is damaged: its checksum does not fit");
        return StateReader(std::move(rest));
    } catch (const Error& error) {
        if (std::string_view(error.what()).starts_with(path)) throw;
        throw Error(path, std::string("is damaged: ") + error.what());
    }
}

} // namespace montelux
