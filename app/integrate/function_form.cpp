#include "app/integrate/function_form.h"

#include "app/usage_error.h"
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "montelux/mc/io/system_compiler.h"

namespace montelux::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array<FunctionForm, 4> forms{{{false, false}, {false, true}, {true, false}, {true, true}}};
constexpr std::size_t no_form = forms.size();

// `of_x`, `of_parameters`: qualifiers of the values that are read.
std::string declaration(const FunctionForm& form, const std::string& name, std::string_view of_x = "const ",
                        std::string_view of_parameters = "const ") {
    std::string text = form.components ? "void " : "double ";
    text.append(name).append("(int n, ").append(of_x).append("double *x");
    if (form.components) text += ", int m, double *y";
    if (form.parameters) text.append(", ").append(of_parameters).append("double *parameters");
    return text + ")";
}

// All declarations of a form, each of a pointer; functions that lack a `const` are called as others.
std::vector<std::string> declarations(const FunctionForm& form, const std::string& name) {
    std::vector<std::string> all;
    for (const char* of_x : {"const ", ""})
        for (const char* of_parameters : {"const ", ""}) {
            if (!form.parameters && *of_parameters == '\0') continue;
            all.push_back(declaration(form, name, of_x, of_parameters));
        }
    return all;
}

// What the compiler prints where a function is of a form; its source has the words apart, lest it quotes them.
std::string message(std::size_t form) { return "montelux form " + std::to_string(form); }
std::string message_source(std::size_t form) { return R"("montelux " "form )" + std::to_string(form) + '"'; }

// A source that includes another one and does not compile where a function in it is of one of the `refused` forms.
std::string probe(const std::string& source, const std::string& function, bool c,
                  const std::vector<std::size_t>& refused) {
    std::string text = "#include \"" + fs::absolute(source).string() + "\"\n";
    if (c) text += "enum { montelux_form = _Generic(&" + function + ",\n";
    for (std::size_t k = 0; k < forms.size(); ++k)
        for (const std::string& pointer : declarations(forms[k], c ? "(*)" : "(*f)"))
            text +=
                c ? pointer + ": " + std::to_string(k) + ",\n"
                  : "constexpr int montelux_form(" + pointer + ") { return " + std::to_string(k) + "; }\n";
    text += (c ? "default: " : "constexpr int montelux_form(...) { return ") + std::to_string(no_form) +
            (c ? ") };\n" : "; }\n");
    const std::string found =
        c ? "_Static_assert(montelux_form" : "static_assert(montelux_form(&" + function + ")";
    for (const std::size_t k : refused)
        text += found + " != " + std::to_string(k) + ", " + message_source(k) + ");\n";
    return text;
}

[[noreturn]] void refuse(const std::string& source, const std::string& function, const FunctionForm& form,
                         std::size_t found) {
    std::string text = "the function '" + function + "' is declared ";
    text += found == no_form ? "otherwise" : "as " + declaration(forms[found], function);
    text += "; expected " + declaration(form, function);
    if (found != no_form) {
        const FunctionForm& f = forms[found];
        std::string options;
        if (f.components != form.components)
            options = f.components ? ", or --components M" : ", or no --components";
        if (f.parameters && !form.parameters)
            options +=
                std::string(options.empty() ? ", or" : " and") + " --let NAME=VALUE for each parameter";
        text += options;
    }
    throw UsageError(source, text);
}

} // namespace

void check_form(const std::string& source, const std::string& function, const FunctionForm& form,
                const fs::path& folder) {
    const bool c = fs::path(source).extension() == ".c";
    std::vector<std::size_t> refused{no_form};
    for (std::size_t k = 0; k < forms.size(); ++k)
        if (forms[k].components != form.components || (forms[k].parameters && !form.parameters))
            refused.push_back(k);
    const fs::path file = folder / (c ? "form.c" : "form.cpp");
    std::ofstream(file) << probe(source, function, c, refused);
    try {
        montelux::compile({.source = file,
                           .library = folder / "form.so",
                           .language = c ? Compilation::Language::c : Compilation::Language::cpp,
                           .messages = Compilation::Messages::in_error,
                           .overrides = {"-fsyntax-only", "-w"}});
    } catch (const Error& error) {
        // Other failures say nothing of the form.
        for (const std::size_t k : refused)
            if (std::string_view(error.what()).find(message(k)) != std::string_view::npos)
                refuse(source, function, form, k);
    }
}

} // namespace montelux::app
