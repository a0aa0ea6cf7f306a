#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/formats/ply.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/float_near.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/geometry.h"
#include "montelux/scene/scene_names.h"

namespace montelux::pbrt {
namespace {

// Meshes up to this size are written into the scene itself.
constexpr std::size_t most_inline_vertices = 64;

std::span<const float> numbers_of(const auto& vectors) {
    if (vectors.empty()) return {};
    return {&vectors[0].x, vectors.size() * (sizeof vectors[0] / sizeof(float))};
}

std::vector<Normal3f> turned(std::vector<Normal3f> normals, bool reverse) {
    if (reverse)
        for (Normal3f& n : normals) n = -n;
    return normals;
}

std::vector<std::int32_t> integers_of(const std::vector<Index>& indices) {
    std::vector<std::int32_t> values(indices.size());
    std::transform(indices.begin(), indices.end(), values.begin(),
                   [](Index i) { return static_cast<std::int32_t>(i); });
    return values;
}

// Degrees that the reader turns into these radians.
float degrees(float radians) {
    const auto radians_of = [](float d) { return std::clamp(d, 0.0f, 360.0f) * (pi_f / 180); };
    if (radians_of(360) == radians) return 360;
    const double guess = double{radians} * 180 / pi;
    return float_near(guess, [&](float d) { return radians_of(d) == radians; })
        .value_or(static_cast<float>(guess));
}

bool same_bits(const auto& a, const auto& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

} // namespace

void SceneWriter::shape_attributes(DirectiveText& d, Index i) {
    const Shape& s = scene_.shapes[i];
    if (!s.alpha.is_constant())
        d.texture("alpha", float_texture(s.alpha.texture));
    else if (s.alpha.value != 1)
        d.number("alpha", s.alpha.value);
    if (i < scene_.shape_names.size() && !scene_.shape_names[i].empty())
        d.string("name", scene_.shape_names[i]);
}

// With vertex tangents, which PLY files do not hold, and small ones in the scene itself; others as a file, whose name
// is the one that a shape without a name has.
std::string SceneWriter::mesh_text(Index i, const TriangleMesh& mesh, bool reverse) {
    const std::string what = "shape " + std::to_string(i);
    if (mesh.deforms())
        warn(what, "its mesh deforms, which pbrt's syntax cannot say; it is written as it is at the start");
    if (mesh.positions.size() > INT32_MAX)
        throw Error(what, "its mesh has more vertices than pbrt's syntax can number");
    const std::vector<Normal3f> normals = turned(mesh.normals, reverse);
    if (mesh.positions.empty() || mesh.indices.empty() ||
        (mesh.positions.size() > most_inline_vertices && mesh.tangents.empty())) {
        const std::string name = "shape-" + std::to_string(i) + ".ply";
        AtomicFile file(files_.add(name));
        write_ply(file, mesh, normals);
        file.commit();
        DirectiveText d("Shape \"plymesh\"");
        d.string("filename", files_.reference(name));
        if (!mesh.colors.empty() || !mesh.opacities.empty()) d.boolean("vertexcolors", true);
        shape_attributes(d, i);
        return d.text();
    }
    DirectiveText d("Shape \"trianglemesh\"");
    d.numbers("point3", "P", numbers_of(mesh.positions));
    if (!normals.empty()) d.numbers("normal", "N", numbers_of(normals));
    if (!mesh.tangents.empty()) d.numbers("vector3", "S", numbers_of(mesh.tangents));
    if (!mesh.uvs.empty()) d.numbers("point2", "uv", numbers_of(mesh.uvs));
    if (!mesh.second_uvs.empty()) d.numbers("point2", "uv2", numbers_of(mesh.second_uvs));
    if (!mesh.colors.empty()) d.numbers("rgb", "colors", numbers_of(mesh.colors));
    if (!mesh.opacities.empty()) d.numbers("float", "opacities", mesh.opacities);
    d.integers("indices", integers_of(mesh.indices));
    shape_attributes(d, i);
    return d.text();
}

// As strands of connected segments whose widths change evenly. Consecutive curves that differ in nothing else become
// one shape again.
void SceneWriter::curves_text(std::vector<std::string>& texts, const Curves& curves) const {
    constexpr std::array kinds = {"flat", "cylinder", "ribbon", "cylinder"};
    const std::size_t count = curves.segment_count();
    for (std::size_t first = 0; first < count;) {
        const auto strand_of = [&](std::size_t last, std::vector<Point3f>& points,
                                   std::vector<Normal3f>& normals) {
            points = {curves.control_points[first][0]};
            normals.clear();
            for (std::size_t k = first; k <= last; ++k) {
                points.insert(points.end(), curves.control_points[k].begin() + 1,
                              curves.control_points[k].end());
                if (curves.normals.empty()) continue;
                if (k == first) normals.push_back(curves.normals[k][0]);
                normals.push_back(curves.normals[k][1]);
            }
            Strand s;
            s.points = points;
            s.normals = normals;
            s.width0 = curves.widths[first][0];
            s.width1 = curves.widths[last][1];
            return s;
        };
        std::vector<Point3f> points;
        std::vector<Normal3f> normals;
        // The longest run that is read back bit for bit.
        std::size_t last = first;
        while (last + 1 < count && curves.control_points[last][3] == curves.control_points[last + 1][0] &&
               curves.widths[last][1] == curves.widths[last + 1][0])
            ++last;
        for (; last > first; --last) {
            Curves made{.kind = curves.kind, .control_points = {}, .widths = {}, .normals = {}};
            append(made, strand_of(last, points, normals), Transform());
            const std::size_t n = last - first + 1;
            if (same_bits(made.control_points, std::span(curves.control_points).subspan(first, n)) &&
                same_bits(made.widths, std::span(curves.widths).subspan(first, n)))
                break;
        }
        const Strand s = strand_of(last, points, normals);
        DirectiveText d("Shape \"curve\"");
        d.string("type", kinds[static_cast<std::size_t>(curves.kind)]);
        d.numbers("point3", "P", numbers_of(points));
        if (!normals.empty()) d.numbers("normal", "N", numbers_of(normals));
        d.number("width0", s.width0);
        d.number("width1", s.width1);
        texts.push_back(d.text());
        first = last + 1;
    }
}

std::string SceneWriter::shape_text(Index i, bool reverse) {
    const Shape& s = scene_.shapes[i];
    std::string text;
    visit_geometry(scene_, s,
                   Overloaded{[&](const TriangleMesh& mesh) { text = mesh_text(i, mesh, reverse); },
                              [&](const BilinearMesh& mesh) {
                                  DirectiveText d("Shape \"bilinearmesh\"");
                                  d.numbers("point3", "P", numbers_of(mesh.positions));
                                  const std::vector<Normal3f> normals = turned(mesh.normals, reverse);
                                  if (!normals.empty()) d.numbers("normal", "N", numbers_of(normals));
                                  if (!mesh.uvs.empty()) d.numbers("point2", "uv", numbers_of(mesh.uvs));
                                  d.integers("indices", integers_of(mesh.indices));
                                  shape_attributes(d, i);
                                  text = d.text();
                              },
                              [&](const Curves& curves) {
                                  if (curves.kind == Curves::Kind::tube)
                                      warn("shape " + std::to_string(i),
                                           "its normals and texture coordinates become those of "
                                           "pbrt's cylindrical curves");
                                  DirectiveText attributes("");
                                  shape_attributes(attributes, i);
                                  std::string rest = attributes.text();
                                  std::vector<std::string> texts;
                                  curves_text(texts, curves);
                                  if (texts.size() > 1 && !s.alpha.is_constant())
                                      warn("shape " + std::to_string(i),
                                           "its curves become " + std::to_string(texts.size()) +
                                               " shapes, since its alpha is a texture");
                                  for (std::string& t : texts) {
                                      t.pop_back();
                                      text += t + rest;
                                  }
                              },
                              [&](const Quadric& quadric) {
                                  std::visit(Overloaded{[&](const Sphere& q) {
                                                            DirectiveText d("Shape \"sphere\"");
                                                            d.number("radius", q.radius);
                                                            if (q.z_min != -q.radius)
                                                                d.number("zmin", q.z_min);
                                                            if (q.z_max != q.radius)
                                                                d.number("zmax", q.z_max);
                                                            d.number("phimax", degrees(q.phi_max));
                                                            shape_attributes(d, i);
                                                            text = d.text();
                                                        },
                                                        [&](const Disk& q) {
                                                            DirectiveText d("Shape \"disk\"");
                                                            if (q.polar)
                                                                warn("shape " + std::to_string(i),
                                                                     "its texture coordinates become "
                                                                     "those of pbrt's disks");
                                                            d.number("height", q.height);
                                                            d.number("radius", q.radius);
                                                            d.number("innerradius", q.inner_radius);
                                                            d.number("phimax", degrees(q.phi_max));
                                                            shape_attributes(d, i);
                                                            text = d.text();
                                                        },
                                                        [&](const Cylinder& q) {
                                                            DirectiveText d("Shape \"cylinder\"");
                                                            d.number("radius", q.radius);
                                                            d.number("zmin", q.z_min);
                                                            d.number("zmax", q.z_max);
                                                            d.number("phimax", degrees(q.phi_max));
                                                            shape_attributes(d, i);
                                                            text = d.text();
                                                        }},
                                             quadric);
                              }});
    return text;
}

// `moving`: the one instance of the object that was made for a shape that moves; null for all other shapes.
void SceneWriter::shape(Index i, const Instance* moving) {
    const Shape& s = scene_.shapes[i];
    const Quadric* quadric = quadric_of(scene_, s);
    const auto* place = quadric != nullptr
                            ? std::visit([](const auto& q) { return &q.world_from_object; }, *quadric)
                            : nullptr;
    std::string before;
    bool mirrored = place != nullptr && place->swaps_handedness();
    if (moving != nullptr) {
        const Motion& m = scene_.motions[moving->motion];
        before = motion_text(m.start(), m.end());
        mirrored = place != nullptr && s.light != no_index && m.start().swaps_handedness();
    } else if (place != nullptr) {
        before = transform_text(*place);
    }
    const bool reverse = s.flip_normal != mirrored;
    if (reverse) before += "ReverseOrientation\n";
    before += interface_text(s.media);
    before += "NamedMaterial " + quoted_text(material_names_[s.material]) + "\n";
    if (s.light != no_index) {
        lights_before(s.light);
        lights_ = std::max(lights_, std::size_t{s.light} + 1);
        before += area_light(s.light, quadric != nullptr, quadric != nullptr ? object_area(*quadric) : 0);
    }
    const std::string text = shape_text(i, reverse); // may write textures
    put_block(before + text);
}

void SceneWriter::instance(std::size_t i) {
    const Instance& instance = scene_.instances[i];
    std::string text = instance.motion == no_index ? transform_text(instance.world_from_object)
                                                   : motion_text(scene_.motions[instance.motion].start(),
                                                                 scene_.motions[instance.motion].end());
    if (instance.motion != no_index && scene_.motions[instance.motion].is_product())
        warn("instance " + std::to_string(i),
             "it moves within an object that is placed; its path is written as that of "
             "pbrt between the same places");
    put_block(text + "ObjectInstance " + quoted_text(object_names_[instance.object]) + "\n");
}

void SceneWriter::instances_before(std::size_t end) {
    for (; instances_ < end; ++instances_) instance(instances_);
}

void SceneWriter::shapes() {
    // Names of objects are their own, or made up.
    std::map<std::string, int> taken;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
        std::string name = scene_.objects[i].name;
        if (name.empty()) name = "object-" + std::to_string(i);
        while (taken[name]++ > 0) name += "'";
        object_names_.push_back(name);
    }
    std::vector<Index> object_of(scene_.shapes.size(), no_index), order;
    for (Index o = 0; o < scene_.objects.size(); ++o)
        for (const Index s : scene_.objects[o].shapes) object_of[s] = o;
    // The instance of an object that was made for a moving shape.
    std::vector<Index> only_instance(scene_.objects.size(), no_index), uses(scene_.objects.size(), 0);
    for (Index i = 0; i < scene_.instances.size(); ++i) {
        only_instance[scene_.instances[i].object] = i;
        ++uses[scene_.instances[i].object];
    }
    const auto is_moving_shape = [&](Index o) {
        const ObjectDefinition& object = scene_.objects[o];
        if (!object.name.empty() || !object.shines || object.shapes.size() != 1 || uses[o] != 1 ||
            scene_.instances[only_instance[o]].motion == no_index)
            return false;
        const Quadric* quadric = quadric_of(scene_, scene_.shapes[object.shapes[0]]);
        return quadric == nullptr ||
               std::visit([](const auto& q) { return q.world_from_object == Transform(); }, *quadric);
    };
    std::vector<char> written(scene_.objects.size(), 0);
    Index next_object = 0;
    const auto write_object = [&](Index o) {
        put("ObjectBegin " + quoted_text(object_names_[o]) + "\n");
        for (const Index s : scene_.objects[o].shapes) shape(s, nullptr);
        put("ObjectEnd\n");
        written[o] = 1;
    };
    for (Index s = 0; s < scene_.shapes.size(); ++s) {
        const Index o = object_of[s];
        if (o == no_index) {
            shape(s, nullptr);
            continue;
        }
        // Objects without shapes before this one.
        for (; next_object < o; ++next_object)
            if (!written[next_object] && scene_.objects[next_object].shapes.empty())
                write_object(next_object);
        if (written[o]) continue;
        if (!is_moving_shape(o)) {
            write_object(o);
            continue;
        }
        const Index i = only_instance[o];
        for (; instances_ < i; ++instances_) instance(instances_);
        shape(s, &scene_.instances[i]);
        instances_ = std::max(instances_, std::size_t{i} + 1);
        written[o] = 1;
    }
    for (Index o = 0; o < scene_.objects.size(); ++o)
        if (!written[o]) write_object(o);
}

} // namespace montelux::pbrt
