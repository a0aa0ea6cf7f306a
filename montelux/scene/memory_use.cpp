#include "montelux/scene/memory_use.h"

#include "montelux/image/texel_file.h"
#include "montelux/mc/math/vector_bytes.h"
#include "montelux/scene/scene.h"

namespace montelux {
namespace {

// The sum of value(element).
template <typename Elements, typename Value>
std::size_t sum(const Elements& elements, const Value& value) {
    std::size_t total = 0;
    for (const auto& e : elements) total += value(e);
    return total;
}

std::size_t image_bytes(const Image& image) { return image.memory_bytes(); }

// A spectrum that several share is counted for each of them.
std::size_t shared_bytes(const Spectrum& spectrum) {
    if (const auto* table = std::get_if<TabulatedSpectrum>(&spectrum.kind())) return sizeof(table->data());
    if (const auto* lines = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind()))
        return sizeof(lines->data()) + lines->data().knots().size_bytes();
    return 0;
}

} // namespace

std::vector<MemoryUse> memory_use(const Scene& s) {
    std::vector<MemoryUse> table;
    const auto add = [&](std::string_view kind, std::size_t bytes, std::size_t count, std::string_view unit) {
        if (count > 0) table.push_back({kind, bytes, count, unit});
    };
    add("triangle meshes",
        vector_bytes(s.meshes) + sum(s.meshes,
                                     [](const TriangleMesh& m) {
                                         return vector_bytes(m.positions, m.normals, m.uvs, m.indices,
                                                             m.tangents, m.end_positions, m.end_normals,
                                                             m.colors, m.opacities, m.second_uvs);
                                     }),
        sum(s.meshes, [](const TriangleMesh& m) { return m.triangle_count(); }), "triangles");
    add("bilinear meshes",
        vector_bytes(s.bilinear_meshes) +
            sum(s.bilinear_meshes,
                [](const BilinearMesh& m) { return vector_bytes(m.positions, m.normals, m.uvs, m.indices); }),
        sum(s.bilinear_meshes, [](const BilinearMesh& m) { return m.patch_count(); }), "patches");
    add("curves",
        vector_bytes(s.curves) +
            sum(s.curves,
                [](const Curves& c) { return vector_bytes(c.control_points, c.widths, c.normals); }),
        sum(s.curves, [](const Curves& c) { return c.segment_count(); }), "segments");
    add("shapes", vector_bytes(s.shapes, s.world_shapes, s.quadrics), s.shapes.size(), "shapes");
    add("objects",
        vector_bytes(s.objects) +
            sum(s.objects, [](const ObjectDefinition& o) { return vector_bytes(o.shapes); }),
        s.objects.size(), "objects");
    add("instances", vector_bytes(s.instances), s.instances.size(), "instances");
    add("motions",
        vector_bytes(s.motions) + sum(s.motions, [](const Motion& m) { return m.keys().size_bytes(); }),
        s.motions.size(), "motions");
    add("materials, textures",
        vector_bytes(s.materials, s.float_textures, s.spectrum_textures, s.normal_maps), s.materials.size(),
        "materials");
    add("measured BRDFs", sum(s.measured_brdfs, [](const MeasuredBrdf& m) { return sizeof(m) + m.bytes(); }),
        s.measured_brdfs.size(), "BRDFs");
    add("spectra", vector_bytes(s.spectra) + sum(s.spectra, shared_bytes), s.spectra.size(), "spectra");
    const std::size_t mapped = sum(s.images, [](const Image& image) { return image.file() ? 1 : 0; });
    add("images", sum(s.images, image_bytes), s.images.size() - mapped, "images");
    if (mapped > 0)
        table.push_back(
            {"mapped textures", s.texel_file->resident(), mapped, "images", s.texel_file->bytes()});
    add("pictures of lights", sum(s.environments, image_bytes), s.environments.size(), "images");
    add("skies", sum(s.skies, [](const SkyModel& sky) { return sizeof(sky) + sky.bytes(); }), s.skies.size(),
        "skies");
    add("lights", vector_bytes(s.lights), s.lights.size(), "lights");
    add("media",
        vector_bytes(s.media) +
            sum(s.scalar_grids, [](const ScalarGrid& g) { return vector_bytes(g.values); }) +
            sum(s.color_grids,
                [](const ColorGrid& g) { return vector_bytes(g.values) + vector_bytes(g.colors); }) +
            sum(s.sparse_grids, [](const SparseGrid& g) { return g.bytes(); }),
        s.media.size(), "media");
    return table;
}

} // namespace montelux
