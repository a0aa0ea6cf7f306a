#include "montelux/accel/accelerator.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "montelux/accel/alpha.h"
#include "montelux/accel/embree.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

namespace {

// User data of Embree's callbacks for one geometry.
struct GeometryData {
    const SceneView* scene = nullptr;
    Index shape = no_index;
    const Quadric* quadric = nullptr;  // null for meshes
    std::optional<WorldSphere> sphere; // if the quadric is one
    bool cut_out = false;
};

std::optional<double> hit_quadric(const GeometryData& data, const Ray& ray, double t_min) {
    if (data.sphere) return intersect(*data.sphere, ray, t_min);
    return intersect(*data.quadric, ray, t_min);
}

void fill_bounds(const RTCBoundsFunctionArguments* args) {
    const auto* data = static_cast<const GeometryData*>(args->geometryUserPtr);
    Bounds3 b = world_bounds(*data->quadric);
    RTCBounds& out = *args->bounds_o;
    auto below = [](double v) { return std::nextafter(static_cast<float>(v), -1e38f); };
    auto above = [](double v) { return std::nextafter(static_cast<float>(v), 1e38f); };
    out.lower_x = below(b.lower.x);
    out.lower_y = below(b.lower.y);
    out.lower_z = below(b.lower.z);
    out.upper_x = above(b.upper.x);
    out.upper_y = above(b.upper.y);
    out.upper_z = above(b.upper.z);
}

Ray ray_of(const RTCRay& r) { return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar}; }

bool passes_cut_out(const GeometryData& data, const Ray& ray, const Hit& hit) {
    return !data.cut_out || is_opaque(*data.scene, ray, hit);
}

RTCRay embree_ray(const Ray& ray) {
    return {.org_x = ray.o.x,
            .org_y = ray.o.y,
            .org_z = ray.o.z,
            .tnear = 0,
            .dir_x = ray.d.x,
            .dir_y = ray.d.y,
            .dir_z = ray.d.z,
            .time = 0,
            .tfar = ray.t_max,
            .mask = ~0u,
            .id = 0,
            .flags = 0};
}

// Quadrics: Embree passes one ray at a time (N = 1), since only rtcIntersect1 and rtcOccluded1 are used.
void intersect_quadric(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* data = static_cast<const GeometryData*>(args->geometryUserPtr);
    auto* ray_hit = reinterpret_cast<RTCRayHit*>(args->rayhit);
    Ray ray = ray_of(ray_hit->ray);
    double t_min = double(ray_hit->ray.tnear);
    for (;;) {
        auto t = hit_quadric(*data, ray, t_min);
        if (!t) return;
        Hit hit{.t = static_cast<float>(*t), .shape = data->shape};
        if (passes_cut_out(*data, ray, hit)) {
            ray_hit->ray.tfar = hit.t;
            ray_hit->hit.u = ray_hit->hit.v = 0;
            ray_hit->hit.geomID = args->geomID;
            ray_hit->hit.primID = 0;
            ray_hit->hit.instID[0] = args->context->instID[0];
            return;
        }
        t_min = *t;
    }
}

void occlude_quadric(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* data = static_cast<const GeometryData*>(args->geometryUserPtr);
    auto* r = reinterpret_cast<RTCRay*>(args->ray);
    Ray ray = ray_of(*r);
    double t_min = double(r->tnear);
    while (auto t = hit_quadric(*data, ray, t_min)) {
        if (passes_cut_out(*data, ray, {.t = static_cast<float>(*t), .shape = data->shape})) {
            r->tfar = -std::numeric_limits<float>::infinity();
            return;
        }
        t_min = *t;
    }
}

// Alpha cut-outs of meshes: rejects hits on holes.
void filter_triangle(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* data = static_cast<const GeometryData*>(args->geometryUserPtr);
    const auto* r = reinterpret_cast<const RTCRay*>(args->ray);
    const auto* h = reinterpret_cast<const RTCHit*>(args->hit);
    Hit hit{.t = r->tfar, .b1 = h->u, .b2 = h->v, .shape = data->shape, .primitive = h->primID};
    if (!is_opaque(*data->scene, ray_of(*r), hit)) args->valid[0] = 0;
}

} // namespace

struct Accelerator::Impl {
    RTCDevice device = nullptr;
    RTCScene world = nullptr;
    std::vector<RTCScene> objects;
    std::vector<GeometryData> data; // one per shape
    SceneView scene;
    Bounds3 bounds;
    std::string error;

    ~Impl() {
        if (world != nullptr) rtcReleaseScene(world);
        for (RTCScene s : objects) rtcReleaseScene(s);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    RTCScene new_scene() const {
        RTCScene s = rtcNewScene(device);
        // Robust: no ray passes between triangles that share an edge.
        rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
        return s;
    }

    RTCGeometry mesh_geometry(const TriangleMesh& mesh, bool cut_out) const {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree reads 16 bytes per vertex: a buffer of its own pads the last one.
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                     RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                     mesh.positions.size()));
        if (vertices != nullptr)
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                vertices[3 * i] = mesh.positions[i].x;
                vertices[3 * i + 1] = mesh.positions[i].y;
                vertices[3 * i + 2] = mesh.positions[i].z;
            }
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(),
                                   0, 3 * sizeof(Index), mesh.triangle_count());
        if (cut_out) {
            rtcSetGeometryIntersectFilterFunction(geometry, filter_triangle);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_triangle);
        }
        return geometry;
    }

    RTCGeometry quadric_geometry() const {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcSetGeometryBoundsFunction(geometry, fill_bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry, intersect_quadric);
        rtcSetGeometryOccludedFunction(geometry, occlude_quadric);
        return geometry;
    }

    void attach_shape(RTCScene to, unsigned id, Index shape_index) {
        const Shape& shape = scene.shapes[shape_index];
        const bool cut_out = data[shape_index].cut_out;
        RTCGeometry geometry =
            visit_geometry(scene, shape,
                           Overloaded{[&](const TriangleMesh& mesh) { return mesh_geometry(mesh, cut_out); },
                                      [&](const Quadric&) { return quadric_geometry(); }});
        rtcSetGeometryUserData(geometry, &data[shape_index]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(to, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    void attach_instance(unsigned id, const Instance& instance) const {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, objects[instance.object]);
        rtcSetGeometryTimeStepCount(geometry, 1);
        float m[12];
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                m[3 * column + row] = static_cast<float>(instance.world_from_object.matrix().m[row][column]);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(world, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    void check() const {
        if (!error.empty()) throw Error("Embree", error);
    }
};

Accelerator::Accelerator(const SceneView& scene) : impl_(std::make_unique<Impl>()) {
    Impl& a = *impl_;
    a.scene = scene;
    a.device = rtcNewDevice(nullptr);
    if (a.device == nullptr) throw Error("Embree", "no device could be made");
    rtcSetDeviceErrorFunction(
        a.device,
        [](void* user, RTCError, const char* text) {
            auto& message = *static_cast<std::string*>(user);
            if (message.empty()) message = text != nullptr ? text : "unknown error";
        },
        &a.error);
    a.data.resize(scene.shapes.size());
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        a.data[i].scene = &a.scene;
        a.data[i].shape = static_cast<Index>(i);
        a.data[i].cut_out = is_cut_out(shape);
        a.data[i].quadric = quadric_of(scene, shape);
        if (a.data[i].quadric != nullptr) a.data[i].sphere = whole_sphere(*a.data[i].quadric);
    }

    for (const ObjectDefinition& object : scene.objects) {
        RTCScene s = a.objects.emplace_back(a.new_scene());
        for (std::size_t i = 0; i < object.shapes.size(); ++i)
            a.attach_shape(s, static_cast<unsigned>(i), object.shapes[i]);
        rtcCommitScene(s);
        a.check();
    }
    a.world = a.new_scene();
    unsigned id = 0;
    for (Index shape : scene.world_shapes) a.attach_shape(a.world, id++, shape);
    for (const Instance& instance : scene.instances) a.attach_instance(id++, instance);
    rtcCommitScene(a.world);
    a.check();

    if (id > 0) {
        RTCBounds b{};
        rtcGetSceneBounds(a.world, &b);
        if (b.lower_x <= b.upper_x) {
            a.bounds.add({double(b.lower_x), double(b.lower_y), double(b.lower_z)});
            a.bounds.add({double(b.upper_x), double(b.upper_y), double(b.upper_z)});
        }
    }
}

Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

const Bounds3& Accelerator::bounds() const { return impl_->bounds; }

bool Accelerator::intersect(const Ray& ray, Hit& hit) const {
    RTCRayHit r;
    r.ray = embree_ray(ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    closest_hit(impl_->world, r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.t = r.ray.tfar;
    hit.b1 = r.hit.u;
    hit.b2 = r.hit.v;
    hit.primitive = r.hit.primID;
    const SceneView& scene = impl_->scene;
    if (r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
        hit.instance = no_index;
        hit.shape = scene.world_shapes[r.hit.geomID];
    } else {
        hit.instance = r.hit.instID[0] - static_cast<Index>(scene.world_shapes.size());
        hit.shape = scene.objects[scene.instances[hit.instance].object].shapes[r.hit.geomID];
    }
    return true;
}

bool Accelerator::occluded(const Ray& ray) const {
    RTCRay r = embree_ray(ray);
    any_hit(impl_->world, r);
    return r.tfar < 0;
}

} // namespace montelux
