// montelux manual: the help of a command as a manual page, in the macros of man(7).
#include "app/commands.h"
#include "app/option_text.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

namespace montelux::app {

namespace {

std::string roff(std::string_view text) {
    std::string out;
    if (text.starts_with('.') || text.starts_with('\'')) out += "\\&";
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-"; // a minus sign that can be copied, not a hyphen
        else if (c == '\'')
            out += "\\(aq";
        else if (c == '^')
            out += "\\(ha";
        else if (c == '~')
            out += "\\(ti";
        else if (c == '`')
            out += "\\(ga";
        else
            out += c;
    }
    return out;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

// "--output" as "-o, --output FILE".
std::string option_line(const CLI::Option& option) {
    std::string line;
    auto append = [&line](const std::string& name) { line += (line.empty() ? "" : ", ") + bold(name); };
    for (const std::string& name : option.get_snames()) append("-" + name);
    for (const std::string& name : option.get_lnames()) append("--" + name);
    if (const std::string type = option_type(option); !type.empty()) line += " " + italic(type);
    return line;
}

bool is_repeatable(const CLI::Option& option) {
    return option.get_expected_max() == CLI::detail::expected_max_vector_size;
}

// Lines that begin with spaces are shown as they stand; the rest are paragraphs.
std::string paragraphs(std::string_view text) {
    std::string out = text.starts_with("Example") ? "" : ".SH NOTES\n";
    std::istringstream lines{std::string(text)};
    bool literal = false, ended = false; // in such lines; behind a paragraph
    for (std::string line; std::getline(lines, line);) {
        const bool indented = line.starts_with("  ");
        if (indented != literal) out += indented ? ".PP\n.nf\n.RS 4\n" : ".RE\n.fi\n";
        ended = ended || (literal && !indented);
        literal = indented;
        if (line == "Examples:" || line == "Example:") {
            out += ".SH EXAMPLES\n";
        } else if (line.empty()) {
            ended = true;
        } else {
            out += (ended && !indented ? ".PP\n" : "") + roff(indented ? line.substr(2) : line) + "\n";
            ended = false;
        }
    }
    return out + (literal ? ".RE\n.fi\n" : "");
}

std::string options_of(const CLI::App& command) {
    std::string out;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_positional() || option->get_group().empty()) continue;
        out += ".TP\n" + option_line(*option) + (is_repeatable(*option) ? " ..." : "") + "\n" +
               roff(option->get_description()) + "\n";
    }
    return out;
}

std::string synopsis_of(const CLI::App& command, const std::string& name) {
    std::string out = bold(name) + " [" + italic("OPTIONS") + "]";
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional())
            out += " " + italic(option->get_name(true, false)) + (is_repeatable(*option) ? "..." : "");
    if (!command.get_subcommands({}).empty()) out += " " + italic("COMMAND");
    return out + "\n";
}

std::string positionals_of(const CLI::App& command) {
    std::string out;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional())
            out += ".TP\n" + italic(option->get_name(true, false)) + "\n" + roff(option->get_description()) +
                   "\n";
    return out;
}

std::string sentence(const std::string& text) {
    return text.empty() || text.ends_with('.') ? text : text + ".";
}

std::string page(const CLI::App& command) {
    const CLI::App* parent = command.get_parent();
    const std::string program = "montelux", dashed = parent ? program + "-" + command.get_name() : program;
    const std::string spoken = parent ? program + " " + command.get_name() : program;
    std::string upper = dashed;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));

    std::string description = command.get_description();
    if (!parent) description = description.substr(description.find(": ") + 2);
    std::string out = ".TH " + roff(upper) + " 1 \"\" \"Montelux " MONTELUX_VERSION "\" \"User Commands\"\n";
    out += ".SH NAME\n" + roff(dashed) + " \\- " + roff(description) + "\n";
    out += ".SH SYNOPSIS\n" + synopsis_of(command, spoken);
    out += ".SH DESCRIPTION\n" + roff(sentence(command.get_description())) + "\n" + positionals_of(command);
    for (const CLI::App* sub : command.get_subcommands({}))
        out += ".TP\n" + bold(sub->get_name()) + "\n" + roff(sentence(sub->get_description())) + "\n";
    out += ".SH OPTIONS\n" + options_of(command);
    if (!command.get_footer().empty()) out += paragraphs(command.get_footer());
    if (parent) // its own subcommands, such as those of bake, are sections of its page
        for (const CLI::App* sub : command.get_subcommands({})) {
            out += ".SH " + roff(spoken + " " + sub->get_name()) + "\n" +
                   synopsis_of(*sub, spoken + " " + sub->get_name()) + ".PP\n" +
                   roff(sentence(sub->get_description())) + "\n" + positionals_of(*sub) + options_of(*sub);
        }
    out += ".SH SEE ALSO\n";
    if (parent) return out + bold(program) + "(1)\n";
    std::string list;
    for (const CLI::App* sub : command.get_subcommands({}))
        list += (list.empty() ? "" : ",\n") + bold(program + "-" + sub->get_name()) + "(1)";
    return out + list + "\n";
}

} // namespace

void add_manual(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("manual", "Print a manual page, for 'man -l -'");
    auto name = std::make_shared<std::string>();
    command->add_option("COMMAND", *name, "The command. Default: the page of the program");
    command->footer("Example:\n"
                    "  montelux manual render | man -l -");
    command->callback([name, &app, &exit_code] {
        const CLI::App* described = name->empty() ? &app : nullptr;
        for (const CLI::App* sub : app.get_subcommands({}))
            if (sub->get_name() == *name) described = sub;
        if (described == nullptr) throw UsageError("COMMAND", "there is no command '" + *name + "'");
        std::fputs(page(*described).c_str(), stdout);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
