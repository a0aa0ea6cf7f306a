#include "montelux/formats/pbrt/displacement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "montelux/formats/mesh_displacement.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/texture/evaluate.h"

namespace montelux::pbrt {
namespace {

// The float textures of an unfinished scene, with pyramids of the pictures that one of them reads.
class TextureTables {
  public:
    TextureTables(const Scene& scene, Index root) : textures_(scene.float_textures) {
        add_pictures(scene, root);
        view_ = SceneView(scene);
        view_.float_textures = textures_;
        view_.mipmaps = colors_;
        view_.alpha_mipmap_of_image = alpha_of_picture_;
        view_.alpha_mipmaps = alphas_;
    }

    const SceneView& view() const { return view_; }

  private:
    void add_pictures(const Scene& scene, Index root) {
        std::vector<Index> open{root};
        std::vector<char> seen(textures_.size());
        while (!open.empty()) {
            const Index i = open.back();
            open.pop_back();
            if (std::exchange(seen[i], 1) != 0) continue;
            if (auto* t = std::get_if<ImageTexture>(&textures_[i])) {
                t->image = picture(scene, *t);
                continue;
            }
            visit_inputs(textures_[i], [&](const char*, const auto& input) {
                if constexpr (std::is_same_v<std::decay_t<decltype(input)>, FloatParameter>)
                    if (!input.is_constant()) open.push_back(input.texture);
            });
        }
    }

    Index picture(const Scene& scene, const ImageTexture& t) {
        const auto [known, is_new] = pictures_.emplace(t.image, static_cast<Index>(colors_.size()));
        const Index i = known->second;
        if (is_new) {
            colors_.emplace_back(scene.images[t.image]);
            alpha_of_picture_.push_back(no_index);
        }
        if (t.channels == ImageChannels::alpha && alpha_of_picture_[i] == no_index) {
            alpha_of_picture_[i] = static_cast<Index>(alphas_.size());
            alphas_.emplace_back(scene.images[t.image], ImageChannels::alpha);
        }
        return i;
    }

    std::vector<FloatTexture> textures_; // their pictures are indices into colors_
    std::map<Index, Index> pictures_;    // from Scene::images
    std::vector<MipMap> colors_, alphas_;
    std::vector<Index> alpha_of_picture_;
    SceneView view_;
};

} // namespace

std::vector<float> DisplacementReader::heights(const TriangleMesh& mesh, const FloatParameter& height,
                                               const Transform& world_from_object) const {
    std::vector<float> result(mesh.positions.size(), height.value);
    if (height.is_constant()) return result;
    const TextureTables tables(builder_.scene(), height.texture);
    const FloatTexture& root = tables.view().float_textures[height.texture];
    parallel_for(static_cast<std::int64_t>(result.size()), [&](std::int64_t k) {
        const auto i = static_cast<std::size_t>(k);
        TextureContext context;
        context.p = world_from_object.point(mesh.positions[i]);
        context.n = normalize(world_from_object.normal(mesh.normals[i]));
        context.uv = mesh.uvs[i];
        result[i] = evaluate_texture(tables.view(), root, context);
    });
    return result;
}

void DisplacementReader::displace(ParameterReader& r, TriangleMesh& mesh,
                                  const Transform& world_from_object) {
    const float edge_length = r.number("edgelength", 1);
    const std::optional<FloatParameter> height = textures_.find_float(r, "displacement");
    if (!height) return;
    const float longest = edge_length * edge_scale_;
    if (!(longest > 0)) r.error("edgelength", "the longest edge of a displaced mesh must be positive");
    if (mesh.uvs.empty() && !height->is_constant())
        r.error("displacement", "the mesh has no texture coordinates, which 'displacement' needs");
    const std::size_t most = max_displaced_triangles - triangles_;
    if (!refine_edges(mesh, world_from_object, longest, most))
        r.error("edgelength", "edges below " + std::to_string(longest) +
                                  " would give more triangles than the " + std::to_string(most) +
                                  " that the displaced shapes before leave of " +
                                  std::to_string(max_displaced_triangles));
    triangles_ += mesh.triangle_count();
    const std::vector<float> moves = heights(mesh, *height, world_from_object);
    if (!std::all_of(moves.begin(), moves.end(), [](float h) { return std::isfinite(h); }))
        r.error("displacement", "the displacement is not finite everywhere on the mesh");
    displace_vertices(mesh, moves);
}

} // namespace montelux::pbrt
