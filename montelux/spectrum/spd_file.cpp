#include "montelux/spectrum/spd_file.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr std::uintmax_t largest_file = 16u << 20;

struct NumberAtLine {
    float value;
    int line;
};

bool is_separator(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ','; }

std::string at_line(std::string_view where, int line) {
    return std::string(where) + ":" + std::to_string(line);
}

std::vector<NumberAtLine> read_numbers(std::string_view text, std::string_view where) {
    std::vector<NumberAtLine> numbers;
    int line = 1;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == '#') {
            while (i < text.size() && text[i] != '\n') ++i;
        } else if (is_separator(text[i])) {
            if (text[i] == '\n') ++line;
            ++i;
        } else {
            std::size_t end = i;
            while (end < text.size() && !is_separator(text[end]) && text[end] != '#') ++end;
            std::string_view word = text.substr(i, end - i);
            if (word.starts_with('+')) word.remove_prefix(1);
            float value = 0;
            auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc{} || rest != word.data() + word.size() || !std::isfinite(value))
                throw Error(at_line(where, line), "read \"" + std::string(word.substr(0, 40)) +
                                                      "\" where a finite number was expected");
            numbers.push_back({value, line});
            i = end;
        }
    }
    return numbers;
}

} // namespace

PiecewiseLinear parse_spd(std::string_view text, std::string_view where) {
    std::vector<NumberAtLine> numbers = read_numbers(text, where);
    if (numbers.empty())
        throw Error(where, "the file holds no numbers; pairs of wavelength and value were expected");
    if (numbers.size() % 2 != 0)
        throw Error(at_line(where, numbers.back().line),
                    "the last wavelength has no value: the file holds " + std::to_string(numbers.size()) +
                        " numbers, and pairs of wavelength and value were expected");
    std::vector<float> lambda, values;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (!lambda.empty() && !(numbers[i].value > lambda.back()))
            throw Error(at_line(where, numbers[i].line),
                        "the wavelength " + std::to_string(numbers[i].value) + " nm does not come after " +
                            std::to_string(lambda.back()) + " nm; wavelengths must ascend");
        lambda.push_back(numbers[i].value);
        values.push_back(numbers[i + 1].value);
    }
    return {lambda, values};
}

PiecewiseLinear read_spd_file(const std::filesystem::path& path) {
    std::error_code error;
    auto size = std::filesystem::file_size(path, error);
    if (error) throw Error(path.string(), "cannot read the spectrum file: " + error.message());
    if (size > largest_file)
        throw Error(path.string(),
                    "the file has " + std::to_string(size) + " bytes; a spectrum has at most 16 MiB");
    std::ifstream in(path, std::ios::binary);
    std::string text(size, '\0');
    if (!in.read(text.data(), static_cast<std::streamsize>(size)))
        throw Error(path.string(), "cannot read the spectrum file");
    return parse_spd(text, path.string());
}

} // namespace montelux
