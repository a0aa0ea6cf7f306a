#include "montelux/mc/io/system_compiler.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

namespace fs = std::filesystem;

void add_words(std::vector<std::string>& words, const char* variable, const char* otherwise) {
    const char* given = std::getenv(variable);
    std::istringstream text(given != nullptr && *given != '\0' ? given : otherwise);
    for (std::string word; text >> word;) words.push_back(word);
}

// Exit code of a command whose output goes to the file `log`, or to standard error where that is empty; throws Error
// where it cannot be started.
int run(const std::vector<std::string>& command, const std::string& log, const std::string& hint) {
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!log.empty())
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
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

std::string text_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

} // namespace

BuildFolder::BuildFolder() {
    std::error_code failure;
    std::string pattern = (fs::temp_directory_path(failure) / "montelux-XXXXXX").string();
    if (failure || ::mkdtemp(pattern.data()) == nullptr)
        throw Error("temporary folder", "cannot be created; set TMPDIR to a folder that can be written");
    path_ = pattern;
}

BuildFolder::~BuildFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void compile(const Compilation& c) {
    const bool in_c = c.language == Compilation::Language::c;
    std::vector<std::string> command;
    add_words(command, in_c ? "CC" : "CXX", in_c ? "cc" : "c++");
    for (const char* word : {"-O2", "-fPIC", "-shared"}) command.emplace_back(word);
    command.insert(command.end(), c.options.begin(), c.options.end());
    add_words(command, in_c ? "CFLAGS" : "CXXFLAGS", "");
    command.insert(command.end(), c.overrides.begin(), c.overrides.end());
    for (const std::string& word :
         {std::string("-o"), c.library.string(), fs::absolute(c.source).string(), std::string("-lm")})
        command.push_back(word);
    const std::string hint = in_c ? "install a C compiler (Debian: gcc), or name one in CC"
                                  : "install a C++ compiler (Debian: g++), or name one in CXX";
    const bool shown = c.messages == Compilation::Messages::shown;
    const std::string log = shown ? std::string() : c.library.string() + ".log";
    const int code = run(command, log, hint);
    if (code == 0) return;
    throw Error(c.name.empty() ? c.source.string() : c.name,
                "the compiler " + command[0] + " ended with exit code " + std::to_string(code) +
                    (shown ? "; its messages are above" : ":\n" + text_of(log)));
}

} // namespace montelux
