#include "app/integrate/density_notes.h"

#include "app/integrate/compiled_function.h"
#include <algorithm>
#include <utility>
#include <vector>

namespace montelux::app {
namespace {

// The options by name; lists have an entry a line.
constexpr std::pair<const char*, std::vector<std::string> IntegrateOptions::*> lists[] = {
    {"formulas", &IntegrateOptions::formulas},
    {"let", &IntegrateOptions::let},
    {"over", &IntegrateOptions::over},
    {"density", &IntegrateOptions::densities}};
constexpr std::pair<const char*, std::string IntegrateOptions::*> single_texts[] = {
    {"library", &IntegrateOptions::library},       {"source", &IntegrateOptions::source},
    {"components", &IntegrateOptions::components}, {"domain", &IntegrateOptions::domain},
    {"radius", &IntegrateOptions::radius},         {"centre", &IntegrateOptions::centre}};
constexpr const char* log_note = "log";

} // namespace

std::map<std::string, std::string> density_notes(const IntegrateOptions& options) {
    std::map<std::string, std::string> notes;
    for (const auto& [name, member] : lists)
        for (std::string line : options.*member) {
            std::ranges::replace(line, '\n', ' ');
            notes[name] += line + "\n";
        }
    for (const auto& [name, member] : single_texts) notes[name] = options.*member;
    for (const char* name : {"library", "source"})
        if (!notes[name].empty()) notes[name] = CompiledFunction::absolute(notes[name]);
    if (options.log) notes[log_note] = "yes";
    return notes;
}

IntegrateOptions options_of_notes(const std::map<std::string, std::string>& notes, const std::string& path) {
    const auto given = [&notes](const char* name) {
        const auto found = notes.find(name);
        return found != notes.end() && !found->second.empty();
    };
    if (!given("formulas") && !given("library") && !given("source"))
        throw Error(path, "holds a density without its integrand; expected a file that `montelux integrate "
                          "--save-density` wrote");
    IntegrateOptions options;
    for (const auto& [name, member] : lists) {
        const auto found = notes.find(name);
        if (found == notes.end()) continue;
        const std::string& text = found->second;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            (options.*member).push_back(text.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    for (const auto& [name, member] : single_texts)
        if (const auto found = notes.find(name); found != notes.end()) options.*member = found->second;
    options.log = notes.contains(log_note);
    return options;
}

} // namespace montelux::app
