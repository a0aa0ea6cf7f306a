#include "montelux/formats/pbrt/media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "montelux/formats/nanovdb_file.h"
#include "montelux/formats/pbrt/coverage.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/float_range.h"
#include "montelux/scene/medium/medium_presets.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {
namespace {

const MediumPreset& find_preset(ParameterReader& r, const std::string& name) {
    std::vector<std::string_view> names;
    for (const MediumPreset& preset : medium_presets()) {
        if (preset.name == name) return preset;
        names.push_back(preset.name);
    }
    r.error("preset", "there is no medium preset " + in_quotes(name) + did_you_mean(name, names));
}

PhaseFunction phase_function(ParameterReader& r) {
    const float g = r.number("g", 0), alpha = r.number("alpha", 0);
    if (!(std::abs(g) < 1)) r.error("g", "parameter 'g' is not between -1 and 1");
    if (!(alpha >= 0)) r.error("alpha", "parameter 'alpha' is negative");
    if (alpha > 0) return Draine{g, alpha};
    return HenyeyGreenstein{g};
}

float not_negative(ParameterReader& r, std::string_view name, float otherwise) {
    const float value = r.number(name, otherwise);
    if (!(value >= 0)) r.error(name, "parameter " + in_quotes(name) + " is negative");
    return value;
}

void check_transform(ParameterReader& r, const Transform& world_from_medium) {
    const Matrix4& m = world_from_medium.matrix();
    if (m.m[3] != std::array<double, 4>{0, 0, 0, 1})
        r.error("the medium's transformation is projective; expected an affine one");
    if (!fits_float(world_from_medium))
        r.error("the medium's transformation is beyond what single-precision numbers hold");
}

MediumBox box(ParameterReader& r, const Transform& world_from_medium) {
    check_transform(r, world_from_medium);
    MediumBox b;
    const Point3f p0 = r.point3("p0").value_or(b.p0), p1 = r.point3("p1").value_or(b.p1);
    b.p0 = min(p0, p1);
    b.p1 = max(p0, p1);
    b.world_from_medium = world_from_medium;
    const Vec3f size = b.p1 - b.p0;
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) r.error("p1", "the box between 'p0' and 'p1' is empty");
    return b;
}

std::array<int, 3> grid_size(ParameterReader& r) {
    const auto along = [&](std::string_view name) {
        const int n = r.integer(name, 1);
        if (n < 1)
            r.error(name, "parameter " + in_quotes(name) + " is " + std::to_string(n) +
                              "; expected at least 1 sample");
        return n;
    };
    const int nx = along("nx"), ny = along("ny"), nz = along("nz");
    return {nx, ny, nz};
}

void check_count(ParameterReader& r, std::string_view name, std::size_t count, std::array<int, 3> size) {
    const double expected = double(size[0]) * double(size[1]) * double(size[2]);
    if (static_cast<double>(count) != expected)
        r.error(name, "parameter " + in_quotes(name) + " has " + std::to_string(count) +
                          " values; expected nx x ny x nz = " + std::to_string(size[0]) + " x " +
                          std::to_string(size[1]) + " x " + std::to_string(size[2]));
}

} // namespace

SceneSpectrum MediumReader::coefficient(ParameterReader& r, std::string_view name) {
    const Parameter* p = r.any(name, {ParameterType::rgb, ParameterType::spectrum, ParameterType::blackbody});
    if (p == nullptr) return 1.0f;
    const Spectrum s = spectra_.read(*p, RgbMeaning::unbounded);
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda)
        if (!(s(lambda) >= 0) || !std::isfinite(s(lambda)))
            r.error(name, "parameter " + in_quotes(name) + " is negative or not finite at " +
                              std::to_string(static_cast<int>(lambda)) + " nm");
    return builder_.add_spectrum(s);
}

std::pair<SceneSpectrum, SceneSpectrum> MediumReader::coefficients(ParameterReader& r) {
    const SceneSpectrum sigma_a = coefficient(r, "sigma_a"), sigma_s = coefficient(r, "sigma_s");
    const std::optional<std::string> name = r.string("preset");
    if (!name || name->empty()) return {sigma_a, sigma_s};
    const MediumPreset& preset = find_preset(r, *name);
    return {builder_.add_spectrum(RgbUnboundedSpectrum(RgbColorSpace::srgb(), preset.sigma_a)),
            builder_.add_spectrum(RgbUnboundedSpectrum(RgbColorSpace::srgb(), preset.sigma_s))};
}

std::optional<std::pair<SceneSpectrum, float>> MediumReader::emission(ParameterReader& r) {
    const Parameter* p = r.any("Le", {ParameterType::rgb, ParameterType::spectrum, ParameterType::blackbody});
    if (p == nullptr) return std::nullopt;
    const Spectrum s = spectra_.read(*p, RgbMeaning::illuminant);
    if (!(s.max_value() > 0)) return std::pair(SceneSpectrum(), 0.0f);
    try {
        return std::pair(builder_.add_spectrum(s), photometric_scale(s));
    } catch (const Error& e) {
        r.error("Le", e.what());
    }
}

HomogeneousMedium MediumReader::homogeneous(ParameterReader& r) {
    HomogeneousMedium m;
    std::tie(m.sigma_a, m.sigma_s) = coefficients(r);
    m.scale = not_negative(r, "scale", 1);
    m.le_scale = not_negative(r, "Lescale", 1);
    if (const auto le = emission(r)) {
        m.le = le->first;
        m.le_scale *= le->second;
    }
    m.phase = phase_function(r);
    return m;
}

std::optional<ScalarGrid> MediumReader::scalar_grid(ParameterReader& r, std::string_view name,
                                                    std::array<int, 3> size) {
    const std::span<const float> values = r.numbers(name, ParameterType::floating);
    if (values.empty()) return std::nullopt;
    check_count(r, name, values.size(), size);
    for (const float v : values)
        if (!(v >= 0) || !std::isfinite(v))
            r.error(name, "parameter " + in_quotes(name) + " has a value that is negative or not finite");
    ScalarGrid grid;
    grid.size = size;
    grid.values.assign(values.begin(), values.end());
    return grid;
}

Index MediumReader::add(ScalarGrid grid) {
    std::vector<ScalarGrid>& grids = builder_.scene().scalar_grids;
    grids.push_back(std::move(grid));
    return static_cast<Index>(grids.size() - 1);
}

GridMedium MediumReader::uniform_grid(ParameterReader& r, const Transform& world_from_medium) {
    GridMedium m;
    m.box = box(r, world_from_medium);
    const std::array<int, 3> size = grid_size(r);
    std::optional<ScalarGrid> density = scalar_grid(r, "density", size);
    if (!density) r.error("medium 'uniformgrid' needs a parameter 'float density'");
    m.density = add(std::move(*density));
    if (std::optional<ScalarGrid> temperature = scalar_grid(r, "temperature", size))
        m.temperature = add(std::move(*temperature));
    if (std::optional<ScalarGrid> factors = scalar_grid(r, "Lescale", size))
        m.le_grid = add(std::move(*factors));
    m.temperature_offset = r.number("temperaturecutoff", 0);
    m.temperature_offset = r.number("temperatureoffset", m.temperature_offset);
    m.temperature_scale = r.number("temperaturescale", 1);
    m.sigma_a = coefficient(r, "sigma_a");
    m.sigma_s = coefficient(r, "sigma_s");
    m.scale = not_negative(r, "scale", 1);
    if (const auto le = emission(r)) {
        if (m.temperature != no_index)
            r.error("Le", "'Le' together with 'temperature'; expected one or the other");
        m.le = le->first;
        m.le_scale = le->second;
    }
    m.phase = phase_function(r);
    return m;
}

Index MediumReader::color_grid(ParameterReader& r, std::string_view name, std::array<int, 3> size) {
    const Parameter* p = r.any(name, {ParameterType::rgb});
    if (p == nullptr || p->numbers.empty()) return no_index;
    if (p->numbers.size() % 3 != 0)
        r.error(name, "parameter " + in_quotes(name) + " has " + std::to_string(p->numbers.size()) +
                          " numbers; expected a multiple of 3 (R G B)");
    check_count(r, name, p->numbers.size() / 3, size);
    const RgbColorSpace& space = p->color_space != nullptr ? *p->color_space : RgbColorSpace::srgb();
    ColorGrid grid;
    grid.size = size;
    grid.space = &space;
    grid.values.reserve(p->numbers.size() / 3);
    grid.colors.reserve(p->numbers.size() / 3);
    for (std::size_t i = 0; i < p->numbers.size(); i += 3) {
        const Vec3f rgb(p->numbers[i], p->numbers[i + 1], p->numbers[i + 2]);
        if (!(rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0))
            r.error(name, "parameter " + in_quotes(name) + " has a negative component");
        grid.values.push_back(RgbUnboundedSpectrum(space, rgb));
        grid.colors.push_back(rgb);
    }
    std::vector<ColorGrid>& grids = builder_.scene().color_grids;
    grids.push_back(std::move(grid));
    return static_cast<Index>(grids.size() - 1);
}

RgbGridMedium MediumReader::rgb_grid(ParameterReader& r, const Transform& world_from_medium) {
    RgbGridMedium m;
    m.box = box(r, world_from_medium);
    const std::array<int, 3> size = grid_size(r);
    m.sigma_a = color_grid(r, "sigma_a", size);
    m.sigma_s = color_grid(r, "sigma_s", size);
    if (m.sigma_a == no_index && m.sigma_s == no_index)
        r.error("medium 'rgbgrid' needs a parameter 'rgb sigma_a' or 'rgb sigma_s'");
    m.le = color_grid(r, "Le", size);
    if (m.le != no_index && m.sigma_a == no_index)
        r.error("Le", "medium 'rgbgrid' needs a parameter 'rgb sigma_a' beside 'Le'");
    m.scale = not_negative(r, "scale", 1);
    m.le_scale = not_negative(r, "Lescale", 1);
    m.phase = phase_function(r);
    return m;
}

CloudMedium MediumReader::cloud(ParameterReader& r, const Transform& world_from_medium) {
    CloudMedium m;
    m.box = box(r, world_from_medium);
    m.sigma_a = coefficient(r, "sigma_a");
    m.sigma_s = coefficient(r, "sigma_s");
    m.density = not_negative(r, "density", 1);
    m.wispiness = not_negative(r, "wispiness", 1);
    m.frequency = r.number("frequency", 5);
    m.phase = phase_function(r);
    return m;
}

Index MediumReader::add(SparseGrid grid) {
    std::vector<SparseGrid>& grids = builder_.scene().sparse_grids;
    grids.push_back(std::move(grid));
    return static_cast<Index>(grids.size() - 1);
}

SparseGridMedium MediumReader::nanovdb(ParameterReader& r, const Transform& world_from_medium) {
    SparseGridMedium m;
    check_transform(r, world_from_medium);
    const std::optional<std::string> name = r.string("filename");
    if (!name) r.error("medium 'nanovdb' needs a parameter 'string filename'");
    const Location at = r.at("filename");
    const std::filesystem::path path = files_.find(*name, at);
    const std::vector<std::uint8_t> bytes = files_.read(path, at);
    const std::string density_name = r.string("gridname", "density"),
                      temperature_name = r.string("temperaturename", "temperature");
    const bool names_temperature = r.any("temperaturename", {ParameterType::string}) != nullptr;
    PlacedSparseGrid density;
    std::optional<PlacedSparseGrid> temperature;
    try {
        const NanovdbFile file(bytes, path.string());
        density = file.read(density_name);
        density.grid.for_each_value([&](float v) {
            if (v < 0) throw Error(path.string() + ", grid '" + density_name + "'", "has a negative value");
        });
        if (density.grid.background() != 0)
            throw Error(path.string() + ", grid '" + density_name + "'",
                        "has a density other than 0 outside its voxels (its background)");
        if (names_temperature || file.contains(temperature_name)) temperature = file.read(temperature_name);
    } catch (const Error& e) {
        r.error("filename", e.what());
    }

    // Interpolation reaches one voxel beyond those that are not 0.
    const SparseGrid::VoxelRange voxels = density.grid.non_zero();
    for (int a = 0; a < 3 && !voxels.empty(); ++a) {
        const auto i = static_cast<std::size_t>(a);
        m.box.p0[a] = static_cast<float>(voxels.lower[i] - 1);
        m.box.p1[a] = static_cast<float>(voxels.upper[i] + 1);
    }
    m.box.world_from_medium = world_from_medium * density.file_from_grid;
    const auto check_place = [&](const Transform& t) {
        if (!fits_float(t))
            r.error("filename", path.string() + ": the transformation of a grid is beyond what "
                                                "single-precision numbers hold");
    };
    check_place(m.box.world_from_medium);
    m.density = add(std::move(density.grid));
    if (temperature) {
        m.temperature_space_from_density = temperature->file_from_grid.inverse() * density.file_from_grid;
        check_place(m.temperature_space_from_density);
        m.temperature = add(std::move(temperature->grid));
    }
    m.temperature_offset = r.number("temperaturecutoff", 0);
    m.temperature_offset = r.number("temperatureoffset", m.temperature_offset);
    m.temperature_scale = r.number("temperaturescale", 1);
    m.le_scale = not_negative(r, "Lescale", 1);
    std::tie(m.sigma_a, m.sigma_s) = coefficients(r);
    m.scale = not_negative(r, "scale", 1);
    m.phase = phase_function(r);
    return m;
}

Index MediumReader::read(const ParameterList& parameters, const Transform& world_from_medium,
                         const RgbColorSpace& color_space, Location at) {
    const std::optional<std::string> type =
        ParameterReader(parameters, "medium", at, diagnostics_).string("type");
    if (!type) diagnostics_.error(at, "the medium needs a parameter 'string type'");
    ParameterReader r(parameters, "medium " + in_quotes(*type), at, diagnostics_);
    r.ignored("type");
    Medium medium;
    if (*type == "homogeneous") {
        medium = homogeneous(r);
    } else if (*type == "uniformgrid") {
        medium = uniform_grid(r, world_from_medium);
    } else if (*type == "rgbgrid") {
        RgbGridMedium m = rgb_grid(r, world_from_medium);
        m.illuminant = builder_.add_spectrum(Spectrum(color_space.illuminant()));
        medium = m;
    } else if (*type == "cloud") {
        medium = cloud(r, world_from_medium);
    } else if (*type == "nanovdb") {
        medium = nanovdb(r, world_from_medium);
    } else {
        r.error("type", "unknown medium " + in_quotes(*type) + plugin_suggestion("MakeNamedMedium", *type));
    }
    r.finish();
    builder_.scene().media.push_back(medium);
    return static_cast<Index>(builder_.scene().media.size() - 1);
}

} // namespace montelux::pbrt
