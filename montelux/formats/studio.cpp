#include "montelux/formats/studio.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/image/image_read.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/light_tables.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

// Share of the film's half width and height that the scene covers at most.
constexpr double framing_fill = 0.84;

// The ground reaches so far, in radii of the scene: to the horizon, as seen from a bit above.
constexpr double ground_reach = 100;
constexpr float ground_albedo = 0.7f;
// Radiance of the ground: light grey, with room for highlights below white.
constexpr double ground_radiance = 0.72;

double radians(double degrees) { return degrees * pi / 180; }

// An upright cylinder around a box.
struct UprightCylinder {
    Vec3d center;
    double radius = 0, half_height = 0;

    UprightCylinder(const Bounds3& bounds, const OrbitFrame& frame) : center(bounds.center()) {
        const Vec3d half = 0.5 * (bounds.upper - bounds.lower);
        const auto extent = [&](Vec3d axis) {
            return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
        };
        half_height = extent(frame.up);
        radius = std::hypot(extent(frame.right), extent(frame.front));
        if (!(radius > 0 || half_height > 0)) radius = half_height = 0.5;
        radius = std::max(radius, 0.02 * half_height); // a line is seen from a distance along its axis, too
    }
    double size() const { return std::hypot(radius, half_height); }
};

struct Framing {
    double distance = 0; // from the centre, along the axis of the camera
    double rise = 0;     // of the camera, along its y axis
};

// The nearest camera from which all points of the cylinder lie within the picture: for a point (x, y, z) relative to
// the centre, in camera space, |x| <= t (z + distance), and likewise for y - rise. On a circle z varies with x; corners
// of a polygon around it are safe.
Framing framing(const UprightCylinder& cylinder, double elevation, double fov, double aspect) {
    const double shorter = framing_fill * std::tan(0.5 * radians(fov));
    const double tx = shorter * std::max(1.0, aspect), ty = shorter * std::max(1.0, 1 / aspect);
    const double s = std::sin(radians(elevation)), c = std::cos(radians(elevation));
    constexpr int sides = 64;
    const double r = cylinder.radius / std::cos(pi / sides);
    double nearest = 0, above = -1e300, below = -1e300;
    for (int i = 0; i < sides; ++i)
        for (const double h : {-cylinder.half_height, cylinder.half_height}) {
            const double a = 2 * pi * i / sides, away = r * std::cos(a);
            const double x = r * std::sin(a), y = c * h + s * away, z = c * away - s * h;
            nearest = std::max(nearest, std::abs(x) / tx - z);
            above = std::max(above, y - ty * z);
            below = std::max(below, -y - ty * z);
        }
    return {std::max(nearest, (above + below) / (2 * ty)), 0.5 * (above - below)};
}

// Camera space to world: the camera at `eye`, its axes as columns.
Transform camera_at(Vec3d eye, Vec3d right, Vec3d up, Vec3d forward) {
    Matrix4 m;
    for (int row = 0; row < 3; ++row) {
        const auto i = static_cast<std::size_t>(row);
        m.m[i] = {right[row], up[row], forward[row], eye[row]};
    }
    const std::optional<Transform> t = Transform::from_matrix(m);
    if (!t) throw Error("studio", "the scene is too far away, or too large, to be framed");
    return *t;
}

// A map's axes: its upper pole is up, and its middle column is what a camera in front of the scene sees behind it.
Transform world_from_map(const OrbitFrame& frame) {
    return camera_at({}, frame.front, -frame.right, frame.up);
}

// 1 within the angle `inner` of an axis, 0 beyond `outer` (cosines), smooth between.
double soft_disc(double cosine, double inner, double outer) {
    const double t = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Unit vector in the space of a map: azimuth and elevation as in an Orbit.
Vec3d towards(double azimuth, double elevation) {
    const double a = radians(azimuth), e = radians(elevation);
    return {std::cos(e) * std::cos(a), -std::cos(e) * std::sin(a), std::sin(e)};
}

// The light of the studio: a soft sky, a large key light on the left of the default camera, and a smaller one behind
// the scene, which lines its edge. Scaled for ground_radiance.
Image studio_light() {
    constexpr int height = 128;
    const EnvironmentGrid grid(EnvironmentLayout::equirectangular, 2 * height, height);
    struct Softbox {
        Vec3d axis;
        double inner, outer, radiance;
    };
    const Orbit camera;
    const auto softbox = [&](double azimuth, double elevation, double angle, double radiance) {
        return Softbox{towards(camera.azimuth + azimuth, elevation), std::cos(radians(angle)),
                       std::cos(radians(angle + 6)), radiance};
    };
    const Softbox boxes[] = {softbox(-62, 46, 13, 32), softbox(140, 32, 9, 18)};
    Image map(2 * height, height, {"R", "G", "B"});
    double irradiance = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d w(grid.direction(Vec2f{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
            double radiance = 0.3 + 0.25 * std::max(w.z, 0.0);
            for (const Softbox& box : boxes)
                radiance += box.radiance * soft_disc(dot(w, box.axis), box.inner, box.outer);
            irradiance += radiance * std::max(w.z, 0.0) * grid.solid_angle(y);
            for (int c = 0; c < 3; ++c)
                map.f32()[3 * (2 * static_cast<std::size_t>(height) * y + x) + c] =
                    static_cast<float>(radiance);
        }
    const double scale = ground_radiance * pi / (double(ground_albedo) * irradiance);
    for (float& v : map.f32()) v *= static_cast<float>(scale);
    return map;
}

void remove_infinite_lights(Scene& scene) {
    std::vector<Index> number(scene.lights.size(), no_index);
    std::vector<Light> kept;
    std::vector<std::string> groups;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (kind_of(scene.lights[i]) == LightKind::infinite) continue;
        number[i] = static_cast<Index>(kept.size());
        kept.push_back(scene.lights[i]);
        groups.push_back(i < scene.light_groups.size() ? scene.light_groups[i] : std::string());
    }
    if (kept.size() == scene.lights.size()) return;
    scene.lights = std::move(kept);
    scene.light_groups = std::move(groups);
    for (Shape& shape : scene.shapes)
        if (shape.light != no_index) shape.light = number[shape.light];
}

void add_map(SceneBuilder& builder, const Image& map, const std::string& name, const OrbitFrame& frame) {
    ImageInfiniteLight light;
    light.environment = builder.add_environment(map, name);
    light.layout = *layout_of_size(map.width(), map.height());
    light.scale = photometric_scale(Spectrum(RgbColorSpace::srgb().illuminant()));
    light.world_from_light = world_from_map(frame);
    builder.add_light(light);
}

void add_ground(SceneBuilder& builder, const Bounds3& bounds, const OrbitFrame& frame) {
    const UprightCylinder cylinder(bounds, frame);
    Disk disk;
    disk.radius = static_cast<float>(ground_reach * cylinder.size());
    // A bit below what lies on it, so that faces in its plane are seen.
    const Vec3d place = cylinder.center - (cylinder.half_height + 1e-4 * cylinder.size()) * frame.up;
    disk.world_from_object = camera_at(place, frame.right, cross(frame.up, frame.right), frame.up);
    Scene& scene = builder.scene();
    scene.materials.push_back(DiffuseMaterial{.reflectance = {ground_albedo}});
    ShapeSettings settings;
    settings.material = static_cast<Index>(scene.materials.size() - 1);
    settings.name = "ground";
    builder.add_shape(disk, settings);
}

// The axis of the world that is nearest to a camera's y axis, for scenes whose format has no up.
Vec3d up_axis_of(const CameraSettings& camera) {
    const Vec3d y = camera.world_from_camera.vector(Vec3d(0, 1, 0));
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(y[i]) > std::abs(y[axis])) axis = i;
    Vec3d up;
    up[axis] = y[axis] < 0 ? -1 : 1;
    return up;
}

OrbitFrame orbit_frame_of(const SceneDescription& d) {
    if (d.up) return OrbitFrame::of(Vec3d(*d.up));
    if (!d.has_camera) return OrbitFrame::of({0, 1, 0});
    return OrbitFrame::of(up_axis_of(d.scene.camera), !d.scene.camera.world_from_camera.swaps_handedness());
}

} // namespace

OrbitFrame OrbitFrame::of(Vec3d up, bool mirrored) {
    const Vec3d front = std::abs(up.z) > 0.5 ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
    const Vec3d right = cross(up, front);
    return {mirrored ? -right : right, up, front};
}

double framing_distance(const Bounds3& bounds, const OrbitFrame& frame, double elevation, double fov,
                        double aspect) {
    return framing(UprightCylinder(bounds, frame), elevation, fov, aspect).distance;
}

CameraSettings framing_camera(const Bounds3& bounds, const OrbitFrame& frame, const Orbit& orbit, double fov,
                              double aspect) {
    const UprightCylinder cylinder(bounds, frame);
    const Framing fit = framing(cylinder, orbit.elevation, fov, aspect);
    const double a = radians(orbit.azimuth), e = radians(orbit.elevation);
    const Vec3d outwards = std::sin(a) * frame.right + std::cos(a) * frame.front;
    const Vec3d right = std::cos(a) * frame.right - std::sin(a) * frame.front;
    const Vec3d back = std::cos(e) * outwards + std::sin(e) * frame.up;
    const Vec3d up = std::cos(e) * frame.up - std::sin(e) * outwards;
    const Vec3d eye = cylinder.center + orbit.distance * fit.distance * back + fit.rise * up;
    CameraSettings camera;
    PerspectiveCamera model;
    model.fov = static_cast<float>(fov);
    camera.model = model;
    camera.world_from_camera = camera_at(eye, right, up, -back);
    return camera;
}

TurnAxis turn_axis_of(const SceneDescription& d) {
    const Bounds3 bounds = bounds_of(d.scene);
    if (bounds.empty()) throw Error("turntable", "the scene has no shape to turn around");
    const OrbitFrame frame = orbit_frame_of(d);
    return {bounds.center(), cross(frame.front, frame.right)};
}

CameraSettings turned_camera(const CameraSettings& camera, const TurnAxis& axis, double degrees) {
    CameraSettings turned = camera;
    const Transform turn = Transform::translate(axis.point) * Transform::rotate(degrees, axis.direction) *
                           Transform::translate(-axis.point);
    turned.world_from_camera = turn * camera.world_from_camera;
    if (camera.motion) turned.motion.emplace(turn * camera.motion->start(), turn * camera.motion->end());
    return turned;
}

StudioParts add_studio(SceneDescription& d, const StudioSettings& settings, FileSource& files,
                       Warnings& warnings, std::vector<std::filesystem::path>* files_read) {
    StudioParts added;
    if (settings.empty() && !d.wants_studio) return added;
    std::vector<std::string> sentences;
    CallMessages messages("studio", &sentences);
    SceneBuilder builder(d.scene, messages);
    const bool unlit = d.wants_studio && !d.has_lights;
    added.camera = d.wants_studio && !d.has_camera;
    added.lights = unlit && !settings.environment;
    const bool studio_lit = added.lights || settings.environment == "studio";
    const OrbitFrame frame = orbit_frame_of(d);
    const Bounds3 bounds = settings.bounds ? *settings.bounds : bounds_of(d.scene);
    const bool ground = settings.ground.value_or(unlit && added.camera);
    if (bounds.empty() && (ground || added.camera || settings.orbit))
        throw Error("studio", "the scene has no shape to put the camera or the ground at");

    if (settings.environment) remove_infinite_lights(d.scene);
    if (studio_lit) {
        add_map(builder, studio_light(), "the studio's light", frame);
    } else if (settings.environment && *settings.environment != "none") {
        const std::filesystem::path path = *settings.environment;
        if (files_read != nullptr) files_read->push_back(path);
        add_map(builder, read_image(read_unpacked(files, path), path.string()), path.string(), frame);
    }
    if (added.camera || settings.orbit) {
        const double aspect = static_cast<double>(d.film.width) / d.film.height;
        CameraSettings camera =
            framing_camera(bounds, frame, settings.orbit.value_or(Orbit{}), studio_fov, aspect);
        camera.shutter_open = d.scene.camera.shutter_open;
        camera.shutter_close = d.scene.camera.shutter_close;
        camera.medium = d.scene.camera.medium;
        d.scene.camera = std::move(camera);
        d.has_camera = true;
    }
    if (ground) add_ground(builder, bounds, frame);
    if (settings.background) {
        d.integrator.background = settings.background->color;
        if (settings.background->transparent) d.film.layers.set.add(Layer::alpha);
    } else if (studio_lit) {
        // The ground's own shade, so that no horizon shows.
        const auto shade = static_cast<float>(ground_radiance);
        d.integrator.background = Vec3f{shade, shade, shade};
    }
    for (const std::string& sentence : sentences) warnings.add("", sentence);
    return added;
}

} // namespace montelux
