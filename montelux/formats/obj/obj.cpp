#include "montelux/formats/obj/obj.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_set>
#include <utility>

#include "montelux/formats/number.h"
#include "montelux/formats/obj/statements.h"
#include "montelux/formats/triangulate.h"
#include "montelux/formats/vertex_normals.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {
namespace {

using obj::Statements;
using obj::Words;

// Indices of a corner of a triangle; texture coordinates and normal may be no_index.
struct Corner {
    Index position = no_index, uv = no_index, normal = no_index;
};
struct FaceTriangle {
    std::array<Corner, 3> corners;
    Index part = 0;
    std::uint32_t smoothing = 0; // group; 0: none
};

class ObjParser {
  public:
    ObjParser(std::string_view text, std::string_view name, Warnings& warnings, const ObjSettings& settings)
        : statements_(text, name), name_(name), warnings_(warnings), settings_(settings) {}

    ObjModel parse() {
        while (statements_.next()) read(statements_.keyword(), statements_.words());
        if (triangulator_.fans() > 0)
            warnings_.add(name_, std::to_string(triangulator_.fans()) +
                                     " concave polygons cross themselves or have more than " +
                                     std::to_string(Triangulator::most_clipped) +
                                     " corners; their triangles may cover more than they do");
        if (degenerate_ > 0)
            warnings_.add(name_, std::to_string(degenerate_) + " faces of fewer than 3 corners are left out");
        if (!colors_.empty()) colors_.resize(positions_.size(), Vec3f(1, 1, 1));
        if (settings_.make_normals) make_normals();
        build_parts();
        return std::move(model_);
    }

  private:
    void read(std::string_view keyword, Words& words) {
        if (keyword == "v")
            read_position(words);
        else if (keyword == "vt")
            read_uv(words);
        else if (keyword == "vn")
            read_normal(words);
        else if (keyword == "f" || keyword == "fo")
            read_face(words);
        else if (keyword == "o")
            name_of_object_ = words.rest(), part_is_open_ = false;
        else if (keyword == "g")
            name_of_group_ = words.rest(), part_is_open_ = false;
        else if (keyword == "usemtl")
            material_ = words.rest(), part_is_open_ = false;
        else if (keyword == "mtllib")
            model_.libraries.push_back({std::string(words.rest()), statements_.line()});
        else if (keyword == "s")
            read_smoothing(words);
        else
            warn_of(keyword);
    }

    // Each keyword once.
    void warn_of(std::string_view keyword) {
        if (told_.size() >= Warnings::max_messages || !told_.insert(std::string(keyword)).second) return;
        const auto is_one_of = [&](auto... names) { return ((keyword == names) || ...); };
        std::string why = " is unknown and ignored";
        if (is_one_of("l", "p"))
            why = " is ignored: lines and points are not rendered";
        else if (is_one_of("vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",
                           "hole", "scrv", "sp", "end", "con", "ctech", "stech"))
            why = " is ignored: curves and free-form surfaces are not read";
        else if (is_one_of("lod", "bevel", "c_interp", "d_interp", "mg", "shadow_obj", "trace_obj", "maplib",
                           "usemap", "call", "csh"))
            why = " is ignored";
        warnings_.add(statements_.words().where(), quoted(keyword) + why);
    }

    void check_count(std::size_t count, const Words& words) const {
        if (count >= std::size_t{std::numeric_limits<std::int32_t>::max()})
            words.error("more than 2^31 vertices");
    }
    void read_position(Words& words) {
        check_count(positions_.size(), words);
        const float x = words.number("the 3 coordinates of a vertex"),
                    y = words.number("3 coordinates, read 1"), z = words.number("3 coordinates, read 2");
        positions_.push_back({x, y, z});
        if (words.at_end()) return;
        // One more number is a weight, three are a colour, four are both.
        std::size_t count = 0;
        std::array<float, 4> more{};
        for (; !words.at_end(); ++count) {
            const float value = words.number("a weight or a colour behind the coordinates");
            if (count < more.size()) more[count] = value;
        }
        if ((count == 1 || count == 4) && more[0] != 1) warn_of_vertices("weights", "are ignored");
        if (count < 3) return;
        if (!settings_.colors) return warn_of_vertices("colours", "are ignored");
        const std::size_t first = count == 3 ? 0 : 1;
        colors_.resize(positions_.size() - 1, Vec3f(1, 1, 1));
        colors_.emplace_back(more[first], more[first + 1], more[first + 2]);
    }
    void warn_of_vertices(const std::string& what, const std::string& why) {
        const std::string sentence = what + " of vertices " + why;
        if (told_.insert(sentence).second) warnings_.add(statements_.words().where(), sentence);
    }
    void read_uv(Words& words) {
        check_count(uvs_.size(), words);
        const float u = words.number("1 to 3 texture coordinates");
        uvs_.push_back({u, words.at_end() ? 0 : words.number("a texture coordinate")});
    }
    void read_normal(Words& words) {
        check_count(normals_.size(), words);
        const float x = words.number("the 3 components of a normal"),
                    y = words.number("3 components, read 1");
        normals_.push_back({x, y, words.number("3 components, read 2")});
    }
    void read_smoothing(Words& words) {
        const std::string_view group = words.next();
        has_smoothing_ = true;
        if (group == "off") {
            smoothing_ = 0;
            return;
        }
        std::int32_t number = group == "on" ? 1 : -1;
        if (number < 0) {
            const NumberResult r = parse_number(group.data(), group.data() + group.size(), number);
            if (r.status != NumberStatus::ok || r.end != group.data() + group.size() || number < 0)
                words.error("read smoothing group " + quoted(group) + "; expected a number or 'off'");
        }
        smoothing_ = static_cast<std::uint32_t>(number);
    }

    // A number of [1, count] or of [-count, -1], where -1 is the last one so far.
    static Index read_index(Words& words, const char*& p, const char* what, std::size_t count) {
        std::int32_t i = 0;
        const NumberResult r = parse_number(p, words.end(), i);
        if (r.status == NumberStatus::malformed ||
            (r.end != words.end() && *r.end != '/' && !obj::is_space(*r.end)))
            words.error("read " + quoted(words.next()) +
                        "; expected a corner of a face, such as 3, 3/1 or 3/1/2");
        const auto size = static_cast<std::int64_t>(count);
        const std::int64_t index = i < 0 ? size + i : std::int64_t{i} - 1;
        if (r.status != NumberStatus::ok || i == 0 || index < 0 || index >= size) {
            const std::string digits(p, r.end);
            words.error("the face refers to " + std::string(what) + " " + digits +
                        (i == 0 && r.status == NumberStatus::ok
                             ? "; indices count from 1"
                             : "; there are " + std::to_string(count) + " so far"));
        }
        p = r.end;
        return static_cast<Index>(index);
    }
    Corner read_corner(Words& words) {
        Corner corner;
        const char* p = words.position();
        corner.position = read_index(words, p, "vertex", positions_.size());
        if (p != words.end() && *p == '/') {
            ++p;
            const bool has_uv = p != words.end() && *p != '/' && !obj::is_space(*p);
            if (has_uv) corner.uv = read_index(words, p, "texture coordinates", uvs_.size());
            if (p != words.end() && *p == '/') {
                ++p;
                if (p != words.end() && !obj::is_space(*p))
                    corner.normal = read_index(words, p, "normal", normals_.size());
            }
        }
        if (p != words.end() && !obj::is_space(*p))
            words.error("read " + quoted(words.next()) +
                        "; expected a corner of a face, such as 3, 3/1 or 3/1/2");
        words.position() = p;
        return corner;
    }
    void read_face(Words& words) {
        corners_.clear();
        while (!words.at_end()) corners_.push_back(read_corner(words));
        if (corners_.size() < 3) {
            ++degenerate_;
            return;
        }
        if (!part_is_open_) open_part();
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            triangles_.push_back({{corners_[a], corners_[b], corners_[c]}, part_, smoothing_});
        };
        if (corners_.size() == 3) return add(0, 1, 2);
        polygon_.clear();
        for (const Corner& c : corners_) polygon_.push_back(positions_[c.position]);
        for (const Triangulator::Triangle& t : triangulator_.split(polygon_)) add(t[0], t[1], t[2]);
    }
    void open_part() {
        part_is_open_ = true;
        if (!settings_.split && !model_.parts.empty()) return;
        const std::string& name = name_of_object_.empty() ? name_of_group_ : name_of_object_;
        const auto [known, is_new] =
            parts_.try_emplace({name, material_}, static_cast<Index>(model_.parts.size()));
        if (is_new) model_.parts.push_back({name, material_, statements_.line(), {}});
        part_ = known->second;
    }

    // Of triangles that have none at one of their corners.
    void make_normals() {
        std::vector<Index> indices;
        std::vector<std::uint32_t> groups;
        std::vector<std::size_t> bare;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (std::ranges::none_of(triangles_[t].corners,
                                     [](const Corner& c) { return c.normal == no_index; }))
                continue;
            bare.push_back(t);
            for (const Corner& c : triangles_[t].corners) indices.push_back(c.position);
            if (has_smoothing_) groups.push_back(triangles_[t].smoothing);
        }
        if (bare.empty()) return;
        const CornerNormals made = corner_normals(positions_, indices, groups);
        for (std::size_t i = 0; i < bare.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                triangles_[bare[i]].corners[k].normal =
                    static_cast<Index>(normals_.size() + made.corners[3 * i + k]);
        normals_.insert(normals_.end(), made.normals.begin(), made.normals.end());
    }

    void build_parts() {
        std::vector<std::size_t> counts(model_.parts.size(), 0);
        std::vector<std::array<bool, 2>> has(model_.parts.size(), {false, true}); // any uv, all normals
        for (const FaceTriangle& t : triangles_) {
            ++counts[t.part];
            for (const Corner& c : t.corners) {
                has[t.part][0] = has[t.part][0] || c.uv != no_index;
                has[t.part][1] = has[t.part][1] && c.normal != no_index;
            }
        }
        // The triangles of each part in order.
        std::vector<std::vector<std::size_t>> of_part(model_.parts.size());
        for (std::size_t p = 0; p < counts.size(); ++p) of_part[p].reserve(counts[p]);
        for (std::size_t t = 0; t < triangles_.size(); ++t) of_part[triangles_[t].part].push_back(t);
        first_.assign(positions_.size(), no_index);
        for (std::size_t p = 0; p < model_.parts.size(); ++p)
            build(model_.parts[p].mesh, of_part[p], has[p][0], has[p][1]);
    }
    // Equal corners share a vertex. Those of one position form a list; its search is cut short, so that the many
    // triangles around one vertex take no time that is quadratic in their number.
    void build(TriangleMesh& mesh, const std::vector<std::size_t>& triangles, bool with_uvs,
               bool with_normals) {
        constexpr int most_steps = 32;
        std::vector<Corner> vertices;
        std::vector<Index> next;
        mesh.indices.reserve(3 * triangles.size());
        for (const std::size_t t : triangles)
            for (Corner c : triangles_[t].corners) {
                if (!with_normals) c.normal = no_index;
                Index v = first_[c.position];
                for (int step = 0; v != no_index; v = ++step < most_steps ? next[v] : no_index)
                    if (vertices[v].uv == c.uv && vertices[v].normal == c.normal) break;
                if (v == no_index) {
                    v = static_cast<Index>(vertices.size());
                    vertices.push_back(c);
                    next.push_back(first_[c.position]);
                    first_[c.position] = v;
                }
                mesh.indices.push_back(v);
            }
        mesh.positions.reserve(vertices.size() + 1); // so that the ray tracer can read them in place
        for (const Corner& c : vertices) {
            mesh.positions.push_back(positions_[c.position]);
            if (with_uvs) mesh.uvs.push_back(c.uv != no_index ? uvs_[c.uv] : Point2f{});
            if (with_normals) mesh.normals.push_back(normals_[c.normal]);
            if (!colors_.empty()) mesh.colors.push_back(colors_[c.position]);
            first_[c.position] = no_index;
        }
    }

    Statements statements_;
    std::string_view name_;
    Warnings& warnings_;
    ObjSettings settings_;
    ObjModel model_;
    std::vector<Point3f> positions_;
    std::vector<Vec3f> colors_; // of positions; empty: none has any
    std::vector<Point2f> uvs_;
    std::vector<Normal3f> normals_;
    std::vector<FaceTriangle> triangles_;
    std::string name_of_object_, name_of_group_, material_;
    bool part_is_open_ = false, has_smoothing_ = false;
    Index part_ = 0;
    std::uint32_t smoothing_ = 0;
    std::map<std::pair<std::string, std::string>, Index> parts_;
    std::vector<Corner> corners_; // of the current face
    std::vector<Point3f> polygon_;
    Triangulator triangulator_;
    std::size_t degenerate_ = 0;
    std::vector<Index> first_; // the vertices of each position, of the part that is built
    std::unordered_set<std::string> told_;
};

} // namespace

ObjModel parse_obj(std::span<const std::uint8_t> bytes, std::string_view name, Warnings& warnings,
                   const ObjSettings& settings) {
    return ObjParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, warnings, settings)
        .parse();
}

} // namespace montelux
