#include "montelux/accel/embree_scene.h"

#include <algorithm>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/shape/alpha.h"

namespace montelux {

static_assert(sizeof(Point3f) == 3 * sizeof(float)); // read in place

namespace {

void set_vertices(RTCGeometry geometry, unsigned time_step, const std::vector<Point3f>& positions) {
    const std::size_t count = positions.size();
    // Embree reads 16 bytes per vertex, so four beyond the last one: they must be allocated.
    if (count > 0 && positions.capacity() > count) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, time_step, RTC_FORMAT_FLOAT3,
                                   positions.data(), 0, sizeof(Point3f), count);
    } else if (auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
                   geometry, RTC_BUFFER_TYPE_VERTEX, time_step, RTC_FORMAT_FLOAT3, 3 * sizeof(float), count));
               vertices != nullptr) {
        for (std::size_t i = 0; i < count; ++i) {
            vertices[3 * i] = positions[i].x;
            vertices[3 * i + 1] = positions[i].y;
            vertices[3 * i + 2] = positions[i].z;
        }
    }
}

} // namespace

EmbreeScene::EmbreeScene(const SceneView& scene, bool robust)
    : scene_(scene), robust_(robust),
      moves_(!scene.motions.empty() || std::ranges::any_of(scene.meshes, &TriangleMesh::deforms)) {
    try {
        build();
    } catch (...) {
        release();
        throw;
    }
}

EmbreeScene::~EmbreeScene() { release(); }

void EmbreeScene::release() {
    if (world_ != nullptr) rtcReleaseScene(world_);
    for (RTCScene s : objects_) rtcReleaseScene(s);
    if (device_ != nullptr) rtcReleaseDevice(device_);
}

void EmbreeScene::check() const {
    if (!error_.empty()) throw Error("Embree", error_);
}

void EmbreeScene::build() {
    device_ = rtcNewDevice(nullptr);
    if (device_ == nullptr) throw Error("Embree", "no device could be made");
    rtcSetDeviceErrorFunction(
        device_,
        [](void* user, RTCError, const char* text) {
            auto& message = *static_cast<std::string*>(user);
            if (message.empty()) message = text != nullptr ? text : "unknown error";
        },
        &error_);
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* user, ssize_t bytes, bool) {
            *static_cast<std::atomic<std::int64_t>*>(user) += bytes;
            return true;
        },
        &embree_bytes_);
    data_.resize(scene_.shapes.size());
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
        const Shape& shape = scene_.shapes[i];
        data_[i].scene = &scene_;
        data_[i].shape = static_cast<Index>(i);
        data_[i].cut_out = is_cut_out(shape);
        data_[i].quadric = quadric_of(scene_, shape);
        data_[i].curves = curves_of(scene_, shape);
        data_[i].patches = bilinear_mesh_of(scene_, shape);
        if (data_[i].curves != nullptr) data_[i].pieces = curve_pieces(*data_[i].curves);
        if (data_[i].quadric != nullptr) data_[i].sphere = whole_sphere(*data_[i].quadric);
    }

    for (const ObjectDefinition& object : scene_.objects) {
        RTCScene s = objects_.emplace_back(new_scene());
        for (std::size_t i = 0; i < object.shapes.size(); ++i)
            attach_shape(s, static_cast<unsigned>(i), object.shapes[i]);
        rtcCommitScene(s);
        check();
    }
    world_ = new_scene();
    unsigned id = 0;
    for (Index shape : scene_.world_shapes) attach_shape(world_, id++, shape);
    for (const Instance& instance : scene_.instances) attach_instance(id++, instance);
    rtcCommitScene(world_);
    check();

    if (id > 0) {
        RTCBounds b{};
        rtcGetSceneBounds(world_, &b);
        if (b.lower_x <= b.upper_x) {
            bounds_.add({double(b.lower_x), double(b.lower_y), double(b.lower_z)});
            bounds_.add({double(b.upper_x), double(b.upper_y), double(b.upper_z)});
        }
    }
}

RTCScene EmbreeScene::new_scene() const {
    RTCScene s = rtcNewScene(device_);
    rtcSetSceneFlags(s, robust_ ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
    return s;
}

RTCGeometry EmbreeScene::mesh_geometry(const TriangleMesh& mesh, bool cut_out) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, mesh.deforms() ? 2 : 1);
    set_vertices(geometry, 0, mesh.positions);
    if (mesh.deforms()) set_vertices(geometry, 1, mesh.end_positions);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(Index), mesh.triangle_count());
    if (cut_out) {
        rtcSetGeometryIntersectFilterFunction(geometry, filter_triangle);
        rtcSetGeometryOccludedFilterFunction(geometry, filter_triangle);
    }
    return geometry;
}

RTCGeometry EmbreeScene::user_geometry(std::size_t primitives) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryBoundsFunction(geometry, fill_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_primitive);
    rtcSetGeometryOccludedFunction(geometry, occlude_primitive);
    return geometry;
}

void EmbreeScene::attach_shape(RTCScene to, unsigned id, Index shape_index) {
    const Shape& shape = scene_.shapes[shape_index];
    const bool cut_out = data_[shape_index].cut_out;
    RTCGeometry geometry = visit_geometry(
        scene_, shape,
        Overloaded{[&](const TriangleMesh& mesh) { return mesh_geometry(mesh, cut_out); },
                   [&](const Quadric&) { return user_geometry(1); },
                   [&](const Curves& curves) {
                       return user_geometry(curves.segment_count() << data_[shape_index].pieces.levels);
                   },
                   [&](const BilinearMesh& mesh) { return user_geometry(mesh.patch_count()); }});
    rtcSetGeometryUserData(geometry, &data_[shape_index]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, id);
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::attach_instance(unsigned id, const Instance& instance) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, objects_[instance.object]);
    const bool moves = instance.motion != no_index;
    const auto keys =
        moves ? scene_.motions[instance.motion].keys() : std::span(&instance.world_from_object.matrix(), 1);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(keys.size()));
    for (std::size_t key = 0; key < keys.size(); ++key) {
        float m[12];
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                m[3 * column + row] = static_cast<float>(keys[key].m[row][column]);
        rtcSetGeometryTransform(geometry, static_cast<unsigned>(key), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(world_, geometry, id);
    rtcReleaseGeometry(geometry);
}

} // namespace montelux
