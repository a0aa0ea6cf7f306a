// Paths on plain diffuse surfaces, shaded together in lanes.
#pragma once

#include <array>
#include <limits>
#include <variant>

#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/math/vec_lanes.h"
#include "montelux/mc/random/lane_stream.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/shape/shading_terminator.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/spectrum/spectrum_lanes.h"
#include "montelux/transport/path_integrator.h"

namespace montelux {

// What can be done in lanes at a hit.
enum class LaneShading : std::uint8_t {
    none,
    scattering, // a diffuse material without bumps and normal map
    all,        // ... without textures, on a triangle of the world that does not deform
};
inline LaneShading lane_shading(const SceneView& scene, const Hit& hit) {
    const Shape& shape = scene.shapes[hit.shape];
    const auto* diffuse = std::get_if<DiffuseMaterial>(&scene.materials[shape.material]);
    if (diffuse == nullptr || !diffuse->detail.is_flat()) return LaneShading::none;
    if (scene.soft_terminator && has_vertex_normals(scene, shape)) return LaneShading::none;
    const TriangleMesh* mesh = hit.instance == no_index ? mesh_of(scene, shape) : nullptr;
    const bool plain = mesh != nullptr && !mesh->deforms() && !scene.is_textured(shape.material) &&
                       !scene.frame_follows_tangents(shape.material);
    return plain ? LaneShading::all : LaneShading::scattering;
}

// Hits that wait until there are W of them. What it refers to must stay where it is.
template <int W>
struct HitGroup {
    std::array<Index, W> paths; // of the batch
    std::array<PathState*, W> states;
    std::array<const Hit*, W> hits;
    std::array<SampleStream*, W> streams;
    int size = 0;

    void add(Index path, PathState& state, const Hit& hit, SampleStream& stream) {
        const auto i = static_cast<std::size_t>(size++);
        paths[i] = path;
        states[i] = &state;
        hits[i] = &hit;
        streams[i] = &stream;
    }
    bool full() const { return size == W; }
};

// Of hits for which everything can be done in lanes.
template <int W>
TrianglePoint<Lanes<W>> triangle_points(const SceneView& scene, const std::array<const Hit*, W>& hits) {
    Vec3<Lanes<W>> p0, p1, p2, vertex_normal;
    Lanes<W> b1, b2;
    LaneMask<W> flipped(false);
    for (int i = 0; i < W; ++i) {
        const Hit& hit = *hits[static_cast<std::size_t>(i)];
        const Shape& shape = scene.shapes[hit.shape];
        const TriangleMesh& mesh = scene.meshes[std::get_if<MeshIndex>(&shape.geometry)->index];
        const Index* v = &mesh.indices[3 * std::size_t{hit.primitive}];
        set_lane(p0, i, mesh.positions[v[0]]);
        set_lane(p1, i, mesh.positions[v[1]]);
        set_lane(p2, i, mesh.positions[v[2]]);
        if (!mesh.normals.empty()) set_lane(vertex_normal, i, interpolated_normal(mesh, v, hit.b1, hit.b2));
        b1.set(i, hit.b1);
        b2.set(i, hit.b2);
        flipped.set(i, shape.flip_normal);
    }
    return triangle_point(p0, p1, p2, b1, b2, flipped, vertex_normal);
}

// As `shade` of each hit, to the last bit. Formulas are computed in lanes; lights, spectra and tables are looked
// up lane by lane.
template <int W>
void PathIntegrator::shade_diffuse(const SceneView& scene, LaneShading level, HitGroup<W>& group,
                                   PathBatch& batch) const {
    using T = Lanes<W>;
    const int size = group.size;
    group.size = 0;
    for (auto i = static_cast<std::size_t>(size); i < W; ++i) {
        group.states[i] = group.states[0];
        group.hits[i] = group.hits[0];
        group.streams[i] = group.streams[0];
    }

    TrianglePoint<T> s;
    if (level == LaneShading::all) s = triangle_points<W>(scene, group.hits);
    LaneStream<W> stream(group.streams, size);
    DiffuseBsdfOf<T> bsdf;
    SpectrumLanes<W> throughput;
    T roulette_scale;
    Vec3<T> w, tangent;
    LaneMask<W> follows_tangent(false);
    for (int i = 0; i < size; ++i) {
        const auto k = static_cast<std::size_t>(i);
        PathState& state = *group.states[k];
        const Hit& hit = *group.hits[k];
        const Index material = scene.shapes[hit.shape].material;
        const bool textured = scene.is_textured(material);
        TextureContext context;
        if (level != LaneShading::all) {
            follows_tangent.set(i, scene.frame_follows_tangents(material));
            const SurfacePoint point = surface_point(scene, state.ray, hit, textured || follows_tangent[i]);
            set_lane(s.p, i, point.p);
            set_lane(s.ng, i, point.ng);
            set_lane(s.ns, i, point.ns);
            s.error.set(i, point.error);
            set_lane(tangent, i, point.tangent());
            if (textured) context = texture_context(point);
        }
        set_lane(w, i, state.ray.d);
        state.meet(hit);
        if (const Index light = scene.light_at(hit); light != no_index)
            add_met_light(scene, state, light,
                          {.wi = state.ray.d,
                           .part = hit.primitive,
                           .p = lane_of(s.p, i),
                           .n = lane_of(s.ng, i),
                           .b = {hit.b1, hit.b2}},
                          PathRecorder(nullptr));
        state.alive = false;
        if (state.depth++ == settings_.max_depth) {
            stream.active.set(i, false);
            continue;
        }
        const ParameterEvaluator at(scene, material, context, state.lambda);
        const SampledSpectrum reflectance =
            std::get_if<DiffuseMaterial>(&scene.materials[material])->bsdf(at).reflectance;
        bsdf.reflectance.set_lane(i, reflectance);
        throughput.set_lane(i, state.throughput);
        roulette_scale.set(i, state.roulette_scale);
        state.previous = {lane_of(s.p, i), lane_of(s.ng, i), s.error[i], Vec3f{}};
        if (state.depth == 1)
            state.first = {.albedo = reflectance, .normal = lane_of(s.ns, i), .depth = hit.t, .found = true};
    }
    FrameOf<T> frame = FrameOf<T>::from_normal(s.ns);
    if (any(follows_tangent))
        frame = select(follows_tangent, FrameOf<T>::from_normal_and_tangent(s.ns, tangent), frame);
    const Vec3<T> wo = frame.to_local(-w);
    stream.active = stream.active & (wo.z != 0);
    if (!any(stream.active)) return;
    const Vec3<T> facing = select(wo.z > T(0), frame.n, -frame.n);
    for (int i = 0; i < size; ++i)
        if (stream.active[i]) group.states[static_cast<std::size_t>(i)]->previous.facing = lane_of(facing, i);

    // Next-event estimation.
    const LightSampler& lights = *scene.light_sampler;
    if (!lights.empty()) {
        const bool few = lights.size() <= 64;
        Vec2<T> u = stream.next_2d();
        const auto u_light = stream.refined(few ? u.x : stream.next_1d());
        Vec3<T> wi;
        T choice, pdf = 1;
        SpectrumLanes<W> radiance;
        LaneMask<W> lit(false), invisible(false);
        std::array<Ray, W> shadows;
        std::array<Index, W> chosen_lights{};
        for (int i = 0; i < size; ++i) {
            if (!stream.active[i]) continue;
            const auto k = static_cast<std::size_t>(i);
            const PathState& state = *group.states[k];
            const LightChoice chosen = lights.sample(state.previous, u_light[k]);
            Vec2f at{u.x[i], u.y[i]};
            if (few) at.x = std::min(static_cast<float>(chosen.remapped), largest_below_one<float>);
            const auto light = sample_li({scene, chosen.light, state.ray.time}, chosen.part, state.previous,
                                         at, state.lambda);
            if (!light || (!light->invisible && !samples_lights(settings_))) continue;
            lit.set(i, true);
            invisible.set(i, light->invisible);
            set_lane(wi, i, light->wi);
            choice.set(i, chosen.probability);
            pdf.set(i, light->pdf);
            radiance.set_lane(i, light->radiance);
            chosen_lights[k] = chosen.light;
            shadows[k] = light->shadow;
            shadows[k].time = state.ray.time;
        }
        if (any(lit) && settings_.strategy != Strategy::mis_bsdf) {
            const auto e = bsdf.evaluate(wo, frame.to_local(wi), TransportMode::radiance, stream);
            const T light_pdf = choice * pdf;
            lit = lit & !is_black(e.f) & !is_black(radiance);
            const LaneMask<W> alone = invisible | LaneMask<W>(settings_.strategy == Strategy::light);
            const T share = select(alone, T(1), path_weight(settings_, light_pdf, e.pdf));
            const SpectrumLanes<W> contribution = throughput * e.f * radiance * (share / light_pdf);
            for (int i = 0; i < size; ++i) {
                if (!lit[i]) continue;
                const auto k = static_cast<std::size_t>(i);
                batch.shadows.emplace_back(ShadowRay{shadows[k], contribution.lane(i), chosen_lights[k]});
                batch.shadow_owners.push_back(group.paths[k]);
            }
        }
    }

    const auto [scattered, found] = bsdf.sample(wo, TransportMode::radiance, stream);
    stream.active = stream.active & found;
    throughput *= scattered.weight;
    const Vec3<T> wi = frame.to_world(scattered.wi);
    const Vec3<T> origin = offset_origin(s.p, s.ng, s.error, wi);

    // Russian roulette.
    const T strength = max_value(throughput) * roulette_scale;
    LaneMask<W> survives = stream.active & (strength > 0);
    LaneMask<W> plays(false);
    for (int i = 0; i < size; ++i)
        plays.set(i, survives[i] && strength[i] < 1 && group.states[static_cast<std::size_t>(i)]->depth > 1);
    const LaneMask<W> scatters = stream.active;
    if (any(plays)) {
        stream.active = plays;
        const T u = stream.next_1d();
        survives = survives & ((!plays) | (u < strength));
        throughput = select(plays & survives, throughput / strength, throughput);
    }
    stream.store();
    for (int i = 0; i < size; ++i) {
        if (!scatters[i]) continue;
        PathState& state = *group.states[static_cast<std::size_t>(i)];
        state.throughput = throughput.lane(i);
        state.bsdf_pdf = scattered.pdf[i];
        state.sees_lights = false;
        state.scattered_roughly = true;
        state.ray.o = lane_of(origin, i);
        state.ray.d = lane_of(wi, i);
        state.ray.t_max = std::numeric_limits<float>::infinity();
        state.alive = survives[i];
        if (!(strength[i] > 0)) state.radiance += state.throughput; // as Vertex::survives
    }
}

} // namespace montelux
