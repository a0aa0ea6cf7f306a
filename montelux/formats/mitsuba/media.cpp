#include "montelux/formats/mitsuba/media.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "montelux/formats/mitsuba/grid_volume.h"
#include "montelux/formats/mitsuba/spectra.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/build/quoted.h"
#include "montelux/scene/shape/bounds.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::mitsuba {
namespace {

Transform affine_transform(Plugin& plugin) {
    const Transform t = plugin.transform("to_world");
    if (t.matrix().m[3] != std::array<double, 4>{0, 0, 0, 1})
        plugin.error("'to_world' is projective; expected an affine transformation");
    if (!fits_float(t)) plugin.error("'to_world' is beyond what single-precision numbers hold");
    return t;
}

PhaseFunction phase_function(Plugin& medium) {
    std::optional<Plugin> phase = medium.child("phase");
    if (!phase) return HenyeyGreenstein{0};
    PhaseFunction result = HenyeyGreenstein{0};
    if (phase->type() == "hg") {
        constexpr double most = 0.9999;
        result = HenyeyGreenstein{static_cast<float>(phase->number("g", 0.8, -most, most))};
    } else if (phase->type() == "rayleigh") {
        result = Draine{0, 1};
    } else if (phase->type() != "isotropic") {
        phase->refuse();
    }
    phase->finish();
    return result;
}

// The axis-parallel box around a unit cube: a medium ends there.
MediumBox box_around(const Transform& world_from_unit, const Plugin& medium) {
    Bounds3 bounds, cube;
    cube.add({0, 0, 0});
    cube.add({1, 1, 1});
    for (int i = 0; i < 8; ++i) bounds.add(world_from_unit.point(cube.corner(i)));
    if (!fits_float(bounds.lower) || !fits_float(bounds.upper))
        medium.error("the medium lies beyond what single-precision numbers hold");
    MediumBox box;
    box.p0 = Point3f(bounds.lower);
    box.p1 = Point3f(bounds.upper);
    if (!(box.p0.x < box.p1.x && box.p0.y < box.p1.y && box.p0.z < box.p1.z))
        medium.error("the medium has no volume");
    return box;
}

} // namespace

Index MediumLibrary::of(const Plugin& medium) {
    const auto known = made_.find(medium.index());
    if (known != made_.end()) return known->second;
    return made_[medium.index()] = make(medium);
}

Index MediumLibrary::make(Plugin medium) {
    const bool everywhere = medium.type() == "homogeneous";
    if (!everywhere && medium.type() != "heterogeneous") medium.refuse();
    for (const std::string_view name : {"sigma_s", "sigma_a"})
        if (medium.has(name))
            medium.error(in_quotes(name) + " is not supported; expected 'sigma_t' and 'albedo'");
    const PlacedField extinction = field(medium, "sigma_t", 1), albedo = field(medium, "albedo", 0.75f);
    const float scale = static_cast<float>(medium.number("scale", 1, 0));
    const PhaseFunction phase = phase_function(medium);
    medium.skip("sample_emitters"); // these two steer the sampling alone
    medium.skip("has_spectral_extinction");
    medium.finish();

    Medium made;
    if (everywhere && extinction.field.is_grid())
        medium.error("the extinction of a homogeneous medium is a grid; expected a medium 'heterogeneous'");
    if (everywhere && !albedo.field.is_grid()) {
        made = homogeneous(extinction, albedo, scale, phase);
    } else {
        FieldMedium m;
        m.bounded = !everywhere;
        if (m.bounded) m.box = box_around(extinction.world_from_unit, medium);
        m.extinction = extinction.field;
        m.albedo = albedo.field;
        m.scale = scale;
        m.phase = phase;
        made = m;
    }
    builder_.scene().media.push_back(made);
    return static_cast<Index>(builder_.scene().media.size() - 1);
}

Medium MediumLibrary::homogeneous(const PlacedField& extinction, const PlacedField& albedo, float scale,
                                  const PhaseFunction& phase) {
    HomogeneousMedium m;
    m.scale = scale;
    m.phase = phase;
    const SceneSpectrum t = extinction.field.value, a = albedo.field.value;
    if (t.is_constant() && a.is_constant()) {
        m.sigma_s = t.constant * a.constant;
        m.sigma_a = t.constant - m.sigma_s.constant;
        return m;
    }
    const std::vector<Spectrum>& all = builder_.scene().spectra;
    const SpectrumTable extinctions = spectrum_of(t, all).tabulate(), shares = spectrum_of(a, all).tabulate();
    const auto share = [&](float lambda) { return std::clamp(shares(lambda), 0.0f, 1.0f); };
    m.sigma_s = builder_.add_spectrum(
        Spectrum(SpectrumTable::from([&](float lambda) { return extinctions(lambda) * share(lambda); })));
    m.sigma_a = builder_.add_spectrum(Spectrum(
        SpectrumTable::from([&](float lambda) { return extinctions(lambda) * (1 - share(lambda)); })));
    return m;
}

// Colours stand for reflectances here, and those of a "constvolume" for any value.
MediumLibrary::PlacedField MediumLibrary::field(Plugin& medium, std::string_view name, float otherwise) {
    const Property* property = medium.find(name);
    PlacedField placed;
    placed.field.value = otherwise;
    if (property == nullptr) return placed;
    const SceneGraph& graph = medium.graph();
    if (const auto* object = std::get_if<ObjectIndex>(&property->value))
        if (Plugin volume(graph, object->value); volume.kind() == "volume") {
            if (volume.type() == "constvolume") return constant(volume);
            if (volume.type() == "gridvolume") return grid(volume);
            volume.refuse();
        }
    const bool is_number = std::holds_alternative<double>(property->value) ||
                           std::holds_alternative<std::int64_t>(property->value);
    if (is_number && name == "albedo") medium.number(name, 0, 0, 1);
    placed.field.value = builder_.add_spectrum(
        spectrum_of(*property, is_number ? SpectrumUse::unbounded : SpectrumUse::reflectance, graph));
    return placed;
}

MediumLibrary::PlacedField MediumLibrary::constant(Plugin volume) {
    PlacedField placed;
    placed.world_from_unit = affine_transform(volume);
    if (const Property* value = volume.find("value"))
        placed.field.value =
            builder_.add_spectrum(spectrum_of(*value, SpectrumUse::unbounded, volume.graph()));
    volume.finish();
    return placed;
}

MediumLibrary::PlacedField MediumLibrary::grid(Plugin volume) {
    const std::filesystem::path path = volume.file("filename");
    const Grid grid = read_grid(path, volume.find("filename")->at, volume.graph());
    PlacedField placed;
    placed.field.scalars = grid.scalars;
    placed.field.colors = grid.colors;
    placed.field.nearest = volume.choice("filter_type", "trilinear", {"trilinear", "nearest"}) == "nearest";
    const std::string wrap = volume.choice("wrap_mode", "clamp", {"clamp", "repeat", "mirror"});
    if (wrap != "clamp") placed.field.wrap = wrap == "repeat" ? GridWrap::repeat : GridWrap::mirror;
    for (const std::string_view without_effect : {"raw", "accel", "max_value"}) volume.skip(without_effect);
    placed.world_from_unit = affine_transform(volume);
    if (volume.flag("use_grid_bbox", false)) {
        if (!grid.has_box) volume.error(path.string() + " names a box without volume");
        placed.world_from_unit = placed.world_from_unit * grid.unit_from_box.inverse();
    }
    if (!fits_float(placed.world_from_unit))
        volume.error("the place of the grid is beyond what single-precision numbers hold");
    placed.field.unit_from_world = AffineMap(placed.world_from_unit.inverse());
    volume.finish();
    return placed;
}

MediumLibrary::Grid MediumLibrary::read_grid(const std::filesystem::path& path, SourceLocation at,
                                             const SceneGraph& graph) {
    const std::string key = path.lexically_normal().string();
    if (const auto known = grids_.find(key); known != grids_.end()) return known->second;
    const std::vector<std::uint8_t> bytes = graph.files.read(path, at);
    GridVolume volume;
    try {
        volume = read_grid_volume(bytes, path.string());
        if (volume.channels == 6) throw Error(path.string(), "has 6 channels; expected 1 or 3");
        if (std::ranges::any_of(volume.values, [](float v) { return v < 0; }))
            throw Error(path.string(), "has a negative sample");
    } catch (const Error& e) {
        graph.diagnostics.error(at, e.what());
    }
    Grid grid;
    const Vec3d lower(volume.lower), extent = Vec3d(volume.upper) - lower;
    grid.has_box = extent.x > 0 && extent.y > 0 && extent.z > 0 && fits_float(lower) && fits_float(extent);
    if (grid.has_box)
        grid.unit_from_box =
            Transform::scale({1 / extent.x, 1 / extent.y, 1 / extent.z}) * Transform::translate(-lower);
    Scene& scene = builder_.scene();
    if (volume.channels == 1) {
        ScalarGrid& samples = scene.scalar_grids.emplace_back();
        samples.size = volume.size;
        samples.values = std::move(volume.values);
        grid.scalars = static_cast<Index>(scene.scalar_grids.size() - 1);
    } else {
        const RgbColorSpace& space = RgbColorSpace::srgb();
        ColorGrid& samples = scene.color_grids.emplace_back();
        samples.size = volume.size;
        samples.space = &space;
        samples.values.reserve(volume.values.size() / 3);
        for (std::size_t i = 0; i + 2 < volume.values.size(); i += 3)
            samples.values.push_back(
                RgbUnboundedSpectrum(space, {volume.values[i], volume.values[i + 1], volume.values[i + 2]}));
        grid.colors = static_cast<Index>(scene.color_grids.size() - 1);
    }
    return grids_[key] = grid;
}

} // namespace montelux::mitsuba
