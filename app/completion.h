// The words that can follow on a command line.
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace montelux::app {

// One line for each completion of the last word: the word, a tab, and what it is. `words` come after the name
// of the program. Empty where a file name or a value without a list is expected.
std::string completions(const CLI::App& program, std::span<const char* const> words);

} // namespace montelux::app
