#include "app/integrate/density_notes.h"

#include "app/integrate/compiled_function.h"
#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "montelux/mc/io/file.h"
#include "montelux/mc/io/siphash.h"

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
constexpr const char* digest_note = "function_digest"; // of the bytes of the source or library
constexpr std::size_t most_function_bytes = std::size_t{1} << 30;

std::string digest_of(const std::string& place) {
    SipHash128 hash(0, 0);
    hash.add(read_file_bytes(CompiledFunction::file_of(place), most_function_bytes));
    char text[40];
    const auto digest = hash.digest();
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(digest[0]),
                  static_cast<unsigned long long>(digest[1]));
    return text;
}

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
        if (!notes[name].empty()) {
            notes[name] = CompiledFunction::absolute(notes[name]);
            notes[digest_note] = digest_of(notes[name]);
        }
    if (options.log) notes[log_note] = "yes";
    return notes;
}

std::string changed_function(const std::map<std::string, std::string>& notes) {
    const auto digest = notes.find(digest_note);
    for (const char* name : {"library", "source"}) {
        const auto place = notes.find(name);
        if (digest == notes.end() || place == notes.end() || place->second.empty()) continue;
        if (digest_of(place->second) != digest->second)
            return "'" + CompiledFunction::file_of(place->second) +
                   "' has changed since the density was trained; samples follow the function as it is now";
    }
    return "";
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
