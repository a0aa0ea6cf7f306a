#include "montelux/formats/mitsuba/scene_graph.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "montelux/formats/mitsuba/parameters.h"
#include "montelux/formats/mitsuba/references.h"
#include "montelux/formats/mitsuba/upgrade.h"
#include "montelux/formats/mitsuba/xml_reader.h"
#include "montelux/formats/mitsuba/xml_values.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/spectrum/spd_file.h"

namespace montelux::mitsuba {
namespace {

// More would be a circle, or a way to fill the memory.
constexpr int max_include_depth = 15, max_includes = 10000;
constexpr std::size_t max_bytes = std::size_t{1} << 28;

constexpr auto object_elements = std::to_array<std::string_view>(
    {"scene", "shape", "bsdf", "emitter", "sensor", "film", "rfilter", "sampler", "integrator", "texture",
     "medium", "phase", "volume", "spectrum"});
constexpr auto value_elements = std::to_array<std::string_view>(
    {"boolean", "integer", "float", "string", "point", "vector", "rgb", "spectrum", "transform", "ref"});
constexpr auto other_elements = std::to_array<std::string_view>({"include", "alias", "default", "path"});
constexpr auto transformations =
    std::to_array<std::string_view>({"translate", "rotate", "scale", "lookat", "matrix"});

bool is_one_of(std::string_view name, std::span<const std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
}

class GraphReader {
  public:
    GraphReader(SceneGraph& graph, const std::map<std::string, std::string>& definitions)
        : graph_(graph), parameters_(definitions), references_(graph) {}

    void read_main(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
        read_file(bytes, path, std::nullopt, {});
        references_.resolve();
        for (const std::size_t object : old_) upgrade(graph_.objects[object]);
        references_.check_circles();
        for (const std::string& name : parameters_.unused())
            graph_.diagnostics.warn({}, "the scene does not use the parameter " + name);
    }

  private:
    // An element that has begun.
    struct Level {
        enum class Kind : std::uint8_t { object, transform, value } kind = Kind::value;
        std::size_t object = 0; // of kind object; of kind transform, whose property it is
        std::string name{};     // of kind transform
        Matrix4 matrix{};       // of kind transform
        SourceLocation at{};
    };
    struct File {
        std::uint32_t number = 0;
        FormatVersion version{};
        std::optional<std::size_t> parent{}; // the object that includes it; none: the main file
        std::string name{};                  // under which an object that is no scene is included
        std::vector<Level> levels{};
    };

    void read_file(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                   std::optional<std::size_t> parent, const std::string& name);
    void begin(File& file, std::string_view element, std::vector<Attribute> attributes, SourceLocation at);
    void end(File& file);
    void begin_root(File& file, const std::string& element, std::vector<Attribute>& attributes,
                    const Place& place);
    std::size_t begin_object(File& file, const std::string& element, const std::vector<Attribute>& attributes,
                             const Place& place);
    void add_value(std::size_t object, const File& file, const std::string& element,
                   const std::vector<Attribute>& attributes, const Place& place);
    SpectrumValue spectrum_in_file(const std::string& name, const Place& place);
    void include(const File& file, std::size_t object, const std::vector<Attribute>& attributes,
                 const Place& place);
    void add_folder(const std::vector<Attribute>& attributes, const Place& place);
    void add_folders(const std::filesystem::path& from, const std::filesystem::path& folder);
    void add_property(std::size_t object, Property property);

    Place place(SourceLocation at) const { return {graph_.diagnostics, at}; }
    // The values of the attributes; empty for optional ones (with '?' at the end of their names) that are missing.
    static std::vector<std::string> take(std::string_view element, const std::vector<Attribute>& attributes,
                                         std::initializer_list<std::string_view> names, const Place& place);

    SceneGraph& graph_;
    Parameters parameters_;
    References references_;
    std::vector<std::size_t> old_; // objects of files before version 2
    std::size_t bytes_ = 0;
    int depth_ = 0, includes_ = 0;
};

std::vector<std::string> GraphReader::take(std::string_view element, const std::vector<Attribute>& attributes,
                                           std::initializer_list<std::string_view> names,
                                           const Place& place) {
    std::vector<std::string_view> expected;
    std::vector<std::string> values;
    for (std::string_view name : names) {
        const bool optional = name.ends_with('?');
        if (optional) name.remove_suffix(1);
        expected.push_back(name);
        const auto found = std::ranges::find(attributes, name, &Attribute::name);
        if (found != attributes.end())
            values.push_back(found->value);
        else if (optional)
            values.emplace_back();
        else
            place.error("<" + shown(element) + "> needs the attribute " + in_quotes(name));
    }
    for (const Attribute& a : attributes)
        if (!is_one_of(a.name, expected))
            place.error("<" + shown(element) + "> has no attribute " + in_quotes(a.name) +
                        did_you_mean(a.name, expected));
    return values;
}

void GraphReader::read_file(std::span<const std::uint8_t> bytes, const std::filesystem::path& path,
                            std::optional<std::size_t> parent, const std::string& name) {
    File file{.number = graph_.diagnostics.add_file(path.string()), .parent = parent, .name = name};
    bytes_ += bytes.size();
    if (bytes_ > max_bytes) graph_.diagnostics.error({file.number}, "the scene's XML is longer than 256 MiB");
    read_xml(bytes, file.number, graph_.diagnostics,
             {.begin = [&](std::string_view element, std::vector<Attribute> attributes,
                           SourceLocation at) { begin(file, element, std::move(attributes), at); },
              .end = [&] { end(file); }});
}

void GraphReader::begin(File& file, std::string_view element_name, std::vector<Attribute> attributes,
                        SourceLocation at) {
    const Place here = place(at);
    for (Attribute& a : attributes)
        if (a.value.find('$') != std::string::npos) a.value = parameters_.substituted(a.value, here);
    std::string element = file.version.is_old() || file.levels.empty() ? to_snake_case(element_name)
                                                                       : std::string(element_name);
    if (element == "look_at") element = "lookat";
    if (file.levels.empty()) return begin_root(file, element, attributes, here);
    Level& parent = file.levels.back();
    Level level{.at = at};
    if (parent.kind == Level::Kind::value)
        here.error("<" + shown(element) + "> cannot stand in an element that has a value");
    if (parent.kind == Level::Kind::transform) {
        const std::optional<Matrix4> matrix = transformation_of(element, attributes, here);
        if (!matrix)
            here.error("<" + shown(element) +
                       "> in a transformation; expected translate, rotate, scale, "
                       "lookat or matrix" +
                       did_you_mean(element, transformations));
        parent.matrix = *matrix * parent.matrix;
        file.levels.push_back(std::move(level));
        return;
    }
    const std::size_t object = parent.object;
    const bool has_type = std::ranges::find(attributes, "type", &Attribute::name) != attributes.end();
    if (is_one_of(element, object_elements) && (element != "spectrum" || has_type)) {
        level.kind = Level::Kind::object;
        level.object = begin_object(file, element, attributes, here);
    } else if (element == "transform") {
        level.kind = Level::Kind::transform;
        level.object = object;
        level.name = file.version.is_old() ? to_snake_case(take(element, attributes, {"name"}, here)[0])
                                           : take(element, attributes, {"name"}, here)[0];
    } else if (is_one_of(element, value_elements)) {
        add_value(object, file, element, attributes, here);
    } else if (element == "include") {
        include(file, object, attributes, here);
    } else if (element == "alias") {
        const std::vector<std::string> values = take(element, attributes, {"id", "as"}, here);
        references_.define_alias(values[0], values[1], here);
    } else if (element == "default") {
        const std::vector<std::string> values = take(element, attributes, {"name", "value"}, here);
        if (values[0].empty()) here.error("a parameter without a name");
        parameters_.set_default(values[0], values[1]);
    } else if (element == "path") {
        add_folder(attributes, here);
    } else if (is_one_of(element, transformations)) {
        here.error("<" + element + "> stands in a <transform>");
    } else {
        std::vector<std::string_view> known;
        for (const std::span<const std::string_view> names :
             {std::span<const std::string_view>(object_elements),
              std::span<const std::string_view>(value_elements),
              std::span<const std::string_view>(other_elements)})
            for (const std::string_view name : names) known.push_back(name);
        here.error("<" + shown(element_name) + "> is no element of Mitsuba 3" + did_you_mean(element, known));
    }
    file.levels.push_back(std::move(level));
}

void GraphReader::begin_root(File& file, const std::string& element, std::vector<Attribute>& attributes,
                             const Place& here) {
    const auto version = std::ranges::find(attributes, "version", &Attribute::name);
    if (version == attributes.end())
        here.error("<" + shown(element) + "> needs the attribute 'version' (such as 3.0.0)");
    file.version = version_of(version->value, here);
    attributes.erase(version);
    Level level{.kind = Level::Kind::object, .at = here.at()};
    if (!file.parent) {
        if (element != "scene")
            here.error("the outermost element is <" + shown(element) + ">; expected <scene>");
        static_cast<void>(take(element, attributes, {"id?", "type?", "name?"}, here));
        graph_.objects.push_back({.kind = "scene", .type = "scene", .at = here.at()});
    } else if (element == "scene") {
        level.object = *file.parent; // its objects become those of the including object
    } else if (is_one_of(element, object_elements)) {
        if (!file.name.empty()) attributes.push_back({"name", file.name});
        level.object = begin_object(file, element, attributes, here);
    } else {
        here.error("<" + shown(element) + "> cannot be included");
    }
    file.levels.push_back(std::move(level));
}

void GraphReader::end(File& file) {
    const Level level = std::move(file.levels.back());
    file.levels.pop_back();
    if (level.kind == Level::Kind::transform)
        add_property(level.object, {level.name, level.matrix, level.at});
    if (level.kind == Level::Kind::object && file.version.is_old()) old_.push_back(level.object);
}

std::size_t GraphReader::begin_object(File& file, const std::string& element,
                                      const std::vector<Attribute>& attributes, const Place& here) {
    const std::vector<std::string> values = take(element, attributes, {"type", "id?", "name?"}, here);
    const std::size_t index = graph_.objects.size();
    const std::size_t parent = file.levels.empty() ? *file.parent : file.levels.back().object;
    if (element == "scene") here.error("a scene within a scene");
    graph_.objects.push_back({.kind = element == "spectrum" ? "texture" : element,
                              .type = values[0],
                              .id = values[1],
                              .at = here.at()});
    if (!values[1].empty()) references_.define(values[1], index, here);
    add_property(parent, {file.version.is_old() ? to_snake_case(values[2]) : values[2], ObjectIndex{index},
                          here.at()});
    return index;
}

void GraphReader::add_value(std::size_t object, const File& file, const std::string& element,
                            const std::vector<Attribute>& attributes, const Place& here) {
    Property property{.value = false, .at = here.at()};
    const auto take_value = [&] {
        std::vector<std::string> values = take(element, attributes, {"name", "value"}, here);
        property.name = values[0];
        return values[1];
    };
    if (element == "boolean") {
        std::string value = take_value();
        std::ranges::transform(value, value.begin(), [](unsigned char c) { return std::tolower(c); });
        if (value != "true" && value != "false")
            here.error(in_quotes(property.name) + " is " + in_quotes(value) + "; expected true or false");
        property.value = value == "true";
    } else if (element == "integer") {
        const std::string value = take_value();
        property.value = integer_of(value, in_quotes(property.name), here);
    } else if (element == "float") {
        const std::string value = take_value();
        property.value = number_of(value, in_quotes(property.name), here);
    } else if (element == "string") {
        property.value = take_value();
    } else if (element == "rgb") {
        const std::string value = take_value();
        property.value = rgb_of(value, here);
    } else if (element == "point" || element == "vector") {
        std::vector<Attribute> components = attributes;
        const auto name = std::ranges::find(components, "name", &Attribute::name);
        if (name == components.end()) here.error("<" + element + "> needs the attribute 'name'");
        property.name = name->value;
        components.erase(name);
        property.value = components_of(components, 0, here);
    } else if (element == "spectrum") {
        const std::vector<std::string> values =
            take(element, attributes, {"name", "value?", "filename?"}, here);
        property.name = values[0];
        if (values[1].empty() == values[2].empty())
            here.error("<spectrum> has either the attribute 'value' or 'filename'");
        if (values[2].empty()) {
            property.value = spectrum_of(values[1], here);
        } else {
            property.value = spectrum_in_file(values[2], here);
        }
    } else { // ref
        const std::vector<std::string> values = take(element, attributes, {"id", "name?"}, here);
        property.name = values[1];
        property.value = ObjectIndex{};
        references_.add(object, graph_.objects[object].properties.size(), values[0]);
    }
    if (file.version.is_old()) property.name = to_snake_case(property.name);
    add_property(object, std::move(property));
}

SpectrumValue GraphReader::spectrum_in_file(const std::string& name, const Place& here) {
    const std::filesystem::path path = graph_.files.find(name, here.at());
    const std::vector<std::uint8_t> bytes = graph_.files.read(path, here.at());
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    SpectrumValue spectrum;
    const PiecewiseLinear lines = parse_spd(text, path.string());
    // Without the knots at both ends that the file does not have.
    for (const PiecewiseLinear::Knot& knot : lines.knots().subspan(1, lines.knots().size() - 3)) {
        spectrum.wavelengths.push_back(static_cast<double>(knot.lambda));
        spectrum.values.push_back(static_cast<double>(knot.value));
    }
    return spectrum;
}

void GraphReader::include(const File& file, std::size_t object, const std::vector<Attribute>& attributes,
                          const Place& here) {
    const std::vector<std::string> values = take("include", attributes, {"filename", "name?"}, here);
    if (++includes_ > max_includes)
        here.error("more than " + std::to_string(max_includes) + " files are included");
    if (depth_ + 1 >= max_include_depth)
        here.error("files include one another " + std::to_string(max_include_depth) +
                   " levels deep; does one include itself?");
    const std::filesystem::path path = graph_.files.find(values[0], here.at());
    ++depth_;
    read_file(graph_.files.read(path, here.at()), path, object,
              file.version.is_old() ? to_snake_case(values[1]) : values[1]);
    --depth_;
}

// Of the folders `folder` and, where it leads up, those that lead up fewer levels: the last is searched first. A scene
// that was moved away from its data often still stands below it.
void GraphReader::add_folders(const std::filesystem::path& from, const std::filesystem::path& folder) {
    std::size_t levels = 0;
    std::filesystem::path below;
    for (const std::filesystem::path& part : folder) {
        if (below.empty() && part == "..")
            ++levels;
        else
            below /= part;
    }
    std::filesystem::path up = from;
    for (std::size_t i = 0; i < levels && !below.empty(); ++i, up /= "..")
        graph_.files.add_folder(up / below);
    graph_.files.add_folder(from / folder);
}

void GraphReader::add_folder(const std::vector<Attribute>& attributes, const Place& here) {
    const std::filesystem::path folder(take("path", attributes, {"value"}, here)[0]);
    const std::filesystem::path own =
        std::filesystem::path(graph_.diagnostics.file_name(here.at().file)).parent_path();
    const std::filesystem::path main = std::filesystem::path(graph_.diagnostics.file_name(0)).parent_path();
    if (folder.is_absolute()) return graph_.files.add_folder(folder);
    add_folders(main, folder);
    if (own != main) add_folders(own, folder);
}

void GraphReader::add_property(std::size_t object, Property property) {
    std::vector<Property>& all = graph_.objects[object].properties;
    if (!property.name.empty()) {
        const auto same = std::ranges::find(all, property.name, &Property::name);
        if (same != all.end())
            place(property.at)
                .error("the property " + in_quotes(property.name) + " is already given at " +
                       graph_.diagnostics.describe(same->at));
    }
    all.push_back(std::move(property));
}

} // namespace

SceneGraph read_scene_graph(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                            const std::map<std::string, std::string>& definitions,
                            TextDiagnostics& diagnostics, SceneFiles& files) {
    SceneGraph graph{.objects = {}, .diagnostics = diagnostics, .files = files};
    GraphReader(graph, definitions).read_main(bytes, path);
    return graph;
}

} // namespace montelux::mitsuba
