#include "montelux/scene/build/check_references.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/geometry.h"
#include "montelux/scene/material/material_model.h"

namespace montelux {
namespace {

std::string numbered(std::string_view what, std::size_t number) {
    return std::string(what) + ' ' + std::to_string(number);
}

// Checks the fields of one light, material or texture, which messages call `owner`.
class FieldCheck {
  public:
    FieldCheck(const Scene& scene, std::string owner) : scene_(scene), owner_(std::move(owner)) {}

    void index(std::string_view field, std::string_view kind, Index index, std::size_t count) const {
        if (index < count) return;
        throw Error(owner_ + ", " + std::string(field) + ": there is no " + numbered(kind, index) +
                    "; the scene has " + std::to_string(count));
    }

    void operator()(std::string_view field, const SceneSpectrum& s) const {
        if (!s.is_constant()) index(field, "spectrum", s.index, scene_.spectra.size());
    }
    void operator()(std::string_view field, const SpectrumParameter& p) const {
        if (p.is_constant())
            (*this)(field, p.value);
        else
            index(field, "spectrum texture", p.texture, scene_.spectrum_textures.size());
    }
    void operator()(std::string_view field, const FloatParameter& p) const {
        if (!p.is_constant()) index(field, "float texture", p.texture, scene_.float_textures.size());
    }
    void operator()(std::string_view field, const NormalMapParameter& p) const {
        if (p.is_given()) index(field, "normal map", p.map, scene_.normal_maps.size());
    }
    void operator()(std::string_view field, const MeasuredBrdfIndex& b) const {
        if (!b.is_given()) throw Error(owner_ + ", " + std::string(field) + ": no measured BRDF is given");
        index(field, "measured BRDF", b.index, scene_.measured_brdfs.size());
    }
    void operator()(std::string_view field, const MediumIndex& m) const {
        if (m.is_given()) index(field, "medium", m.index, scene_.media.size());
    }
    void operator()(std::string_view field, const MaterialIndex& r) const {
        if (!r.is_given()) throw Error(owner_ + ", " + std::string(field) + ": no material is given");
        index(field, "material", r.index, scene_.materials.size());
    }
    void operator()(std::string_view field, const MaterialOfSide& r) const {
        if (r.is_given()) index(field, "material", r.index, scene_.materials.size());
    }
    void operator()(std::string_view field, const ImageTexture& t) const {
        index(field, "image", t.image, scene_.images.size());
    }
    void operator()(std::string_view, float) const {}
    void operator()(std::string_view, int) const {}
    void operator()(std::string_view, bool) const {}
    void operator()(std::string_view, MicrofacetDistribution) const {}

  private:
    const Scene& scene_;
    std::string owner_;
};

std::string name_of_texture(const Scene& scene, std::size_t node) {
    const std::size_t floats = scene.float_textures.size();
    return node < floats ? numbered("float texture", node) : numbered("spectrum texture", node - floats);
}

// The textures that each texture looks up; spectrum textures are numbered after the float textures.
std::vector<std::vector<std::size_t>> texture_inputs(const Scene& scene) {
    std::vector<std::vector<std::size_t>> inputs;
    const auto add = [&](const auto& texture) {
        inputs.emplace_back();
        visit_inputs(texture, [&]<typename Input>(std::string_view, const Input& input) {
            if constexpr (requires { input.texture; })
                if (!input.is_constant())
                    inputs.back().push_back(
                        input.texture +
                        (std::is_same_v<Input, SpectrumParameter> ? scene.float_textures.size() : 0));
        });
    };
    for (const FloatTexture& t : scene.float_textures) add(t);
    for (const SpectrumTexture& t : scene.spectrum_textures) add(t);
    return inputs;
}

// A look-up calls itself for each level.
constexpr int most_levels = 64;

// A depth-first search with its own stack: a chain of textures may be long.
void check_nesting(const Scene& scene) {
    enum class State : char { unseen, open, done };
    const std::vector<std::vector<std::size_t>> inputs = texture_inputs(scene);
    std::vector<State> state(inputs.size(), State::unseen);
    std::vector<int> levels(inputs.size(), 1);             // of a texture and those below it
    std::vector<std::pair<std::size_t, std::size_t>> path; // texture and number of its next input
    const auto enter = [&](std::size_t texture) {
        state[texture] = State::open;
        path.emplace_back(texture, 0);
    };
    for (std::size_t start = 0; start < inputs.size(); ++start) {
        if (state[start] == State::unseen) enter(start);
        while (!path.empty()) {
            const std::size_t texture = path.back().first;
            if (path.back().second == inputs[texture].size()) {
                for (const std::size_t input : inputs[texture])
                    levels[texture] = std::max(levels[texture], levels[input] + 1);
                if (levels[texture] > most_levels)
                    throw Error(name_of_texture(scene, texture) +
                                ": textures refer to one another more than " + std::to_string(most_levels) +
                                " levels deep");
                state[texture] = State::done;
                path.pop_back();
                continue;
            }
            const std::size_t input = inputs[texture][path.back().second++];
            if (state[input] == State::open)
                throw Error(name_of_texture(scene, input) + " depends on itself");
            if (state[input] == State::unseen) enter(input);
        }
    }
}

// Materials that choose among others: no cycles, and at most most_levels deep.
class MaterialNesting {
  public:
    explicit MaterialNesting(const Scene& scene) : scene_(scene), levels_(scene.materials.size(), unseen) {}

    int levels_of(Index i) {
        if (levels_[i] == open) throw Error(described(i) + " depends on itself");
        if (levels_[i] != unseen) return levels_[i];
        levels_[i] = open;
        check(++depth_, i);
        int levels = 1;
        visit_parts(scene_.materials[i], [&](Index part) { levels = std::max(levels, levels_of(part) + 1); });
        --depth_;
        check(levels, i);
        return levels_[i] = levels;
    }

  private:
    static constexpr int unseen = 0, open = -1;

    std::string described(Index i) const {
        const char* name = std::visit([](const auto& m) { return m.name; }, scene_.materials[i]);
        return numbered("material", i) + " (" + name + ')';
    }
    void check(int levels, Index i) const {
        if (levels > most_levels)
            throw Error(described(i) + ": materials refer to one another more than " +
                        std::to_string(most_levels) + " levels deep");
    }

    const Scene& scene_;
    std::vector<int> levels_;
    int depth_ = 0;
};

} // namespace

void check_light(const Scene& scene, const Light& light, std::size_t new_shapes) {
    std::visit(
        [&](const auto& l) {
            const FieldCheck check(scene,
                                   numbered("light", scene.lights.size()) + " (" + std::string(l.name) + ')');
            if constexpr (requires { l.spectrum; }) check("spectrum", l.spectrum);
            if constexpr (requires { l.shape; })
                check.index("shape", "shape", l.shape, scene.shapes.size() + new_shapes);
            if constexpr (requires { l.environment; })
                check.index("environment", "environment map", l.environment, scene.environments.size());
            if constexpr (requires { l.picture; })
                if (l.picture != no_index)
                    check.index("picture", "picture", l.picture, scene.environments.size());
            if constexpr (requires { l.motion; })
                if (l.motion != no_index) check.index("motion", "motion", l.motion, scene.motions.size());
            if constexpr (requires { l.sky; }) check.index("sky", "sky", l.sky, scene.skies.size());
        },
        light);
}

void check_materials(const Scene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        std::visit(
            [&](const auto& m) {
                const FieldCheck check(scene, numbered("material", i) + " (" + m.name + ')');
                visit_parameters(m, [&](const ParameterInfo& info, const auto& field) {
                    visit_leaves(info.name, field, [&](std::string_view leaf, const auto& value) {
                        check(ParameterInfo{.prefix = info.prefix, .name = leaf}.python_name(), value);
                    });
                });
            },
            scene.materials[i]);
    MaterialNesting nesting(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) nesting.levels_of(static_cast<Index>(i));
}

void check_media(const Scene& scene) {
    const auto check_grid = [](const FieldCheck& check, std::string_view field, Index index,
                               const auto& grids, std::string_view kind) {
        if (index == no_index) return;
        check.index(field, kind, index, grids.size());
        const auto& grid = grids[index];
        if (grid.values.empty() || grid.values.size() != grid.count())
            throw Error(numbered(kind, index) + " has " + std::to_string(grid.values.size()) +
                        " values; its size wants " + std::to_string(grid.count()));
    };
    const auto check_sparse_grid = [&](const FieldCheck& check, std::string_view field, Index index) {
        if (index == no_index) return;
        check.index(field, "sparse grid", index, scene.sparse_grids.size());
        if (!scene.sparse_grids[index].is_consistent())
            throw Error(numbered("sparse grid", index) + " has tables that lead outside it");
    };
    for (std::size_t i = 0; i < scene.media.size(); ++i)
        std::visit(
            [&](const auto& m) {
                const FieldCheck check(scene, numbered("medium", i) + " (" + m.name + ')');
                if constexpr (requires { m.albedo; }) {
                    for (const MediumField& field : {m.extinction, m.albedo}) {
                        check("value", field.value);
                        check_grid(check, "scalars", field.scalars, scene.scalar_grids, "scalar grid");
                        check_grid(check, "colors", field.colors, scene.color_grids, "color grid");
                    }
                } else if constexpr (std::is_same_v<decltype(m.sigma_a), SceneSpectrum>) {
                    check("sigma_a", m.sigma_a);
                    check("sigma_s", m.sigma_s);
                } else {
                    check_grid(check, "sigma_a", m.sigma_a, scene.color_grids, "color grid");
                    check_grid(check, "sigma_s", m.sigma_s, scene.color_grids, "color grid");
                    check_grid(check, "le", m.le, scene.color_grids, "color grid");
                    check("illuminant", m.illuminant);
                }
                if constexpr (requires { m.le_grid; }) {
                    check.index("density", "scalar grid", m.density, scene.scalar_grids.size());
                    check_grid(check, "density", m.density, scene.scalar_grids, "scalar grid");
                    check_grid(check, "le_grid", m.le_grid, scene.scalar_grids, "scalar grid");
                    check_grid(check, "temperature", m.temperature, scene.scalar_grids, "scalar grid");
                }
                if constexpr (std::is_same_v<std::decay_t<decltype(m)>, SparseGridMedium>) {
                    check.index("density", "sparse grid", m.density, scene.sparse_grids.size());
                    check_sparse_grid(check, "density", m.density);
                    check_sparse_grid(check, "temperature", m.temperature);
                }
                if constexpr (requires { m.surface; }) {
                    check("surface", m.surface.first);
                    check("surface", m.surface.second);
                }
                if constexpr (requires { check("le", m.le); }) check("le", m.le);
            },
            scene.media[i]);
    const auto check_place = [&](const std::string& owner, Index medium) {
        if (medium != no_index)
            FieldCheck(scene, owner).index("medium", "medium", medium, scene.media.size());
    };
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        check_place(numbered("shape", i), scene.shapes[i].media.inside);
        check_place(numbered("shape", i), scene.shapes[i].media.outside);
    }
    check_place("the camera", scene.camera.medium);
}

void check_textures(const Scene& scene) {
    for (std::size_t i = 0; i < scene.float_textures.size(); ++i)
        visit_inputs(scene.float_textures[i], FieldCheck(scene, numbered("float texture", i)));
    for (std::size_t i = 0; i < scene.spectrum_textures.size(); ++i)
        visit_inputs(scene.spectrum_textures[i], FieldCheck(scene, numbered("spectrum texture", i)));
    for (std::size_t i = 0; i < scene.normal_maps.size(); ++i)
        FieldCheck(scene, numbered("normal map", i))("image", scene.normal_maps[i]);
    check_nesting(scene);
}

} // namespace montelux
