#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/float_near.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/build/emission.h"

namespace montelux::pbrt {
namespace {

void phase(DirectiveText& d, const PhaseFunction& p) {
    std::visit(Overloaded{[&](const HenyeyGreenstein& h) {
                              if (h.g != 0) d.number("g", h.g);
                          },
                          [&](const Draine& h) {
                              d.number("g", h.g);
                              d.number("alpha", h.alpha);
                          }},
               p);
}

void box(DirectiveText& d, std::string& transform, const MediumBox& b) {
    d.vector("point3", "p0", b.p0);
    d.vector("point3", "p1", b.p1);
    transform = transform_text(b.world_from_medium);
}

void size(DirectiveText& d, const std::array<int, 3>& n) {
    d.integer("nx", n[0]);
    d.integer("ny", n[1]);
    d.integer("nz", n[2]);
}

bool is_black(SceneSpectrum s) { return s.is_constant() && s.constant == 0; }

} // namespace

std::string SceneWriter::interface_text(const MediumInterface& media) const {
    // The interior of a translucent body belongs to its material.
    const auto name = [&](Index i) {
        if (i == no_index) return std::string();
        const auto* body = std::get_if<HomogeneousMedium>(&scene_.media[i]);
        return body != nullptr && body->is_body ? std::string() : "medium-" + std::to_string(i);
    };
    const std::string inside = name(media.inside), outside = name(media.outside);
    if (inside.empty() && outside.empty()) return {};
    return "MediumInterface " + quoted_text(inside) + " " + quoted_text(outside) + "\n";
}

// 'Le' and, of a homogeneous medium, 'Lescale'.
void SceneWriter::emission(DirectiveText& d, SceneSpectrum le, float scale, const std::string& what) {
    if (is_black(le)) return;
    const Spectrum s = spectrum_of(le, scene_.spectra);
    spectrum(d, "Le", s, RgbMeaning::illuminant, what);
    const float unit = s.max_value() > 0 ? photometric_scale(s) : 0;
    if (unit != scale)
        warn(what, "its emission is written times " + digits_of(unit / scale) + ", as pbrt scales it");
}

// Of all voxels from one below the lowest to one above the highest that is not 0: there, between the centres of its
// samples, a uniform grid interpolates as the sparse one does.
void SceneWriter::sparse_grid(DirectiveText& d, std::string& transform, const SparseGridMedium& m,
                              const std::string& what) {
    constexpr double most_voxels = 1 << 24; // 200 MB of text
    const SparseGrid& density = scene_.sparse_grids[m.density];
    SparseGrid::VoxelRange range = density.non_zero();
    if (range.empty()) range.upper = range.lower;
    std::array<int, 3> n{};
    Point3f lower, upper;
    double count = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        n[a] = range.upper[a] - range.lower[a] + 3;
        lower[static_cast<int>(a)] = static_cast<float>(range.lower[a]) - 1.5f;
        upper[static_cast<int>(a)] = static_cast<float>(range.upper[a]) + 1.5f;
        count *= n[a];
    }
    if (count > most_voxels)
        throw Error(
            what,
            "it is a sparse grid of " + digits_of(count) +
                " voxels, which pbrt reads from NanoVDB files; these are not written, and 'uniformgrid' "
                "only up to " +
                digits_of(most_voxels) + " voxels");
    warn(
        what,
        "it is a sparse grid; NanoVDB files are not written, so it becomes a 'uniformgrid', which differs by "
        "rounding");
    size(d, n);
    d.vector("point3", "p0", lower);
    d.vector("point3", "p1", upper);
    transform = transform_text(m.box.world_from_medium);
    const auto grid = [&](const char* name, const auto& value) {
        std::vector<float> values;
        values.reserve(static_cast<std::size_t>(count));
        for (int z = 0; z < n[2]; ++z)
            for (int y = 0; y < n[1]; ++y)
                for (int x = 0; x < n[0]; ++x)
                    values.push_back(
                        value(range.lower[0] - 1 + x, range.lower[1] - 1 + y, range.lower[2] - 1 + z));
        d.numbers("float", name, values);
    };
    grid("density", [&](int x, int y, int z) { return density.value(x, y, z); });
    if (m.temperature == no_index) return;
    const SparseGrid& temperature = scene_.sparse_grids[m.temperature];
    // Values below 0 do not glow, and pbrt has none.
    grid("temperature", [&](int x, int y, int z) {
        const Vec3d voxel(x, y, z);
        return std::max(temperature(Vec3f(m.temperature_space_from_density.point(voxel))), 0.0f);
    });
    if (!(m.temperature_space_from_density == Transform()))
        warn(what, "its temperatures are resampled at the voxels of its density");
    if (m.le_scale != 1) grid("Lescale", [&](int, int, int) { return m.le_scale; });
    d.number("temperatureoffset", m.temperature_offset);
    d.number("temperaturescale", m.temperature_scale);
}

void SceneWriter::medium(Index i) {
    const std::string what = "medium " + std::to_string(i);
    std::string transform;
    DirectiveText d("MakeNamedMedium " + quoted_text("medium-" + std::to_string(i)));
    const auto coefficients = [&](const auto& m) {
        for (const auto& [name, s] : {std::pair("sigma_a", m.sigma_a), std::pair("sigma_s", m.sigma_s)})
            if (!s.is_constant() || s.constant != 1) // the reader's own value
                spectrum(d, name, s, RgbMeaning::unbounded, what);
    };
    std::visit(
        Overloaded{
            [&](const HomogeneousMedium& m) {
                d.string("type", "homogeneous");
                coefficients(m);
                d.number("scale", m.scale);
                if (is_black(m.le)) {
                    d.number("Lescale", m.le_scale);
                } else {
                    const Spectrum s = spectrum_of(m.le, scene_.spectra);
                    const float unit = s.max_value() > 0 ? photometric_scale(s) : 1;
                    const double guess = double{m.le_scale} / double{unit};
                    const auto factor = float_near(guess, [&](float f) { return f * unit == m.le_scale; });
                    spectrum(d, "Le", s, RgbMeaning::illuminant, what);
                    d.number("Lescale", factor.value_or(static_cast<float>(guess)));
                }
                phase(d, m.phase);
            },
            [&](const GridMedium& m) {
                d.string("type", "uniformgrid");
                box(d, transform, m.box);
                const auto grid = [&](const char* name, Index g) {
                    if (g != no_index) d.numbers("float", name, scene_.scalar_grids[g].values);
                };
                size(d, scene_.scalar_grids[m.density].size);
                grid("density", m.density);
                grid("temperature", m.temperature);
                grid("Lescale", m.le_grid);
                for (const Index g : {m.temperature, m.le_grid})
                    if (g != no_index && scene_.scalar_grids[g].size != scene_.scalar_grids[m.density].size)
                        throw Error(what,
                                    "its grids have different sizes, which pbrt's 'uniformgrid' does not");
                d.number("temperatureoffset", m.temperature_offset);
                d.number("temperaturescale", m.temperature_scale);
                coefficients(m);
                d.number("scale", m.scale);
                emission(d, m.le, m.le_scale, what);
                phase(d, m.phase);
            },
            [&](const RgbGridMedium& m) {
                d.string("type", "rgbgrid");
                box(d, transform, m.box);
                bool has_size = false;
                const auto grid = [&](const char* name, Index g) {
                    if (g == no_index) return;
                    const ColorGrid& colors = scene_.color_grids[g];
                    if (colors.colors.size() != colors.values.size() || colors.space == nullptr)
                        throw Error(what, "the colours that its grid was made from are not known");
                    if (!has_size) size(d, colors.size);
                    has_size = true;
                    if (!d.use_color_space(*colors.space))
                        throw Error(
                            what,
                            "its grids have different colour spaces, which a directive of pbrt has not");
                    std::vector<float> values;
                    values.reserve(3 * colors.colors.size());
                    for (const Vec3f& c : colors.colors) values.insert(values.end(), {c.x, c.y, c.z});
                    d.numbers("rgb", name, values);
                };
                grid("sigma_a", m.sigma_a);
                grid("sigma_s", m.sigma_s);
                grid("Le", m.le);
                d.number("scale", m.scale);
                d.number("Lescale", m.le_scale);
                phase(d, m.phase);
            },
            [&](const CloudMedium& m) {
                d.string("type", "cloud");
                box(d, transform, m.box);
                coefficients(m);
                d.number("density", m.density);
                d.number("wispiness", m.wispiness);
                d.number("frequency", m.frequency);
                phase(d, m.phase);
            },
            [&](const FieldMedium& m) {
                if (m.extinction.scalars == no_index || m.albedo.is_grid())
                    throw Error(what, "pbrt has no medium of extinction and albedo but for grey grids of "
                                      "extinction with one albedo");
                d.string("type", "uniformgrid");
                const ScalarGrid& density = scene_.scalar_grids[m.extinction.scalars];
                Matrix4 unit_from_world;
                for (std::size_t a = 0; a < 3; ++a) {
                    const Vec3f row = m.extinction.unit_from_world.rows[a];
                    const float offset = m.extinction.unit_from_world.offset[static_cast<int>(a)];
                    unit_from_world.m[a] = {double(row.x), double(row.y), double(row.z), double(offset)};
                }
                const std::optional<Transform> place = Transform::from_matrix(unit_from_world);
                if (!place) throw Error(what, "its grid has no volume");
                box(d, transform, {.world_from_medium = place->inverse()});
                size(d, density.size);
                d.numbers("float", "density", density.values);
                const Spectrum albedo = spectrum_of(m.albedo.value, scene_.spectra);
                const auto share = [&](float lambda) { return std::clamp(albedo(lambda), 0.0f, 1.0f); };
                spectrum(d, "sigma_s", Spectrum(SpectrumTable::from(share)), RgbMeaning::unbounded, what);
                spectrum(d, "sigma_a",
                         Spectrum(SpectrumTable::from([&](float lambda) { return 1 - share(lambda); })),
                         RgbMeaning::unbounded, what);
                d.number("scale", m.scale);
                phase(d, m.phase);
                warn(what, "its density falls to half at the faces of its grid, as pbrt's does");
                if (m.extinction.nearest) warn(what, "its density is interpolated");
            },
            [&](const SparseGridMedium& m) {
                d.string("type", "uniformgrid");
                sparse_grid(d, transform, m, what);
                coefficients(m);
                d.number("scale", m.scale);
                phase(d, m.phase);
            }},
        scene_.media[i]);
    put_block(transform + d.text());
}

void SceneWriter::media() {
    for (Index i = 0; i < scene_.media.size(); ++i) {
        const auto* body = std::get_if<HomogeneousMedium>(&scene_.media[i]);
        if (body == nullptr || !body->is_body) medium(i);
    }
}

} // namespace montelux::pbrt
