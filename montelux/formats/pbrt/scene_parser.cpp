#include "montelux/formats/pbrt/scene_parser.h"

#include <algorithm>
#include <utility>

#include "montelux/formats/number.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::pbrt {
namespace {

// Limits of nested files and of files in total; a scene that exceeds them is rejected.
constexpr std::size_t most_open_files = 64;
constexpr std::size_t max_files = 100000;

} // namespace

Location SceneParser::parse(std::string_view text, std::uint32_t file) {
    Tokenizer tokens(text, file, diagnostics_);
    Tokenizer* outer = std::exchange(tokens_, &tokens);
    std::span<const Directive> known = directives();
    for (;;) {
        Token token = tokens.next();
        if (token.kind == Token::Kind::end) {
            tokens_ = outer;
            return token.at;
        }
        if (token.kind != Token::Kind::word)
            diagnostics_.error(token.at, "expected a directive, read " + describe(token));
        auto found =
            std::lower_bound(known.begin(), known.end(), token.text,
                             [](const Directive& d, std::string_view name) { return d.name < name; });
        if (found == known.end() || found->name != token.text) unknown_directive(token);
        found->run(*this, token);
    }
}

void SceneParser::unknown_directive(const Token& token) const {
    std::vector<std::string_view> names;
    for (const Directive& d : directives()) names.push_back(d.name);
    diagnostics_.error(token.at,
                       "unknown directive " + in_quotes(token.text) + did_you_mean(token.text, names));
}

std::string SceneParser::string_argument(const Token& directive) {
    Token token = tokens_->next();
    if (token.kind != Token::Kind::string)
        diagnostics_.error(token.at, std::string(directive.text) + ": expected a quoted string, read " +
                                         describe(token));
    return std::string(token.text);
}

template <std::size_t count>
std::array<double, count> SceneParser::numbers(const Token& directive) {
    std::array<double, count> values{};
    for (double& value : values) {
        Token token = tokens_->next();
        const char* end = token.text.data() + token.text.size();
        NumberResult result{};
        if (token.kind == Token::Kind::word) result = parse_number(token.text.data(), end, value);
        if (token.kind != Token::Kind::word || result.end != end || result.status != NumberStatus::ok)
            diagnostics_.error(token.at, std::string(directive.text) + ": expected " + std::to_string(count) +
                                             " numbers, read " + describe(token));
    }
    return values;
}

Matrix4 SceneParser::matrix(const Token& directive) {
    Token open = tokens_->next();
    if (open.kind != Token::Kind::open)
        diagnostics_.error(open.at, std::string(directive.text) + ": expected '[' and 16 numbers, read " +
                                        describe(open));
    std::vector<double> v;
    tokens_->read_numbers(v);
    Token close = tokens_->next();
    if (close.kind != Token::Kind::close)
        diagnostics_.error(close.at, std::string(directive.text) + ": expected ']', read " + describe(close));
    if (v.size() != 16)
        diagnostics_.error(open.at, std::string(directive.text) + " has " + std::to_string(v.size()) +
                                        " numbers; expected 16");
    Matrix4 m; // the file is column-major
    for (std::size_t i = 0; i < 16; ++i) m.m[i % 4][i / 4] = v[i];
    return m;
}

std::vector<Parameter> SceneParser::parameters() {
    return read_parameters(*tokens_, builder_.color_space(), diagnostics_);
}

Plugin SceneParser::plugin(const Token& directive) {
    std::string name = string_argument(directive);
    return {std::move(name), ParameterList(parameters()), directive.at};
}

void SceneParser::enter(const std::filesystem::path& path) {
    open_files_.push_back(std::filesystem::weakly_canonical(path));
}

void SceneParser::nested_file(const Token& directive) {
    std::string name = string_argument(directive);
    std::filesystem::path path = files_.find(name, directive.at);
    std::filesystem::path canonical = std::filesystem::weakly_canonical(path);
    if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
        diagnostics_.error(directive.at, "'" + path.string() + "' includes itself");
    if (open_files_.size() >= most_open_files)
        diagnostics_.error(directive.at,
                           "files are nested more than " + std::to_string(most_open_files) + " levels deep");
    if (++files_entered_ > max_files)
        diagnostics_.error(directive.at, "more than " + std::to_string(max_files) + " files");
    std::vector<std::uint8_t> bytes = files_.read(path, directive.at);
    open_files_.push_back(std::move(canonical));
    parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, diagnostics_.add_file(path.string()));
    open_files_.pop_back();
}

void SceneParser::import(const Token& directive) {
    Directives::Import state = builder_.begin_import(directive.at);
    nested_file(directive);
    builder_.end_import(std::move(state));
}

void SceneParser::look_at(const Token& directive) {
    auto v = numbers<9>(directive);
    auto t = Transform::look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
    if (!t) diagnostics_.error(directive.at, "LookAt: the eye, the target and the up vector span no frame");
    builder_.concatenate(*t, directive.at);
}

void SceneParser::transform(const Token& directive) {
    auto t = Transform::from_matrix(matrix(directive));
    if (!t) diagnostics_.error(directive.at, "Transform: the matrix has no inverse");
    builder_.set_transform(*t, directive.at);
}

void SceneParser::concat_transform(const Token& directive) {
    auto t = Transform::from_matrix(matrix(directive));
    if (!t) diagnostics_.error(directive.at, "ConcatTransform: the matrix has no inverse");
    builder_.concatenate(*t, directive.at);
}

void SceneParser::active_transform() {
    Token which = tokens_->next();
    if (which.kind != Token::Kind::word)
        diagnostics_.error(which.at,
                           "ActiveTransform: expected All, StartTime or EndTime, read " + describe(which));
    builder_.active_transform(which.text, which.at);
}

void SceneParser::attribute(const Token& directive) {
    std::string target = string_argument(directive);
    builder_.add_defaults(target, parameters(), directive.at);
}

void SceneParser::option(const Token& directive) {
    std::vector<Parameter> list = parameters();
    if (list.size() != 1)
        diagnostics_.error(directive.at,
                           "Option has " + std::to_string(list.size()) + " parameters; expected 1");
    builder_.set_render_option(list[0]);
}

void SceneParser::texture(const Token& directive) {
    std::string name = string_argument(directive);
    std::string type = string_argument(directive);
    std::string plugin_name = string_argument(directive);
    builder_.texture(name, type, std::move(plugin_name), parameters(), directive.at);
}

// In alphabetical order.
std::span<const SceneParser::Directive> SceneParser::directives() {
    using P = SceneParser;
    static constexpr std::array<Directive, 41> table = {{
        {"Accelerator", [](P& p, const Token& d) { p.builder_.set_accelerator(p.plugin(d)); }},
        {"ActiveTransform", [](P& p, const Token&) { p.active_transform(); }},
        {"AreaLightSource",
         [](P& p, const Token& d) {
             std::string name = p.string_argument(d);
             p.builder_.area_light_source(std::move(name), p.parameters(), d.at);
         }},
        {"Attribute", [](P& p, const Token& d) { p.attribute(d); }},
        {"AttributeBegin", [](P& p, const Token& d) { p.builder_.attribute_begin(d.at); }},
        {"AttributeEnd", [](P& p, const Token& d) { p.builder_.attribute_end(d.at); }},
        {"Camera", [](P& p, const Token& d) { p.builder_.set_camera(p.plugin(d)); }},
        {"ColorSpace",
         [](P& p, const Token& d) { p.builder_.set_color_space(p.string_argument(d), d.at); }},
        {"ConcatTransform", [](P& p, const Token& d) { p.concat_transform(d); }},
        {"CoordSysTransform",
         [](P& p, const Token& d) { p.builder_.coordinate_system_transform(p.string_argument(d), d.at); }},
        {"CoordinateSystem",
         [](P& p, const Token& d) { p.builder_.coordinate_system(p.string_argument(d)); }},
        {"Film", [](P& p, const Token& d) { p.builder_.set_film(p.plugin(d)); }},
        {"Identity", [](P& p, const Token& d) { p.builder_.set_transform(Transform(), d.at); }},
        {"Import", [](P& p, const Token& d) { p.import(d); }},
        {"Include", [](P& p, const Token& d) { p.nested_file(d); }},
        {"Integrator", [](P& p, const Token& d) { p.builder_.set_integrator(p.plugin(d)); }},
        {"LightSource",
         [](P& p, const Token& d) {
             std::string name = p.string_argument(d);
             p.builder_.light_source(std::move(name), p.parameters(), d.at);
         }},
        {"LookAt", [](P& p, const Token& d) { p.look_at(d); }},
        {"MakeNamedMaterial",
         [](P& p, const Token& d) {
             std::string name = p.string_argument(d);
             p.builder_.make_named_material(name, p.parameters(), d.at);
         }},
        {"MakeNamedMedium",
         [](P& p, const Token& d) {
             std::string name = p.string_argument(d);
             p.builder_.make_named_medium(name, p.parameters(), d.at);
         }},
        {"Material",
         [](P& p, const Token& d) {
             std::string type = p.string_argument(d);
             p.builder_.material(std::move(type), p.parameters(), d.at);
         }},
        {"MediumInterface",
         [](P& p, const Token& d) {
             std::string inside = p.string_argument(d);
             bool two = p.tokens_->peek().kind == Token::Kind::string;
             p.builder_.medium_interface(inside, two ? p.string_argument(d) : inside);
         }},
        {"NamedMaterial",
         [](P& p, const Token& d) { p.builder_.named_material(p.string_argument(d), d.at); }},
        {"ObjectBegin", [](P& p, const Token& d) { p.builder_.object_begin(p.string_argument(d), d.at); }},
        {"ObjectEnd", [](P& p, const Token& d) { p.builder_.object_end(d.at); }},
        {"ObjectInstance",
         [](P& p, const Token& d) { p.builder_.object_instance(p.string_argument(d), d.at); }},
        {"Option", [](P& p, const Token& d) { p.option(d); }},
        {"PixelFilter", [](P& p, const Token& d) { p.builder_.set_filter(p.plugin(d)); }},
        {"ReverseOrientation", [](P& p, const Token& d) { p.builder_.reverse_orientation(d.at); }},
        {"Rotate",
         [](P& p, const Token& d) {
             auto v = p.numbers<4>(d);
             if (v[1] == 0 && v[2] == 0 && v[3] == 0)
                 p.diagnostics_.error(d.at, "Rotate: the axis is the zero vector");
             p.builder_.concatenate(Transform::rotate(v[0], {v[1], v[2], v[3]}), d.at);
         }},
        {"Sampler", [](P& p, const Token& d) { p.builder_.set_sampler(p.plugin(d)); }},
        {"Scale",
         [](P& p, const Token& d) {
             auto v = p.numbers<3>(d);
             if (v[0] == 0 || v[1] == 0 || v[2] == 0)
                 p.diagnostics_.error(d.at, "Scale: a factor is 0; the transformation has no inverse");
             p.builder_.concatenate(Transform::scale({v[0], v[1], v[2]}), d.at);
         }},
        {"Shape",
         [](P& p, const Token& d) {
             std::string name = p.string_argument(d);
             p.builder_.shape(name, p.parameters(), d.at);
         }},
        {"Texture", [](P& p, const Token& d) { p.texture(d); }},
        {"Transform", [](P& p, const Token& d) { p.transform(d); }},
        {"TransformBegin",
         [](P& p, const Token& d) {
             p.diagnostics_.warn_once("TransformBegin", d.at,
                                      "TransformBegin is deprecated; it is read as AttributeBegin");
             p.builder_.attribute_begin(d.at);
         }},
        {"TransformEnd", [](P& p, const Token& d) { p.builder_.attribute_end(d.at); }},
        // The times affect only moving transformations, which are an error of their own.
        {"TransformTimes",
         [](P& p, const Token& d) {
             const auto times = p.numbers<2>(d);
             p.builder_.transform_times(times[0], times[1], d.at);
         }},
        {"Translate",
         [](P& p, const Token& d) {
             auto v = p.numbers<3>(d);
             p.builder_.concatenate(Transform::translate({v[0], v[1], v[2]}), d.at);
         }},
        {"WorldBegin", [](P& p, const Token& d) { p.builder_.world_begin(d.at); }},
        {"WorldEnd",
         [](P& p, const Token& d) {
             p.diagnostics_.warn(d.at, "WorldEnd belongs to pbrt-v3; it is ignored");
         }},
    }};
    return table;
}

} // namespace montelux::pbrt
