// SceneParser: the grammar of pbrt scene files; reads directives and has Directives execute them.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/pbrt/directives.h"

namespace montelux::pbrt {

class SceneParser {
  public:
    SceneParser(Files& files, Directives& builder, Diagnostics& diagnostics)
        : files_(files), builder_(builder), diagnostics_(diagnostics) {}

    // Executes a whole text; returns the place of its end.
    Location parse(std::string_view text, std::uint32_t file);

    // Registers the main file before its text is parsed, so that a file that includes it is detected.
    void enter(const std::filesystem::path& path);

  private:
    struct Directive {
        std::string_view name;
        void (*run)(SceneParser& parser, const Token& directive);
    };
    static std::span<const Directive> directives();
    [[noreturn]] void unknown_directive(const Token& token) const;

    // Arguments.
    std::string string_argument(const Token& directive);
    template <std::size_t count>
    std::array<double, count> numbers(const Token& directive);
    Matrix4 matrix(const Token& directive);
    std::vector<Parameter> parameters();
    Plugin plugin(const Token& directive);

    void nested_file(const Token& directive);
    void import(const Token& directive);
    void look_at(const Token& directive);
    void transform(const Token& directive);
    void concat_transform(const Token& directive);
    void active_transform();
    void attribute(const Token& directive);
    void option(const Token& directive);
    void texture(const Token& directive);

    Files& files_;
    Directives& builder_;
    Diagnostics& diagnostics_;
    Tokenizer* tokens_ = nullptr; // of the file that is being read
    std::vector<std::filesystem::path> open_files_;
    std::size_t files_entered_ = 0;
};

} // namespace montelux::pbrt
