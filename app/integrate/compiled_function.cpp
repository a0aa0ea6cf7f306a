#include "app/integrate/compiled_function.h"

#include "app/interrupt.h"
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <spawn.h>
#include <sstream>
#include <string_view>
#include <sys/wait.h>
#include <type_traits>
#include <unistd.h>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

namespace fs = std::filesystem;

struct Place {
    std::string file, function;
};

Place read_place(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    std::error_code ignored;
    if (colon == std::string::npos || fs::exists(text, ignored)) return {text, "integrand"};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

void check_file(const std::string& file) {
    std::error_code failure;
    if (!fs::exists(file, failure)) throw Error(file, "there is no such file");
    if (fs::is_directory(file, failure)) throw Error(file, "is a folder; expected FILE:FUNCTION");
}

// A folder that is removed with all it holds.
class BuildFolder {
  public:
    BuildFolder() {
        std::error_code failure;
        std::string pattern = (fs::temp_directory_path(failure) / "montelux-XXXXXX").string();
        if (failure || ::mkdtemp(pattern.data()) == nullptr)
            throw Error("temporary folder", "cannot be created; set TMPDIR to a folder that can be written");
        path_ = pattern;
    }
    ~BuildFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    BuildFolder(const BuildFolder&) = delete;
    BuildFolder& operator=(const BuildFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

void add_words(std::vector<std::string>& words, const char* variable, const char* otherwise) {
    const char* given = std::getenv(variable);
    std::istringstream text(given != nullptr && *given != '\0' ? given : otherwise);
    for (std::string word; text >> word;) words.push_back(word);
}

// Exit code of a command, whose standard output goes to standard error; throws Error where it cannot be started.
int run(const std::vector<std::string>& command, const std::string& hint) {
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t child = 0;
    const int failure = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
        throw Error(command[0], std::string("cannot be started: ") + std::strerror(failure) + "; " + hint);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw Error(command[0], std::strerror(errno));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Translates a source to a shared library at `library`.
void compile(const std::string& source, const fs::path& library) {
    const std::string extension = fs::path(source).extension().string();
    const bool c = extension == ".c";
    constexpr std::array<std::string_view, 4> of_cpp{".cpp", ".cc", ".cxx", ".C"};
    bool cpp = false;
    for (const std::string_view known : of_cpp) cpp = cpp || extension == known;
    if (!c && !cpp)
        throw Error(source,
                    "is not a source in C (.c) or C++ (.cpp, .cc, .cxx); other languages: make a shared "
                    "library of it, and pass that with --library");
    std::vector<std::string> command;
    add_words(command, c ? "CC" : "CXX", c ? "cc" : "c++");
    for (const char* word : {"-O2", "-fPIC", "-shared"}) command.emplace_back(word);
    add_words(command, c ? "CFLAGS" : "CXXFLAGS", "");
    for (const std::string& word :
         {std::string("-o"), library.string(), fs::absolute(source).string(), std::string("-lm")})
        command.push_back(word);
    const std::string hint = c ? "install a C compiler (Debian: gcc), or name one in CC"
                               : "install a C++ compiler (Debian: g++), or name one in CXX";
    if (const int code = run(command, hint); code != 0)
        throw Error(source, "the compiler " + command[0] + " ended with exit code " + std::to_string(code) +
                                "; its messages are above");
}

} // namespace

std::string CompiledFunction::file_of(const std::string& place) { return read_place(place).file; }

std::string CompiledFunction::absolute(const std::string& place) {
    const Place at = read_place(place);
    return fs::absolute(at.file).lexically_normal().string() + ":" + at.function;
}

CompiledFunction CompiledFunction::from_library(const std::string& place, Form form) {
    const Place at = read_place(place);
    check_file(at.file);
    return {fs::absolute(at.file).string(), at.function, std::move(form), at.file};
}

CompiledFunction CompiledFunction::from_source(const std::string& place, Form form) {
    const Place at = read_place(place);
    check_file(at.file);
    const WaitingSignals until_removed;
    const BuildFolder folder;
    const fs::path library = folder.path() / "integrand.so";
    compile(at.file, library);
    return {library.string(), at.function, std::move(form), at.file};
}

CompiledFunction::CompiledFunction(const std::string& file, std::string function, Form form,
                                   const std::string& place)
    : function_(std::move(function)), form_(std::move(form)) {
    std::string reason;
    std::optional<SharedLibrary> opened = SharedLibrary::open(file, reason);
    if (!opened) throw Error(place, "is not a shared library that can be loaded: " + reason);
    library_ = std::make_shared<const SharedLibrary>(std::move(*opened));
    bool found = false;
    const auto find = [&](auto& f) {
        f = library_->find<std::remove_reference_t<decltype(f)>>(function_.c_str());
        found = f != nullptr;
    };
    const bool parameters = !form_.parameters.empty();
    if (form_.components == 0)
        parameters ? find(value_with_parameters_) : find(value_);
    else
        parameters ? find(values_with_parameters_) : find(values_);
    if (!found)
        throw Error(place, "has no function '" + function_ +
                               "'; FILE:FUNCTION names another one, and functions of C++ need extern \"C\"");
}

std::vector<std::string> CompiledFunction::names() const {
    if (form_.components == 0) return {function_};
    std::vector<std::string> names;
    for (int c = 0; c < form_.components; ++c) names.push_back(function_ + "[" + std::to_string(c) + "]");
    return names;
}

void CompiledFunction::operator()(const PointBatch& x, ValueBatch y) const {
    const int n = x.dimensions(), m = form_.components;
    std::vector<double> point(static_cast<std::size_t>(n)), values(static_cast<std::size_t>(m));
    const double *const p = point.data(), *const parameters = form_.parameters.data();
    for (std::size_t i = 0; i < x.count(); ++i) {
        x.gather(i, point.data());
        // What a function forgets to write is not the value of another point.
        std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
        if (value_ != nullptr)
            y(i, 0) = value_(n, p);
        else if (value_with_parameters_ != nullptr)
            y(i, 0) = value_with_parameters_(n, p, parameters);
        else if (values_ != nullptr)
            values_(n, p, m, values.data());
        else
            values_with_parameters_(n, p, m, values.data(), parameters);
        for (int c = 0; c < m; ++c) y(i, c) = values[static_cast<std::size_t>(c)];
    }
}

} // namespace montelux::app
