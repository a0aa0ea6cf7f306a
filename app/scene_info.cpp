#include "app/scene_info.h"

#include "app/json_number.h"
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/formats/named_cameras.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/light/light_tables.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/setting_names.h"

namespace montelux::app {
namespace {

using Json = nlohmann::ordered_json;

template <typename T>
Json counts_of(const T& names) {
    std::map<std::string, std::size_t> counts;
    for (const std::string_view name : names) ++counts[std::string(name)];
    Json json = Json::object();
    for (const auto& [name, count] : counts) json[name] = count;
    return json;
}

template <typename Variants>
Json kinds_of(const Variants& values) {
    std::vector<std::string_view> names;
    for (const auto& value : values)
        names.push_back(std::visit([](const auto& v) -> std::string_view { return v.name; }, value));
    return counts_of(names);
}

Json shapes_of(const Scene& s) {
    std::vector<std::string_view> names;
    for (const Shape& shape : s.shapes)
        names.push_back(visit_geometry(
            s, shape,
            Overloaded{[](const TriangleMesh&) -> std::string_view { return "triangle mesh"; },
                       [](const BilinearMesh&) -> std::string_view { return "bilinear mesh"; },
                       [](const Curves&) -> std::string_view { return "curves"; },
                       [](const Quadric& q) -> std::string_view {
                           return std::visit(Overloaded{[](const Sphere&) { return "sphere"; },
                                                        [](const Disk&) { return "disk"; },
                                                        [](const Cylinder&) { return "cylinder"; }},
                                             q);
                       }}));
    return counts_of(names);
}

std::size_t primitives_of(const Scene& s) {
    std::size_t count = s.quadrics.size();
    for (const TriangleMesh& m : s.meshes) count += m.triangle_count();
    for (const BilinearMesh& m : s.bilinear_meshes) count += m.patch_count();
    for (const Curves& c : s.curves) count += c.segment_count();
    return count;
}

Json vector_json(Vec3d v) { return {json_number(v.x), json_number(v.y), json_number(v.z)}; }

std::string_view camera_name(const CameraModel& model) {
    return std::visit(Overloaded{[](const PerspectiveCamera&) { return "perspective"; },
                                 [](const OrthographicCamera&) { return "orthographic"; },
                                 [](const SphericalCamera&) { return "spherical"; },
                                 [](const RealisticCamera&) { return "realistic"; }},
                      model);
}

std::string_view filter_name(const PixelFilter& filter) {
    return std::visit(Overloaded{[](const BoxFilter&) { return "box"; },
                                 [](const TriangleFilter&) { return "triangle"; },
                                 [](const GaussianFilter&) { return "gaussian"; },
                                 [](const MitchellFilter&) { return "mitchell"; },
                                 [](const LanczosFilter&) { return "sinc"; }},
                      filter);
}

template <typename Table, typename Value>
std::string_view setting_name(const Table& table, Value value) {
    for (const auto& [name, known] : table)
        if (known == value) return name;
    return "?";
}

Json describe_scene(const std::string& file, const SceneDescription& d, const Warnings& warnings,
                    const std::vector<std::filesystem::path>& files) {
    const Scene& s = d.scene;
    Json out;
    out["file"] = file;
    out["shapes"] = shapes_of(s);
    out["primitives"] = primitives_of(s);
    out["objects"] = s.objects.size();
    out["instances"] = s.instances.size();
    out["moves"] = moves(s);
    const Bounds3 bounds = bounds_of(s);
    if (bounds.empty())
        out["bounds"] = nullptr;
    else
        out["bounds"] = {{"lower", vector_json(bounds.lower)}, {"upper", vector_json(bounds.upper)}};
    out["materials"] = kinds_of(s.materials);
    out["textures"] = s.float_textures.size() + s.spectrum_textures.size();
    out["images"] = s.images.size();
    out["lights"] = kinds_of(s.lights);
    out["media"] = kinds_of(s.media);
    out["camera"] = {{"kind", camera_name(s.camera.model)},
                     {"position", vector_json(s.camera.world_from_camera.point(Vec3d()))},
                     {"moves", s.camera.motion.has_value()}};
    out["cameras"] = d.camera_names;
    out["variants"] = d.variant_names;
    out["animations"] = d.animation_names;
    if (const auto* p = std::get_if<PerspectiveCamera>(&s.camera.model))
        out["camera"]["fov"] = json_number(double{p->fov});
    out["film"] = {{"width", d.film.width},
                   {"height", d.film.height},
                   {"crop", {d.film.crop.x0, d.film.crop.y0, d.film.crop.x1, d.film.crop.y1}},
                   {"filter", filter_name(d.film.filter)},
                   {"sensor", d.film.sensor},
                   {"iso", json_number(double{d.film.iso})},
                   {"exposure_time", json_number(double{d.film.exposure_time})},
                   {"layers", text_of(d.film.layers.set)}};
    out["sampler"] = {{"kind", setting_name(sampler_names, d.sampler.kind)},
                      {"spp", d.sampler.spp},
                      {"seed", d.sampler.seed}};
    if (d.integrator.occlusion)
        out["integrator"] = {{"kind", "ambient occlusion"}};
    else
        out["integrator"] = {{"method", setting_name(integrator_names, d.integrator.method)},
                             {"strategy", setting_name(strategy_names, d.integrator.strategy)},
                             {"max_depth", d.integrator.max_depth}};
    Json memory = Json::object();
    std::size_t sum = 0;
    for (const MemoryUse& use : memory_use(s)) {
        memory[std::string(use.kind)] = use.bytes;
        sum += use.bytes;
    }
    memory["sum"] = sum;
    out["memory_bytes"] = memory;
    std::uintmax_t bytes = 0;
    out["files"] = Json::array();
    for (const std::filesystem::path& path : files) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        out["files"].push_back({{"name", path.string()}, {"bytes", error ? 0 : size}});
        if (!error) bytes += size;
    }
    out["file_bytes"] = bytes;
    out["ignored"] = warnings.messages();
    return out;
}

// "2 sphere, 1 disk"
std::string list_of(const Json& counts) {
    std::string text;
    for (const auto& [name, count] : counts.items())
        text += (text.empty() ? "" : ", ") + count.dump() + " " + name;
    return text.empty() ? "none" : text;
}

std::string point_of(const Json& v) {
    std::string text;
    for (const Json& x : v) {
        char number[32];
        std::snprintf(number, sizeof number, "%.6g", x.is_number() ? x.get<double>() : 0.0);
        text += (text.empty() ? "" : " ") + std::string(number);
    }
    return text;
}

void print_line(const char* name, const std::string& text) { std::printf("%-12s %s\n", name, text.c_str()); }

void print_text(const Json& j) {
    constexpr double mebibyte = 1 << 20;
    std::printf("%s: a scene of %s primitives\n", j["file"].get<std::string>().c_str(),
                j["primitives"].dump().c_str());
    print_line("shapes", list_of(j["shapes"]));
    print_line("instances", j["instances"].dump() + " of " + j["objects"].dump() + " objects");
    if (!j["bounds"].is_null())
        print_line("bounds", point_of(j["bounds"]["lower"]) + " to " + point_of(j["bounds"]["upper"]));
    print_line("materials", list_of(j["materials"]));
    print_line("textures", j["textures"].dump() + ", " + j["images"].dump() + " images");
    print_line("lights", list_of(j["lights"]));
    print_line("media", list_of(j["media"]));
    print_line("camera", j["camera"]["kind"].get<std::string>() + " at " + point_of(j["camera"]["position"]) +
                             (j["moves"].get<bool>() ? ", with motion in the scene" : ""));
    const auto choices = [&](const char* of) { return j[of].get<std::vector<std::string>>(); };
    if (choices("cameras").size() > 1)
        print_line("cameras", numbered_names(choices("cameras")) + " (--camera)");
    if (!choices("variants").empty())
        print_line("variants", numbered_names(choices("variants")) + " (--variant)");
    if (!choices("animations").empty())
        print_line("animations", numbered_names(choices("animations")) + " (--frames)");
    print_line("film", j["film"]["width"].dump() + " x " + j["film"]["height"].dump() + " pixels, filter " +
                           j["film"]["filter"].get<std::string>() + ", sensor " +
                           j["film"]["sensor"].get<std::string>());
    print_line("sampler", j["sampler"]["kind"].get<std::string>() + ", " + j["sampler"]["spp"].dump() +
                              " samples per pixel");
    const Json& integrator = j["integrator"];
    print_line("integrator", integrator.contains("kind")
                                 ? integrator["kind"].get<std::string>()
                                 : integrator["method"].get<std::string>() + ", strategy " +
                                       integrator["strategy"].get<std::string>() + ", depth " +
                                       integrator["max_depth"].dump());
    char text[80];
    std::snprintf(text, sizeof text, "%.2f MiB", j["memory_bytes"]["sum"].get<double>() / mebibyte);
    print_line("memory", text);
    std::snprintf(text, sizeof text, "%zu, %.2f MiB", j["files"].size(),
                  j["file_bytes"].get<double>() / mebibyte);
    print_line("files", text);
    for (const Json& warning : j["ignored"]) print_line("ignored", warning.get<std::string>());
}

} // namespace

void print_scene_info(const std::string& file, LoadOptions options, bool json) {
    Warnings warnings;
    std::vector<std::filesystem::path> files;
    options.files_read = &files;
    const SceneDescription description = load_scene(file, warnings, options);
    const Json out = describe_scene(file, description, warnings, files);
    if (json)
        std::printf("%s\n", out.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    else
        print_text(out);
}

} // namespace montelux::app
