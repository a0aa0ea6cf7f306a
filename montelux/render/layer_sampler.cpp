#include "montelux/render/layer_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "montelux/image/cryptomatte.h"
#include "montelux/scene/scene_names.h"

namespace montelux {

LayerSampler::LayerSampler(const SceneDescription& description, const SceneView& scene, const Camera& camera)
    : scene_(scene), camera_(camera), in_camera_space_(description.film.layers.in_camera_space) {
    const LayerSettings& settings = description.film.layers;
    if (settings.set.has(Layer::light_groups))
        groups_ = light_groups(description.scene, settings.light_grouping);
    layers_ = FilmLayers(settings.set, groups_.names);
    std::size_t part = 0;
    if (settings.set.has(Layer::direct)) split_.direct = part++;
    if (settings.set.has(Layer::indirect)) split_.indirect = part++;
    if (!groups_.names.empty()) split_.first_group = part;
    split_.group_of_light = groups_.of_light;
    split_.group_of_media = groups_.of_media;
    const Scene& s = description.scene;
    if (settings.set.has(Layer::shape)) {
        for (std::size_t i = 0; i < s.shapes.size(); ++i)
            shape_ids_.push_back(cryptomatte_id(shape_name(s, static_cast<Index>(i))));
        for (const std::string& name : instance_names(s)) instance_ids_.push_back(cryptomatte_id(name));
    }
    if (settings.set.has(Layer::material))
        for (std::size_t i = 0; i < s.materials.size(); ++i)
            material_ids_.push_back(cryptomatte_id(material_name(s, static_cast<Index>(i))));
}

void LayerSampler::sample(const SampleExtras& extras, Point2f film, Vec2f lens, float filter_weight,
                          std::span<float> values) const {
    std::ranges::fill(values, 0.0f);
    const LayerSet set = layers_.set();
    values[FilmLayers::weight] = filter_weight;
    if (set.has(Layer::alpha))
        values[layers_.feature(Layer::alpha)] = (1 - extras.transparency) * filter_weight;
    const Hit& hit = extras.hit;
    if (hit.shape == no_index) return;
    values[FilmLayers::seen] = 1;
    if (!shape_ids_.empty())
        values[FilmLayers::shape_id] = std::bit_cast<float>(
            hit.instance == no_index ? shape_ids_[hit.shape] : instance_ids_[hit.instance]);
    if (!material_ids_.empty())
        values[FilmLayers::material_id] =
            std::bit_cast<float>(material_ids_[scene_.shapes[hit.shape].material]);

    const auto put = [&](Layer layer, std::initializer_list<double> numbers) {
        float* to = &values[layers_.feature(layer)];
        for (const double x : numbers) *to++ = static_cast<float>(x);
    };
    const SurfacePoint s = surface_point(scene_, extras.ray, hit, set.has(Layer::uv));
    if (set.has(Layer::uv)) put(Layer::uv, {double(s.uv.x), double(s.uv.y)});
    if (set.has(Layer::position)) {
        Vec3d p(s.p);
        if (in_camera_space_) p = camera_.camera_from_world(extras.ray.time).point(p);
        put(Layer::position, {p.x, p.y, p.z});
    }
    if (set.has(Layer::geometric_normal)) {
        Vec3d n(s.ng);
        if (in_camera_space_) n = normalize(camera_.camera_from_world(extras.ray.time).normal(n));
        put(Layer::geometric_normal, {n.x, n.y, n.z});
    }
    if (set.has(Layer::depth_slopes)) {
        const Vec2d slopes = depth_slopes(s, film, lens, extras.ray.time);
        put(Layer::depth_slopes, {slopes.x, slopes.y});
    }
    if (set.has(Layer::motion)) {
        const Vec2d step = motion(extras, Vec3d(s.p));
        put(Layer::motion, {step.x, step.y});
    }
}

// From the camera rays half a pixel to either side, intersected with the tangent plane; 0 where it is seen edge-on.
Vec2d LayerSampler::depth_slopes(const SurfacePoint& s, Point2f film, Vec2f lens, float time) const {
    const Transform camera_from_world = camera_.camera_from_world(time);
    const auto depth = [&](float x, float y) {
        const CameraRay ray = camera_.generate_ray({film.x + x, film.y + y}, lens, time);
        const Vec3d o(ray.o), d(ray.d), n(s.ng);
        const Vec3d p = o + d * (dot(Vec3d(s.p) - o, n) / dot(d, n));
        return camera_from_world.point(p).z;
    };
    const Vec2d slopes{depth(0.5f, 0) - depth(-0.5f, 0), depth(0, 0.5f) - depth(0, -0.5f)};
    return {std::isfinite(slopes.x) ? slopes.x : 0, std::isfinite(slopes.y) ? slopes.y : 0};
}

// Of the surface point that is at p at the time of the sample, while the shutter is open; 0 where it passes behind
// the camera.
Vec2d LayerSampler::motion(const SampleExtras& extras, Vec3d p) const {
    const Index moving =
        extras.hit.instance == no_index ? no_index : scene_.instances[extras.hit.instance].motion;
    const TriangleMesh* mesh = mesh_of(scene_, scene_.shapes[extras.hit.shape]);
    const bool deforms = mesh != nullptr && mesh->deforms();
    const auto on_film = [&](float time) {
        Vec3d q = p;
        if (deforms) { // its points are given by the triangle alone
            Ray ray = extras.ray;
            ray.time = time;
            q = Vec3d(surface_point(scene_, ray, extras.hit, false).p);
        } else if (moving != no_index) {
            const Motion& motion = scene_.motions[moving];
            q = motion.at(time).point(motion.at(extras.ray.time).inverse_point(p));
        }
        return camera_.project(camera_.camera_from_world(time).point(q));
    };
    const auto from = on_film(camera_.time_at(0)), to = on_film(camera_.time_at(1));
    return from && to ? camera_.film_step(*from, *to) : Vec2d{};
}

std::map<std::uint32_t, std::string> shape_id_names(const Scene& scene) {
    std::map<std::uint32_t, std::string> names;
    for (const Index shape : scene.world_shapes) {
        std::string name = shape_name(scene, shape);
        names.emplace(cryptomatte_id(name), std::move(name));
    }
    for (std::string& name : instance_names(scene)) names.emplace(cryptomatte_id(name), std::move(name));
    return names;
}

std::map<std::uint32_t, std::string> material_id_names(const Scene& scene) {
    std::map<std::uint32_t, std::string> names;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        std::string name = material_name(scene, static_cast<Index>(i));
        names.emplace(cryptomatte_id(name), std::move(name));
    }
    return names;
}

} // namespace montelux
