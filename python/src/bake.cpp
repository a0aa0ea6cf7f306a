#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/names.h"
#include "python/src/warp.h"
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "montelux/bake/brdf_table.h"
#include "montelux/bake/prefilter.h"
#include "montelux/bake/split_sum_report.h"

namespace montelux::python {
namespace {

constexpr Names<BrdfTableExtra, 3> blues{"bake.brdf_table, blue",
                                         {{{"zero", BrdfTableExtra::zero},
                                           {"sheen", BrdfTableExtra::sheen},
                                           {"average-albedo", BrdfTableExtra::average_albedo}}}};
constexpr Names<PrefilterSampling, 2> prefilter_samplings{
    "bake.environment, sampling", {{{"cells", PrefilterSampling::cells}, {"lobe", PrefilterSampling::lobe}}}};
constexpr Names<bool, 2> up_axes{"bake, up", {{{"y", false}, {"z", true}}}};
constexpr Names<RoughnessRule, 3> roughness_rules{"bake.environment, roughness",
                                                  {{{"linear", RoughnessRule::linear},
                                                    {"filament", RoughnessRule::filament},
                                                    {"babylon", RoughnessRule::babylon}}}};

// Runs a bake with Python's lock released; Ctrl-C ends it.
class Interruptible {
  public:
    const CancelFlag* cancel() const { return &cancel_; }
    std::function<void(double)> progress() {
        return [this](double) {
            nb::gil_scoped_acquire lock;
            if (!cancel_.requested() && PyErr_CheckSignals() != 0) cancel_.request();
        };
    }
    template <typename F>
    auto run(const F& bake) {
        auto result = [&] {
            nb::gil_scoped_release unlocked;
            return bake();
        }();
        if (cancel_.requested()) throw nb::python_error();
        return result;
    }

  private:
    CancelFlag cancel_;
};

// Orientation of a cube map in the world, named as the options of `montelux bake`.
CubeFrame frame_of(std::string_view up, bool mirror, double turn) {
    if (!std::isfinite(turn)) throw Error("bake, turn", "expected a number of degrees");
    return {up_axes.value(up), mirror, turn};
}

EnvironmentMap map_of(const nb::object& image, std::string_view layout, const std::string& what) {
    const Image map = light_map(image, what);
    return {map, map_layout(layout, map, what)};
}

nb::object shared_channels(Image image, int first, int count) {
    return channels_of(std::make_shared<const Image>(std::move(image)), first, count);
}

nb::tuple scale_and_bias(int size, std::string_view blue) {
    Interruptible work;
    BrdfTableSettings settings{size, blues.value(blue), work.cancel(), work.progress()};
    const auto made = std::make_shared<const Image>(work.run([&] { return brdf_table(settings); }));
    return nb::make_tuple(channels_of(made, 0, 3), channels_of(made, 3, 3));
}

nb::list faces(const CubeMap& cube) {
    nb::list six;
    for (const Image& face : cube.faces) six.append(shared_channels(face, 0, 3));
    return six;
}

DoubleArray face_directions(int size) {
    if (size < 1 || size > Image::max_dimension)
        throw Error("bake.face_directions", "faces of " + std::to_string(size) + " texels; expected 1 to " +
                                                std::to_string(Image::max_dimension));
    const auto n = static_cast<std::size_t>(size);
    const std::size_t shape[] = {cube_faces, n, n, 3};
    NewArray out = new_array(shape);
    double* next = out.data;
    for (int face = 0; face < cube_faces; ++face)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x, next += 3) put(cube_texel_direction({face, x, y}, size), next);
    return out.array;
}

DoubleArray to_map(const nb::object& directions, std::string_view up, bool mirror, double turn) {
    const CubeFrame frame = frame_of(up, mirror, turn);
    const Rows given(directions, 3, "bake.to_map");
    NewArray out = new_array(given.numbers.shape);
    for (std::size_t i = 0; i < given.count(); ++i) put(frame.to_map(three(given[i])), out.data + 3 * i);
    return out.array;
}

using Roughness = std::variant<std::string, std::vector<double>>;

std::vector<double> roughness_of(const Roughness& given, std::optional<int> levels, int size) {
    if (const auto* rule = std::get_if<std::string>(&given))
        return roughness_by_rule(roughness_rules.value(*rule), levels, size);
    const auto& list = std::get<1>(given);
    if (levels && *levels != static_cast<int>(list.size()))
        throw Error("bake.environment, levels", std::to_string(*levels) + " levels and " +
                                                    std::to_string(list.size()) +
                                                    " values of roughness do not go together");
    return list;
}

nb::tuple prefiltered(const nb::object& image, const std::string& layout, const std::string& up, bool mirror,
                      double turn, int size, std::optional<int> levels, const Roughness& roughness,
                      const std::string& sampling, bool source_mips, std::optional<double> target_error,
                      std::optional<std::uint64_t> samples, std::optional<std::uint64_t> samples_max,
                      double dark_floor, std::uint64_t seed) {
    Interruptible work;
    BakeSettings settings;
    settings.sampling = prefilter_samplings.value(sampling);
    if (source_mips && settings.sampling != PrefilterSampling::lobe)
        throw Error("bake.environment, source_mips", "needs sampling='lobe'; cells do without");
    settings.source_mips = source_mips;
    if (samples && (target_error || samples_max))
        throw Error("bake.environment, samples", "does not go with target_error and samples_max");
    if (samples)
        settings.target_error.reset();
    else
        settings.target_error = target_error.value_or(0.01);
    settings.samples = samples ? *samples : samples_max.value_or(settings.samples);
    settings.dark_floor = dark_floor;
    settings.seed = seed;
    settings.frame = frame_of(up, mirror, turn);
    settings.cancel = work.cancel();
    settings.progress = work.progress();
    const std::vector<double> steps = roughness_of(roughness, levels, size);
    const EnvironmentMap map = map_of(image, layout, "bake.environment");
    const BakedCubes baked = work.run([&] { return prefilter_environment(map, size, steps, settings); });
    nb::list all;
    for (std::size_t i = 0; i < baked.levels.size(); ++i) {
        const LevelReport& l = baked.levels[i];
        nb::dict level;
        level["size"] = l.size;
        level["roughness"] = l.roughness;
        level["samples"] = l.samples;
        level["missed"] = l.missed;
        level["mean_error"] = l.mean_error;
        level["largest_error"] = l.largest_error;
        level["faces"] = faces(baked.value.levels[i]);
        level["errors"] = faces(baked.standard_error.levels[i]);
        all.append(level);
    }
    return nb::tuple(all);
}

nb::tuple split_sum(const nb::object& image, const std::string& layout, const std::string& up, bool mirror,
                    double turn, std::optional<std::vector<double>> roughness,
                    std::optional<std::vector<double>> n_dot_v, std::optional<std::vector<double>> f0,
                    int orientations, int sphere_size, double sphere_f0, double target_error,
                    std::uint64_t samples_max, std::uint64_t seed) {
    Interruptible work;
    SplitSumSettings settings;
    if (roughness) settings.roughness = *roughness;
    if (n_dot_v) settings.n_dot_v = *n_dot_v;
    if (f0) settings.f0 = *f0;
    settings.orientations = orientations;
    settings.sphere_size = sphere_size;
    settings.sphere_f0 = sphere_f0;
    settings.target_error = target_error;
    settings.samples_max = samples_max;
    settings.seed = seed;
    settings.frame = frame_of(up, mirror, turn);
    settings.cancel = work.cancel();
    settings.progress = work.progress();
    const EnvironmentMap map = map_of(image, layout, "bake.report");
    SplitSumReport found = work.run([&] { return split_sum_report(map, settings); });
    nb::list rows;
    for (const SplitSumRow& r : found.rows)
        rows.append(nb::make_tuple(r.roughness, r.n_dot_v, r.f0, r.full, r.bias, r.bias_error, r.rms));
    nb::object spheres = nb::none(), errors = nb::none();
    if (!found.spheres.empty()) {
        const auto picture = std::make_shared<const Image>(std::move(found.spheres));
        spheres = channels_of(picture, 0, 3);
        errors = channels_of(picture, 3, 3);
    }
    return nb::make_tuple(settings.roughness, rows, spheres, errors);
}

} // namespace

void bind_bake(nb::module_& m) {
    m.def("bake_brdf_table", &scale_and_bias, "size"_a, "blue"_a,
          "montelux.bake.brdf_table: values and errors, each of shape (size, size, 3).");
    m.def("bake_environment", &prefiltered, "image"_a, nb::kw_only(), "layout"_a, "up"_a, "mirror"_a,
          "turn"_a, "size"_a, "levels"_a.none(), "roughness"_a, "sampling"_a, "source_mips"_a,
          "target_error"_a.none(), "samples"_a.none(), "samples_max"_a.none(), "dark_floor"_a, "seed"_a,
          "montelux.bake.environment: a dictionary a level.");
    m.def("bake_face_directions", &face_directions, "size"_a,
          "montelux.bake.face_directions: shape (6, size, size, 3).");
    m.def("bake_to_map", &to_map, "directions"_a, "up"_a, "mirror"_a, "turn"_a, "montelux.bake.to_map.");
    m.def("bake_report", &split_sum, "image"_a, nb::kw_only(), "layout"_a, "up"_a, "mirror"_a, "turn"_a,
          "roughness"_a.none(), "n_dot_v"_a.none(), "f0"_a.none(), "orientations"_a, "sphere_size"_a,
          "sphere_f0"_a, "target_error"_a, "samples_max"_a, "seed"_a,
          "montelux.bake.report: roughness, rows, the picture of spheres and its errors.");
}

} // namespace montelux::python
