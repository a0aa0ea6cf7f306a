#include "montelux/scene/scene_digest.h"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "montelux/scene/material/material_model.h"
#include "montelux/scene/value_hash.h"

namespace montelux {
namespace {

// Structured bindings list every member: a new one does not compile until it is hashed here.
class SceneHasher {
  public:
    explicit SceneHasher(std::span<const Spectrum> spectra = {}) : spectra_(spectra) {}

    // Values one after the other.
    template <typename... T>
    void all(const T&... values) {
        (add(values), ...);
    }
    ContentDigest value() const { return hash_.value(); }

  private:
    template <typename T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) { hash_.add(value); }

    // Containers: the length, the presence or the alternative before the values.
    template <typename T>
    void add(std::span<const T> values) {
        add(static_cast<std::uint64_t>(values.size()));
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, Vec2f> || std::is_same_v<T, Vec3f>)
            hash_.add_bytes(values.data(), values.size_bytes());
        else
            for (const T& v : values) add(v);
    }
    template <typename T>
    void add(const std::vector<T>& values) {
        add(std::span<const T>(values));
    }
    template <typename T, std::size_t n>
    void add(const std::array<T, n>& values) {
        add(std::span<const T>(values));
    }
    void add(std::string_view text) { add(std::span<const char>(text)); }
    template <typename T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <typename... T>
    void add(const std::variant<T...>& value) {
        add(static_cast<std::uint64_t>(value.index()));
        std::visit([this](const auto& v) { add(v); }, value);
    }

    // Any other struct.
    template <typename T>
    requires std::is_class_v<T>
    void add(const T&) {
        static_assert(sizeof(T) == 0,
                      "write an overload of SceneHasher::add that adds all values of this type");
    }

    // Numbers.
    template <typename T>
    void add(const Vec2<T>& v) {
        all(v.x, v.y);
    }
    template <typename T>
    void add(const Vec3<T>& v) {
        all(v.x, v.y, v.z);
    }
    void add(const Matrix4& matrix) {
        const auto& [rows] = matrix;
        add(rows);
    }
    void add(const Transform& t) { all(t.matrix(), t.inverse_matrix()); }

    // Spectra: by value, wherever they are in Scene::spectra.
    void add(SceneSpectrum s) { add(spectrum_of(s, spectra_)); }
    void add(const Spectrum& s) { add(s.kind()); }
    void add(const ConstantSpectrum& s) {
        const auto& [value] = s;
        add(value);
    }
    template <typename Data>
    void add(const SharedSpectrum<Data>& s) {
        add(s.data());
    }
    void add(const SpectrumTable& s) { add(s.values()); }
    void add(const PiecewiseLinear& s) { add(s.knots()); }
    void add(const PiecewiseLinear::Knot& knot) {
        const auto& [lambda, value, slope] = knot;
        all(lambda, value, slope);
    }
    void add(const BlackbodySpectrum& s) { add(s.temperature()); }
    void add(const SigmoidPolynomial& p) {
        const auto& [a, b, c] = p;
        all(a, b, c);
    }
    void add(const RgbAlbedoSpectrum& s) { add(s.polynomial()); }
    void add(const RgbUnboundedSpectrum& s) { all(s.scale(), s.polynomial()); }
    void add(const RgbIlluminantSpectrum& s) { all(s.filter(), s.illuminant()); }
    void add(const RgbColorSpace* space) {
        all(space->red(), space->green(), space->blue(), space->illuminant());
    }

    // Textures.
    template <typename Value>
    void add_parameter(const Value& value, Index texture) {
        add(texture);
        if (texture == no_index) add(value); // ignored if there is a texture
    }
    void add(const FloatParameter& p) {
        const auto& [value, texture] = p;
        add_parameter(value, texture);
    }
    void add(const SpectrumParameter& p) {
        const auto& [value, texture] = p;
        add_parameter(value, texture);
    }
    void add(const TextureMapping& m) {
        const auto& [kind, su, sv, du, dv, vs, vt, texture_from_world] = m;
        all(kind, su, sv, du, dv, vs, vt, texture_from_world);
    }
    void add(const ImageTexture& t) {
        const auto& [image, channels, mapping, filter, wrap, anisotropy, scale, invert, meaning, space] = t;
        all(image, channels, mapping, filter, wrap, anisotropy, scale, invert, meaning, space);
    }
    template <typename Parameter>
    void add(const ConstantTexture<Parameter>& t) {
        const auto& [value] = t;
        add(value);
    }
    template <typename Parameter>
    void add(const ScaleTexture<Parameter>& t) {
        const auto& [texture, scale] = t;
        all(texture, scale);
    }
    template <typename Parameter>
    void add(const MixTexture<Parameter>& t) {
        const auto& [first, second, amount] = t;
        all(first, second, amount);
    }
    template <typename Parameter>
    void add(const CheckerboardTexture<Parameter>& t) {
        const auto& [dimension, mapping, values] = t;
        all(dimension, mapping, values);
    }
    template <typename Parameter>
    void add(const BilerpTexture<Parameter>& t) {
        const auto& [mapping, corners] = t;
        all(mapping, corners);
    }
    template <typename Parameter>
    void add(const DotsTexture<Parameter>& t) {
        const auto& [mapping, outside, inside] = t;
        all(mapping, outside, inside);
    }
    template <typename Parameter>
    void add(const DirectionMixTexture<Parameter>& t) {
        const auto& [first, second, direction] = t;
        all(first, second, direction);
    }
    void add(const NoiseOctaves& n) {
        const auto& [octaves, roughness] = n;
        all(octaves, roughness);
    }
    void add(const NoiseTexture& t) {
        const auto& [kind, octaves, texture_from_world] = t;
        all(kind, octaves, texture_from_world);
    }
    void add(const MarbleTexture& t) {
        const auto& [octaves, scale, variation, texture_from_world] = t;
        all(octaves, scale, variation, texture_from_world);
    }
    // Pixels only, without the header.
    void add(const Image& image) {
        all(image.width(), image.height(), image.format(), image.encoding().kind(),
            image.encoding().exponent(), static_cast<std::uint64_t>(image.channels()));
        for (const std::string& name : image.channel_names()) add(std::string_view(name));
        all(image.u8(), image.u16(), image.f32());
        image.give_back();
    }

    // Materials, by their lists of parameters.
    void add(const Material& m) {
        add(static_cast<std::uint64_t>(m.index()));
        visit_fields(m, [this](std::string_view, const auto& value) { add(value); });
    }
    void add(const NormalMapParameter& p) {
        const auto& [map] = p;
        add(map);
    }

    void add(const MeasuredBrdfIndex& b) {
        const auto& [index] = b;
        add(index);
    }
    void add(const MediumIndex& m) {
        const auto& [index] = m;
        add(index);
    }
    void add(const BrdfTables& t) {
        const auto& [columns, rows, values] = t;
        all(columns, rows, values);
    }
    // Its distributions follow from its data.
    void add(const MeasuredBrdf& b) {
        const auto& [theta, phi, wavelengths, ndf, sigma, visible_normals, luminance, spectra] = b.data();
        all(theta, phi, wavelengths, ndf, sigma, visible_normals, luminance, spectra);
    }

    void add(const MaterialIndex& r) {
        const auto& [index] = r;
        add(index);
    }

    // Media.
    void add(const MediumInterface& m) {
        const auto& [inside, outside] = m;
        all(inside, outside);
    }
    void add(const HenyeyGreenstein& p) {
        const auto& [g] = p;
        add(g);
    }
    void add(const Draine& p) {
        const auto& [g, alpha] = p;
        all(g, alpha);
    }
    void add(const MediumBox& b) {
        const auto& [p0, p1, world_from_medium] = b;
        all(p0, p1, world_from_medium);
    }
    template <typename T>
    void add(const Grid3<T>& g) {
        const auto& [size, values] = g;
        all(size, values);
    }
    void add(const ScalarGrid& g) { add(static_cast<const Grid3<float>&>(g)); }
    void add(const ColorGrid& g) { add(static_cast<const Grid3<RgbUnboundedSpectrum>&>(g)); }
    void add(const HomogeneousMedium& m) {
        const auto& [sigma_a, sigma_s, scale, le, le_scale, phase, is_body, surface] = m;
        all(sigma_a, sigma_s, scale, le, le_scale, phase);
        if (is_body) add(is_body);
        if (!surface.is_given()) return;
        const auto& [kind, first, second, surface_scale, eta, g] = surface;
        all(kind, first, second, surface_scale, eta, g);
    }
    void add(const GridMedium& m) {
        const auto& [box, density, sigma_a, sigma_s, scale, le, le_scale, le_grid, temperature, offset,
                     temperature_scale, phase] = m;
        all(box, density, sigma_a, sigma_s, scale, le, le_scale, le_grid, temperature, offset,
            temperature_scale, phase);
    }
    void add(const RgbGridMedium& m) {
        const auto& [box, sigma_a, sigma_s, scale, le, illuminant, le_scale, phase] = m;
        all(box, sigma_a, sigma_s, scale, le, illuminant, le_scale, phase);
    }
    void add(const SparseGrid& g) {
        const auto& [node_count, nodes, blocks, values, constants] = g;
        all(node_count, nodes, blocks, values, constants);
    }
    void add(const SparseGridMedium& m) {
        const auto& [box, density, sigma_a, sigma_s, scale, temperature, temperature_space, le_scale, offset,
                     temperature_scale, phase] = m;
        all(box, density, sigma_a, sigma_s, scale, temperature, temperature_space, le_scale, offset,
            temperature_scale, phase);
    }
    void add(const CloudMedium& m) {
        const auto& [box, sigma_a, sigma_s, density, wispiness, frequency, phase] = m;
        all(box, sigma_a, sigma_s, density, wispiness, frequency, phase);
    }

    // Geometry.
    void add(const TriangleMesh& m) {
        const auto& [positions, normals, uvs, indices, tangents, end_positions, end_normals] = m;
        all(positions, normals, uvs, indices);
        if (!tangents.empty()) add(tangents);
        if (m.deforms()) all(end_positions, end_normals);
    }
    void add(const Sphere& s) {
        const auto& [radius, z_min, z_max, phi_max, world_from_object] = s;
        all(radius, z_min, z_max, phi_max, world_from_object);
    }
    void add(const Disk& d) {
        const auto& [height, radius, inner_radius, phi_max, world_from_object] = d;
        all(height, radius, inner_radius, phi_max, world_from_object);
    }
    void add(const Cylinder& c) {
        const auto& [radius, z_min, z_max, phi_max, world_from_object] = c;
        all(radius, z_min, z_max, phi_max, world_from_object);
    }
    void add(const MeshIndex& i) {
        const auto& [index] = i;
        add(index);
    }
    void add(const Curves& c) {
        const auto& [kind, control_points, widths, normals] = c;
        all(kind, control_points, widths, normals);
    }
    void add(const BilinearMesh& m) {
        const auto& [positions, normals, uvs, indices] = m;
        all(positions, normals, uvs, indices);
    }
    void add(const BilinearMeshIndex& i) {
        const auto& [index] = i;
        add(index);
    }
    void add(const CurvesIndex& i) {
        const auto& [index] = i;
        add(index);
    }
    void add(const QuadricIndex& i) {
        const auto& [index] = i;
        add(index);
    }
    void add(const Shape& s) {
        const auto& [geometry, material, light, alpha, flip_normal, media] = s;
        static_cast<void>(media); // add_media
        all(geometry, material, light, alpha, flip_normal);
    }
    void add(const ObjectDefinition& o) {
        const auto& [shapes, name, part_of, shines] = o;
        static_cast<void>(name); // the mean does not depend on names
        static_cast<void>(part_of);
        static_cast<void>(shines); // add_emitters
        add(shapes);
    }
    void add(const Instance& i) {
        const auto& [object, world_from_object, motion] = i;
        all(object, world_from_object, motion);
    }
    void add(const Motion& m) {
        all(m.start(), m.end());
        if (m.is_product()) add(m.keys());
    }

    // Lights.
    void add(const AreaLight& l) {
        const auto& [spectrum, scale, two_sided, shape, primitive_flux, picture] = l;
        all(spectrum, scale, two_sided, shape, primitive_flux);
        if (picture != no_index) add(picture);
    }
    void add(const PointLight& l) {
        const auto& [spectrum, scale, position, motion] = l;
        all(spectrum, scale, position);
        if (motion != no_index) add(motion);
    }
    void add(const SpotLight& l) {
        const auto& [spectrum, scale, position, axis, cos_falloff_start, cos_total_width, motion] = l;
        all(spectrum, scale, position, axis, cos_falloff_start, cos_total_width);
        if (motion != no_index) add(motion);
    }
    void add(const DistantLight& l) {
        const auto& [spectrum, scale, to_light, motion] = l;
        all(spectrum, scale, to_light);
        if (motion != no_index) add(motion);
    }
    void add(const Portal& p) { add(p.corners()); }
    void add(const UniformInfiniteLight& l) {
        const auto& [spectrum, scale, portal] = l;
        all(spectrum, scale, portal);
    }
    void add(const ImageInfiniteLight& l) {
        const auto& [environment, layout, scale, world_from_light, portal, motion] = l;
        all(environment, layout, scale, world_from_light, portal);
        if (motion != no_index) add(motion);
    }
    void add(const SkyLight& l) {
        const auto& [sky, environment, scale, world_from_light, motion] = l;
        all(sky, environment, scale, world_from_light);
        if (motion != no_index) add(motion);
    }
    void add(const SunDisc& d) {
        const auto& [centre, versine] = d;
        all(centre, versine);
    }
    void add(const SunLight& l) {
        const auto& [spectrum, scale, disc, up, motion] = l;
        all(spectrum, scale, disc, up);
        if (motion != no_index) add(motion);
    }
    void add(const GoniometricLight& l) {
        const auto& [spectrum, scale, environment, layout, world_from_map, motion] = l;
        all(spectrum, scale, environment, layout, world_from_map);
        if (motion != no_index) add(motion);
    }
    void add(const ProjectionLight& l) {
        const auto& [environment, scale, fov, world_from_light, motion] = l;
        all(environment, scale, fov, world_from_light);
        if (motion != no_index) add(motion);
    }
    // Its tables follow from its settings.
    void add(const SkyModel& sky) {
        const auto& [elevation, azimuth, atmosphere, ground_albedo] = sky.settings();
        const auto& [turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone] = atmosphere;
        all(elevation, azimuth, ground_albedo);
        all(turbidity, angstrom_exponent, aerosol_albedo, aerosol_g, ozone);
    }

    // Cameras.
    void add(const ScreenWindow& w) {
        const auto& [x_min, x_max, y_min, y_max] = w;
        all(x_min, x_max, y_min, y_max);
    }
    void add(const PerspectiveCamera& c) {
        const auto& [fov, lens_radius, focal_distance, frame_aspect_ratio, screen_window] = c;
        all(fov, lens_radius, focal_distance, frame_aspect_ratio, screen_window);
    }
    void add(const OrthographicCamera& c) {
        const auto& [lens_radius, focal_distance, frame_aspect_ratio, screen_window] = c;
        all(lens_radius, focal_distance, frame_aspect_ratio, screen_window);
    }
    void add(const SphericalCamera& c) {
        const auto& [mapping] = c;
        add(mapping);
    }
    void add(const LensSurface& s) {
        const auto& [radius, thickness, eta, aperture_radius] = s;
        all(radius, thickness, eta, aperture_radius);
    }
    void add(const RealisticCamera& c) {
        const auto& [surfaces, focus_distance, film_diagonal, aperture] = c;
        all(surfaces, focus_distance, film_diagonal);
        if (aperture) all(aperture->width, aperture->height, aperture->values);
    }
    void add(const CameraSettings& c) {
        const auto& [model, world_from_camera, motion, shutter_open, shutter_close, medium] = c;
        static_cast<void>(medium); // add_media
        all(model, world_from_camera, motion, shutter_open, shutter_close);
    }

    std::span<const Spectrum> spectra_;
    ValueHash hash_;
};

template <typename... T>
ContentDigest digest_of_all(const Scene& scene, const T&... values) {
    SceneHasher hasher(scene.spectra);
    hasher.all(values...);
    return hasher.value();
}

// Media, and where they are; nothing is hashed for a scene without media.
void add_media(SceneHasher& hasher, const Scene& scene) {
    if (scene.media.empty()) return;
    hasher.all(scene.media, scene.scalar_grids, scene.color_grids, scene.camera.medium);
    if (!scene.sparse_grids.empty()) hasher.all(scene.sparse_grids); // else the digest is that without them
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (const MediumInterface& media = scene.shapes[i].media; media.is_transition())
            hasher.all(static_cast<std::uint64_t>(i), media);
}

// Shapes in objects that shine; nothing is hashed for a scene without them.
void add_emitters(SceneHasher& hasher, const Scene& scene) {
    for (const ObjectDefinition& object : scene.objects)
        for (const Index shape : object.shapes)
            if (object.shines && scene.shapes[shape].light != no_index) hasher.all(shape);
}

} // namespace

ContentDigest SceneDigest::whole() const {
    ValueHash hash;
    for (const ContentDigest& part : {geometry, materials, textures, lights, camera}) {
        hash.add(part.high);
        hash.add(part.low);
    }
    return hash.value();
}

SceneDigest digest_of(const Scene& scene) {
    const auto& [meshes, quadrics, curves, bilinear_meshes, shapes, world_shapes, objects, instances, motions,
                 spectra, materials, float_textures, spectrum_textures, normal_maps, images, environments,
                 skies, measured_brdfs, lights, camera, shape_names, material_names, light_groups, media,
                 scalar_grids, color_grids, sparse_grids, texel_file] = scene;
    // Of layers alone; checkpoints compare them where they matter.
    static_cast<void>(shape_names);
    static_cast<void>(material_names);
    static_cast<void>(light_groups);
    static_cast<void>(texel_file); // where samples are is no part of them
    SceneHasher of_materials(spectra);
    of_materials.all(materials);
    if (!measured_brdfs.empty()) of_materials.all(measured_brdfs);
    add_media(of_materials, scene);
    SceneHasher of_geometry(spectra);
    of_geometry.all(meshes, quadrics, shapes, world_shapes, objects, instances, motions);
    if (!curves.empty()) of_geometry.all(curves);
    if (!bilinear_meshes.empty()) of_geometry.all(bilinear_meshes);
    add_emitters(of_geometry, scene);
    return {of_geometry.value(), of_materials.value(),
            digest_of_all(scene, float_textures, spectrum_textures, normal_maps, images),
            digest_of_all(scene, lights, environments, skies), digest_of_all(scene, camera)};
}

ContentDigest digest_of(const Spectrum& spectrum) {
    SceneHasher hasher;
    hasher.all(spectrum);
    return hasher.value();
}

} // namespace montelux
