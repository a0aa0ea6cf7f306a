#include "montelux/formats/obj/mtl.h"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

#include "montelux/formats/obj/statements.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {
namespace {

using obj::Statements;
using obj::Words;

class MtlParser {
  public:
    MtlParser(std::string_view text, std::string_view name, Warnings& warnings)
        : statements_(text, name), warnings_(warnings) {}

    std::vector<MtlMaterial> parse() {
        while (statements_.next()) {
            const std::string_view keyword = statements_.keyword();
            Words& words = statements_.words();
            if (keyword == "newmtl") {
                materials_.emplace_back();
                materials_.back().name = words.rest();
                materials_.back().line = statements_.line();
            } else if (materials_.empty()) {
                words.error("read " + quoted(keyword) + " before the first material; expected 'newmtl'");
            } else {
                read(keyword, words, materials_.back());
            }
        }
        return std::move(materials_);
    }

  private:
    void read(std::string_view keyword, Words& words, MtlMaterial& m) {
        if (keyword == "Kd")
            m.diffuse = color(keyword, words);
        else if (keyword == "Ks")
            m.specular = color(keyword, words);
        else if (keyword == "Ke")
            m.emission = color(keyword, words);
        else if (keyword == "Ns")
            m.exponent = within(keyword, words, 0, 1e9f);
        else if (keyword == "Ni")
            m.ior = within(keyword, words, 0, 100);
        else if (keyword == "d")
            read_opacity(words, m);
        else if (keyword == "Tr")
            m.opacity = 1 - within(keyword, words, 0, 1);
        else if (keyword == "illum")
            m.illumination = static_cast<int>(within(keyword, words, 0, 10));
        else if (keyword == "Pr")
            m.roughness = within(keyword, words, 0, 1);
        else if (keyword == "Pm")
            m.metallic = within(keyword, words, 0, 1);
        else if (keyword == "Pc")
            m.coat = within(keyword, words, 0, 1);
        else if (keyword == "Pcr")
            m.coat_roughness = within(keyword, words, 0, 1);
        else if (keyword == "Ps")
            m.sheen = within(keyword, words, 0, 1);
        else if (keyword == "aniso")
            m.anisotropy = within(keyword, words, -1, 1);
        else if (keyword == "anisor")
            m.anisotropy_turns = within(keyword, words, -1, 1);
        else if (keyword == "map_Kd")
            m.diffuse_map = map(words);
        else if (keyword == "map_d")
            m.opacity_map = map(words);
        else if (keyword == "map_bump" || keyword == "map_Bump" || keyword == "bump")
            m.bump_map = map(words);
        else if (keyword == "map_Pr")
            m.roughness_map = map(words);
        else if (keyword == "map_Pm")
            m.metallic_map = map(words);
        else if (keyword == "map_Ps")
            m.sheen_map = map(words);
        else if (keyword == "norm" || keyword == "map_norm")
            m.normal_map = map(words);
        else if (keyword != "Ka" && keyword != "Tf" && keyword != "sharpness")
            warn_of(keyword);
    }

    void warn_of(std::string_view keyword) {
        if (told_.size() >= Warnings::max_messages || !told_.insert(std::string(keyword)).second) return;
        const bool known = keyword.starts_with("map_") || keyword == "disp" || keyword == "decal" ||
                           keyword == "refl" || keyword == "Pt";
        warnings_.add(statements_.words().where(),
                      quoted(keyword) + (known ? " is ignored" : " is unknown and ignored"));
    }

    float within(std::string_view keyword, Words& words, float least, float most) const {
        const float value = words.number("a number for " + quoted(keyword));
        if (!(value >= least && value <= most))
            words.error(quoted(keyword) + " is " + short_text(value) + "; expected " + short_text(least) +
                        " to " + short_text(most));
        return value;
    }
    static std::string short_text(float value) {
        char text[32];
        std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
        return text;
    }

    // One number is grey.
    std::optional<Vec3f> color(std::string_view keyword, Words& words) {
        const std::optional<float> r = words.find_number();
        if (!r) {
            const std::string_view word = words.next();
            if (word != "spectral" && word != "xyz")
                words.error((word.empty() ? "the line ends early" : "read " + quoted(word)) +
                            "; expected 3 numbers (R G B) for " + quoted(keyword));
            warnings_.add(words.where(), quoted(keyword) + " is ignored: expected 3 numbers (R G B)");
            return std::nullopt;
        }
        if (words.at_end()) return Vec3f{check_color(*r, words), *r, *r};
        const float g = words.number("3 numbers (R G B)"), b = words.number("3 numbers (R G B)");
        return Vec3f{check_color(*r, words), check_color(g, words), check_color(b, words)};
    }
    static float check_color(float value, const Words& words) {
        if (!(value >= 0)) words.error("a colour has a negative component");
        return value;
    }

    // d [-halo] factor
    void read_opacity(Words& words, MtlMaterial& m) {
        if (const std::optional<float> d = words.find_number()) {
            if (!(*d >= 0 && *d <= 1)) words.error("'d' is " + short_text(*d) + "; expected 0 to 1");
            m.opacity = *d;
            return;
        }
        const std::string_view word = words.next();
        if (word != "-halo") words.error("read " + quoted(word) + "; expected a number for 'd'");
        warnings_.add(words.where(), "'d -halo' is ignored: opacity does not depend on the direction");
    }

    MtlMap map(Words& words) {
        MtlMap m;
        m.line = statements_.line();
        while (true) {
            Words after = words;
            const std::string_view option = after.next();
            if (!option.starts_with('-') || option.size() < 2) break;
            words = after;
            read_option(option, words, m);
        }
        m.file = words.rest();
        if (m.file.empty()) words.error("the line ends early; expected the name of a picture");
        return m;
    }
    void read_option(std::string_view option, Words& words, MtlMap& m) {
        if (option == "-s" || option == "-o" || option == "-t") {
            Vec2f v{words.number("1 to 3 numbers"), option == "-s" ? 1.0f : 0.0f};
            if (const std::optional<float> second = words.find_number()) {
                v.y = *second;
                words.find_number();
            }
            if (option == "-s") m.scale = v;
            if (option == "-o") m.offset = v;
            if (option == "-t") warn_of_option(option, words);
        } else if (option == "-clamp") {
            m.clamp = words.next() == "on";
        } else if (option == "-bm") {
            m.bumps = words.number("a number");
        } else if (option == "-mm") {
            warn_of_option(option, words);
            words.number("2 numbers");
            words.number("2 numbers");
        } else {
            constexpr std::array with_value{"-blendu",  "-blendv", "-boost", "-cc",
                                            "-imfchan", "-texres", "-type",  "-colorspace"};
            if (std::ranges::none_of(with_value, [&](std::string_view known) { return known == option; }))
                words.error("unknown option " + quoted(option) + " of a picture");
            if (option != "-blendu" && option != "-blendv") warn_of_option(option, words);
            words.next();
        }
    }
    void warn_of_option(std::string_view option, const Words& words) {
        warnings_.add(words.where(), "option " + quoted(option) + " is ignored");
    }

    Statements statements_;
    Warnings& warnings_;
    std::vector<MtlMaterial> materials_;
    std::unordered_set<std::string> told_;
};

} // namespace

std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::string_view name,
                                   Warnings& warnings) {
    return MtlParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, warnings).parse();
}

} // namespace montelux
