#include "montelux/formats/pbrt/directives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {
namespace {

constexpr std::size_t max_blocks = 1000000;

} // namespace

Directives::Directives(Files& files, Diagnostics& diagnostics, std::shared_ptr<TexelFile> texel_file)
    : files_(files), diagnostics_(diagnostics), builder_(result_.scene, diagnostics),
      spectra_(files, diagnostics), textures_(builder_, files, spectra_, diagnostics),
      displacements_(builder_, textures_), measured_brdfs_(builder_, files, diagnostics),
      lights_(builder_, files, spectra_, diagnostics), media_(builder_, files, spectra_, diagnostics) {
    result_.scene.texel_file = std::move(texel_file);
    state_.color_space = &RgbColorSpace::srgb();
    materials_.push_back({"diffuse", {}, {}}); // the material of shapes before any Material directive
}

void Directives::require_world(std::string_view directive, Location at) const {
    if (!in_world_)
        diagnostics_.error(at, "'" + std::string(directive) + "' is before WorldBegin; it belongs after it");
}

void Directives::require_options(std::string_view directive, Location at) const {
    if (in_world_)
        diagnostics_.error(at, "'" + std::string(directive) + "' is after WorldBegin; it belongs before it");
}

void Directives::world_begin(Location at) {
    require_options("WorldBegin", at);
    in_world_ = true;
    state_.ctm = std::make_shared<TransformPair>();
    state_.start_active = state_.end_active = true;
    coordinate_systems_["world"] = state_.ctm;
    finish_options();
}

void Directives::push(Block::Kind kind, Location at) {
    if (blocks_.size() >= max_blocks)
        diagnostics_.error(at, "more than " + std::to_string(max_blocks) + " open blocks");
    blocks_.push_back({kind, at, state_});
}

void Directives::pop(Block::Kind kind, std::string_view directive, Location at) {
    bool attribute = kind == Block::Kind::attribute;
    if (blocks_.size() <= block_floor_)
        diagnostics_.error(at, std::string(directive) + " without " +
                                   (attribute ? "AttributeBegin" : "ObjectBegin"));
    if (blocks_.back().kind != kind)
        diagnostics_.error(at, std::string(directive) + ", but the innermost open block is the " +
                                   (attribute ? "ObjectBegin" : "AttributeBegin") + " of " +
                                   diagnostics_.describe(blocks_.back().at));
    state_ = std::move(blocks_.back().state);
    blocks_.pop_back();
}

void Directives::attribute_begin(Location at) {
    require_world("AttributeBegin", at);
    push(Block::Kind::attribute, at);
}

void Directives::attribute_end(Location at) {
    require_world("AttributeEnd", at);
    pop(Block::Kind::attribute, "AttributeEnd", at);
}

void Directives::object_begin(const std::string& name, Location at) {
    require_world("ObjectBegin", at);
    if (builder_.in_object()) diagnostics_.error(at, "ObjectBegin inside another object's definition");
    builder_.begin_object(name, at);
    open_curves_.reset();
    push(Block::Kind::object, at);
}

void Directives::object_end(Location at) {
    require_world("ObjectEnd", at);
    pop(Block::Kind::object, "ObjectEnd", at);
    builder_.end_object();
    open_curves_.reset();
}

void Directives::object_instance(const std::string& name, Location at) {
    require_world("ObjectInstance", at);
    if (builder_.in_object()) diagnostics_.error(at, "ObjectInstance inside an object's definition");
    builder_.add_instance(name, state_.ctm->start, state_.ctm->end, at);
}

Directives::Import Directives::begin_import(Location at) {
    require_world("Import", at);
    ++open_imports_;
    return {state_, std::exchange(block_floor_, blocks_.size()), replaced_systems_.size()};
}

void Directives::end_import(Import import) {
    if (blocks_.size() > block_floor_)
        diagnostics_.error(blocks_.back().at, "this block is not closed in the imported file");
    for (; replaced_systems_.size() > import.replaced_systems; replaced_systems_.pop_back()) {
        auto& [name, before] = replaced_systems_.back();
        if (before)
            coordinate_systems_[name] = std::move(before);
        else
            coordinate_systems_.erase(name);
    }
    --open_imports_;
    block_floor_ = import.outer_floor;
    state_ = std::move(import.state);
}

void Directives::concatenate(const Transform& t, Location at) {
    auto moved = std::make_shared<TransformPair>(*state_.ctm);
    if (state_.start_active) moved->start = moved->start * t;
    if (state_.end_active) moved->end = moved->end * t;
    for (const Transform* m : {&moved->start, &moved->end})
        for (const Matrix4* matrix : {&m->matrix(), &m->inverse_matrix()})
            for (const auto& row : matrix->m)
                for (double v : row)
                    if (!std::isfinite(v))
                        diagnostics_.error(at, "the transformation or its inverse is not finite any more");
    state_.ctm = std::move(moved);
}

void Directives::set_transform(const Transform& t, Location at) {
    auto identity = std::make_shared<TransformPair>(*state_.ctm);
    if (state_.start_active) identity->start = Transform();
    if (state_.end_active) identity->end = Transform();
    state_.ctm = std::move(identity);
    concatenate(t, at);
}

void Directives::active_transform(std::string_view which, Location at) {
    constexpr std::array<std::string_view, 3> names = {"All", "StartTime", "EndTime"};
    if (which != "All" && which != "StartTime" && which != "EndTime")
        diagnostics_.error(at, "ActiveTransform " + in_quotes(which) +
                                   "; expected All, StartTime or EndTime" + did_you_mean(which, names));
    state_.start_active = which != "EndTime";
    state_.end_active = which != "StartTime";
}

void Directives::coordinate_system(const std::string& name) {
    auto& system = coordinate_systems_[name];
    if (open_imports_ > 0) replaced_systems_.emplace_back(name, system);
    system = state_.ctm;
}

void Directives::coordinate_system_transform(const std::string& name, Location at) {
    auto found = coordinate_systems_.find(name);
    if (found == coordinate_systems_.end()) {
        std::vector<std::string_view> names;
        for (const auto& entry : coordinate_systems_) names.push_back(entry.first);
        if (names.size() > 10000) names.clear();
        diagnostics_.error(at,
                           "there is no coordinate system " + in_quotes(name) + did_you_mean(name, names));
    }
    state_.ctm = found->second;
}

void Directives::reverse_orientation(Location at) {
    require_world("ReverseOrientation", at);
    state_.reverse_orientation = !state_.reverse_orientation;
}

bool Directives::is_moving() const { return !(state_.ctm->start == state_.ctm->end); }

const Transform& Directives::start_transform(std::string_view what, Location at) const {
    if (is_moving())
        diagnostics_.warn_once("moving " + std::string(what), at,
                               std::string(what) + " does not move: it stays where it is at the start");
    return state_.ctm->start;
}

void Directives::transform_times(double start, double end, Location at) {
    require_options("TransformTimes", at);
    if (!(start < end)) diagnostics_.error(at, "TransformTimes: the start is not before the end");
    transform_start_ = start;
    transform_end_ = end;
}

void Directives::set_option(std::optional<Plugin>& option, Plugin plugin, std::string_view directive) {
    require_options(directive, plugin.at);
    if (option) diagnostics_.warn(plugin.at, std::string(directive) + " is given twice; the last one counts");
    option = std::move(plugin);
}

void Directives::set_camera(Plugin plugin) {
    Location at = plugin.at;
    set_option(camera_, std::move(plugin), "Camera");
    const auto& [start, end] = *state_.ctm;
    if (!fits_float(start) || !fits_float(end))
        diagnostics_.error(at, "the camera's transformation is beyond what single-precision numbers hold");
    camera_media_ = {no_index, state_.media, at};
    CameraSettings& camera = result_.scene.camera;
    camera.world_from_camera = start.inverse();
    camera.motion.reset();
    try {
        if (is_moving()) camera.motion.emplace(start.inverse(), end.inverse());
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
    coordinate_systems_["camera"] =
        std::make_shared<TransformPair>(TransformPair{start.inverse(), end.inverse()});
}

void Directives::set_film(Plugin plugin) {
    if (state_.color_space != &RgbColorSpace::srgb())
        diagnostics_.warn_once("film colour space", plugin.at,
                               "the film's colour space is sRGB; '" +
                                   std::string(state_.color_space->name()) +
                                   "' counts for RGB parameters alone");
    set_option(film_, std::move(plugin), "Film");
}

void Directives::set_accelerator(const Plugin& plugin) {
    require_options("Accelerator", plugin.at);
    diagnostics_.warn_once(
        "accelerator", plugin.at,
        "'Accelerator' is ignored: the ray tracer builds its own; the picture is the same");
}

namespace {

// As pbrt does: without '-' and '_', in small letters.
std::string normalized(std::string_view name) {
    std::string result;
    for (char c : name)
        if (c != '-' && c != '_') result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
}

} // namespace

void Directives::set_render_option(const Parameter& p) {
    auto expect_one = [&](ParameterType type, const char* what) {
        if (p.type != type || p.value_count() != 1)
            diagnostics_.error(p.at, "option " + in_quotes(p.name) + " has type " +
                                         std::string(name_of(p.type)) + "; expected 1 " + what);
    };
    const std::string option = normalized(p.name);
    constexpr std::array<std::string_view, 11> names = {"disablepixeljitter",
                                                        "disabletexturefiltering",
                                                        "disablewavelengthjitter",
                                                        "displacementedgescale",
                                                        "forcediffuse",
                                                        "msereferenceimage",
                                                        "msereferenceout",
                                                        "pixelstats",
                                                        "rendercoordsys",
                                                        "seed",
                                                        "wavefront"};
    if (option == "seed") {
        expect_one(ParameterType::integer, "integer");
        seed_ = static_cast<std::uint32_t>(p.integers[0]);
        return;
    }
    if (option == "displacementedgescale") {
        expect_one(ParameterType::floating, "float");
        if (!(p.numbers[0] > 0))
            diagnostics_.error(p.at, "option " + in_quotes(p.name) + " must be positive");
        displacements_.scale_edges(p.numbers[0]);
        return;
    }
    // The space of the computations does not change the picture here.
    if (option == "rendercoordsys") {
        expect_one(ParameterType::string, "string");
        constexpr std::array<std::string_view, 3> systems = {"camera", "cameraworld", "world"};
        if (std::find(systems.begin(), systems.end(), p.strings[0]) == systems.end())
            diagnostics_.error(p.at, "option " + in_quotes(p.name) + " is " + in_quotes(p.strings[0]) +
                                         "; expected one of camera, cameraworld, world" +
                                         did_you_mean(p.strings[0], systems));
        return;
    }
    for (std::string_view name : names)
        if (option == name) {
            diagnostics_.warn_once("option " + option, p.at,
                                   "option " + in_quotes(p.name) + " is not supported; it is ignored");
            return;
        }
    diagnostics_.error(p.at, "unknown option " + in_quotes(p.name) + did_you_mean(p.name, names));
}

void Directives::set_color_space(std::string_view name, Location at) {
    const RgbColorSpace* space = find_rgb_color_space(name);
    if (!space)
        diagnostics_.error(at, "unknown colour space " + in_quotes(name) +
                                   did_you_mean(name, rgb_color_space_names()));
    state_.color_space = space;
}

void Directives::add_defaults(std::string_view target, std::vector<Parameter> parameters, Location at) {
    const auto* found = std::find(plugin_kind_names.begin(), plugin_kind_names.end(), target);
    if (found == plugin_kind_names.end())
        diagnostics_.error(at, "Attribute of " + in_quotes(target) +
                                   "; expected shape, light, material, medium or texture" +
                                   did_you_mean(target, plugin_kind_names));
    auto kind = static_cast<PluginKind>(found - plugin_kind_names.begin());
    if (parameters.empty()) return;
    Defaults& defaults = state_.defaults[static_cast<std::size_t>(kind)];
    auto list = std::make_shared<std::vector<std::shared_ptr<const Parameter>>>();
    if (defaults) *list = *defaults;
    for (Parameter& p : parameters) {
        // A name may fit plugins other than those that follow, but one that fits none is a mistake.
        if (has_parameter(kind, p.name)) {
            // One of each name and type: otherwise a file that repeats an Attribute would exhaust the memory.
            std::erase_if(*list, [&](const auto& old) { return old->name == p.name && old->type == p.type; });
            list->push_back(std::make_shared<const Parameter>(std::move(p)));
        } else {
            diagnostics_.warn_once("Attribute " + std::string(target) + "/" + p.name, p.at,
                                   "no " + std::string(target) + " has a parameter " + in_quotes(p.name) +
                                       did_you_mean(p.name, parameter_names(kind)) + "; it is ignored");
        }
    }
    defaults = std::move(list);
}

ParameterList Directives::with_defaults(std::vector<Parameter> own, PluginKind kind) const {
    return {std::move(own), state_.defaults[static_cast<std::size_t>(kind)], kind};
}

} // namespace montelux::pbrt
