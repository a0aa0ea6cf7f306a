// montelux completion: scripts that let a shell complete commands, options and their values. The scripts ask the
// program for the words, so they hold for whatever version is installed.
#include "app/completion.h"

#include "app/commands.h"
#include "app/option_text.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string_view>

namespace montelux::app {

namespace {

struct Script {
    const char *shell, *text;
};

constexpr Script scripts[] = {
    {"bash", R"(_montelux() {
    local line
    COMPREPLY=()
    while IFS=$'\t' read -r line _; do
        COMPREPLY+=("$line")
    done < <("${COMP_WORDS[0]}" completion words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -o bashdefault -o default -F _montelux montelux
)"},
    {"zsh", R"(#compdef montelux
_montelux() {
    local line
    local -a names texts
    while IFS= read -r line; do
        names+=("${line%%$'\t'*}")
        texts+=("${line/$'\t'/  }")
    done < <("${words[1]}" completion words "${(@)words[2,CURRENT]}" 2>/dev/null)
    if (( ${#names} )); then
        compadd -l -d texts -a names
    else
        _files
    fi
}
if [ "$funcstack[1]" = "_montelux" ]; then
    _montelux "$@"
else
    compdef _montelux montelux
fi
)"},
    {"fish", R"(function __montelux_words
    set -l words (commandline -opc) (commandline -ct)
    $words[1] completion words $words[2..] 2>/dev/null
end
complete -c montelux -a '(__montelux_words)'
)"},
};

// A command line up to the word that is to be completed.
class Line {
  public:
    explicit Line(const CLI::App& program) : command_(&program) {}

    void take(std::string_view word) {
        if (word == "=") return; // bash makes words of --option=value
        if (pending_ != nullptr) {
            pending_ = nullptr;
        } else if (word.starts_with('-')) {
            if (const CLI::Option* option = find(word); option != nullptr && !is_flag(*option))
                pending_ = option;
        } else if (const CLI::App* sub = subcommand(word)) {
            command_ = sub;
        }
    }

    std::string offers(std::string_view word) const {
        const std::size_t equals = word.find('=');
        if (pending_ != nullptr) return values(*pending_, "", word == "=" ? "" : word);
        if (word.starts_with("--") && equals != std::string_view::npos) {
            const CLI::Option* option = find(word.substr(0, equals));
            return option == nullptr ? ""
                                     : values(*option, word.substr(0, equals + 1), word.substr(equals + 1));
        }
        std::string list;
        if (word.starts_with('-'))
            for (const CLI::Option* option : command_->get_options())
                for (const std::string& name : option->get_lnames())
                    offer(list, word, "--" + name, option->get_description());
        else
            for (const CLI::App* sub : command_->get_subcommands({}))
                if (!sub->get_name().empty()) offer(list, word, sub->get_name(), sub->get_description());
        if (!list.empty() || word.starts_with('-')) return list;
        for (const CLI::Option* option : command_->get_options())
            if (option->get_positional()) list += values(*option, "", word);
        return list;
    }

  private:
    const CLI::Option* find(std::string_view name) const {
        return command_->get_option_no_throw(std::string(name));
    }
    const CLI::App* subcommand(std::string_view name) const {
        for (const CLI::App* sub : command_->get_subcommands({}))
            if (sub->get_name() == name) return sub;
        return nullptr;
    }
    static void offer(std::string& list, std::string_view word, const std::string& name,
                      const std::string& help) {
        if (std::string_view(name).starts_with(word)) list += name + "\t" + help + "\n";
    }
    // Of a value that is a list, the last item; `before` is what stands before the value in the same word.
    static std::string values(const CLI::Option& option, std::string_view before, std::string_view word) {
        std::string kept(before), list;
        if (option_type(option) == "LIST")
            if (const std::size_t comma = word.rfind(','); comma != std::string_view::npos) {
                kept += word.substr(0, comma + 1);
                word.remove_prefix(comma + 1);
            }
        for (const std::string& name : option_choices(option))
            if (std::string_view(name).starts_with(word)) list += kept + name + "\t\n";
        return list;
    }

    const CLI::App* command_;
    const CLI::Option* pending_ = nullptr; // its value is the next word
};

} // namespace

std::string completions(const CLI::App& program, std::span<const char* const> words) {
    Line line(program);
    if (words.empty()) return line.offers("");
    for (const char* word : words.first(words.size() - 1)) line.take(word);
    return line.offers(words.back());
}

void add_completion(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("completion", "Print a script that lets a shell complete command lines");
    auto shell = std::make_shared<std::string>();
    command->add_option("SHELL", *shell, "The shell: bash, zsh, fish")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    command->footer("Examples:\n"
                    "  montelux completion bash >~/.local/share/bash-completion/completions/montelux\n"
                    "  montelux completion fish >~/.config/fish/completions/montelux.fish\n"
                    "  source <(montelux completion zsh)\n"
                    "\n"
                    "The packages of Debian install the scripts.");
    command->callback([shell, &exit_code] {
        for (const Script& script : scripts)
            if (*shell == script.shell) std::fputs(script.text, stdout);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
