#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/names.h"
#include "python/src/numpy_bridge.h"
#include "python/src/warp.h"
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/scene/light/environment/environment_sampler.h"
#include "montelux/scene/setting_names.h"

namespace montelux::python {
namespace {

constexpr Names<EnvironmentSampling, 4> map_samplings{"EnvironmentSampler, sampling",
                                                      environment_sampling_names};

// A map, and the method to sample it.
struct SampledMap {
    Image map; // R, G, B
    EnvironmentSampler sampler;

    SampledMap(Image image, EnvironmentLayout layout, const EnvironmentSettings& settings)
        : map(std::move(image)), sampler(map, layout, settings) {}
    const EnvironmentGrid& grid() const { return sampler.grid(); }
    std::size_t height() const { return static_cast<std::size_t>(grid().height()); }
    std::size_t width() const { return static_cast<std::size_t>(grid().width()); }
};

// Directions of any length, normalised.
std::vector<Vec3f> directions_of(const Rows& given, const std::string& what) {
    std::vector<Vec3f> w;
    for (std::size_t i = 0; i < given.count(); ++i) {
        const Vec3d d = three(given[i]);
        const double l = length(d);
        if (!(l > 0 && std::isfinite(l)))
            throw Error(what, "expected directions that are neither zero nor infinite");
        w.push_back(Vec3f(d / l));
    }
    return w;
}

// Positions on the map in pixels, which must be within it.
std::vector<Vec2d> places_of(const SampledMap& m, const Rows& given, const std::string& what) {
    const auto right = static_cast<double>(m.width()), bottom = static_cast<double>(m.height());
    std::vector<Vec2d> places;
    for (std::size_t i = 0; i < given.count(); ++i) {
        const double x = given[i][0], y = given[i][1];
        if (!(x >= 0 && x <= right && y >= 0 && y <= bottom))
            throw Error(what, "the place (" + std::to_string(x) + ", " + std::to_string(y) +
                                  ") was given; expected places within (" + std::to_string(m.width()) + ", " +
                                  std::to_string(m.height()) + ")");
        places.push_back({x, y});
    }
    return places;
}

nb::tuple sample_map(const SampledMap& m, const nb::object& numbers) {
    const Rows u(numbers, 2, "EnvironmentSampler.sample");
    require_uniform(u.numbers.values, "EnvironmentSampler.sample");
    NewArray directions = new_array(u.shape(3)), densities = new_array(u.shape());
    {
        nb::gil_scoped_release unlocked;
        auto below_one = [](double v) { return std::min(static_cast<float>(v), largest_below_one<float>); };
        for (std::size_t i = 0; i < u.count(); ++i) {
            const EnvironmentPoint p = m.sampler.sample({below_one(u[i][0]), below_one(u[i][1])});
            put(Vec3d(m.grid().direction(p.grid)), directions.data + 3 * i);
            densities.data[i] = static_cast<double>(p.pdf);
        }
    }
    return nb::make_tuple(directions.array, densities.array);
}

// `count` numbers for each direction, or one without a dimension of its own: of(position on the map, out).
template <typename Of>
DoubleArray of_directions(const SampledMap& m, const nb::object& given, const std::string& name,
                          std::optional<std::size_t> count, const Of& of) {
    const std::string what = "EnvironmentSampler." + name;
    const Rows w(given, 3, what);
    const std::vector<Vec3f> unit = directions_of(w, what);
    NewArray out = new_array(count ? w.shape(*count) : w.shape());
    {
        nb::gil_scoped_release unlocked;
        for (std::size_t i = 0; i < unit.size(); ++i)
            of(m.grid().locate(unit[i]), out.data + i * count.value_or(1));
    }
    return out.array;
}

DoubleArray pdf(const SampledMap& m, const nb::object& directions) {
    return of_directions(m, directions, "pdf", std::nullopt,
                         [&](Vec2f place, double* out) { *out = static_cast<double>(m.sampler.pdf(place)); });
}

DoubleArray radiance(const SampledMap& m, const nb::object& directions) {
    return of_directions(m, directions, "radiance", 3, [&](Vec2f place, double* out) {
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<double>(m.map.f32()[3 * m.grid().texel(place) + c]);
    });
}

DoubleArray locate(const SampledMap& m, const nb::object& directions) {
    return of_directions(m, directions, "locate", 2,
                         [](Vec2f place, double* out) { put(Vec2d(place), out); });
}

DoubleArray direction(const SampledMap& m, const nb::object& given) {
    const Rows p(given, 2, "EnvironmentSampler.direction");
    const std::vector<Vec2d> places = places_of(m, p, "EnvironmentSampler.direction");
    NewArray out = new_array(p.shape(3));
    for (std::size_t i = 0; i < places.size(); ++i)
        put(Vec3d(m.grid().direction(places[i])), out.data + 3 * i);
    return out.array;
}

DoubleArray solid_angles(const SampledMap& m) {
    const std::size_t shape[] = {m.height(), m.width()};
    NewArray out = new_array(shape);
    for (std::size_t y = 0; y < m.height(); ++y)
        std::fill_n(out.data + y * m.width(), m.width(), m.grid().solid_angle(static_cast<int>(y)));
    return out.array;
}

[[noreturn]] void no_parts(const SampledMap& m, const char* what, const char* expected) {
    throw Error(std::string("EnvironmentSampler.") + what, "the sampling '" +
                                                               std::string(name_of(m.sampler.sampling())) +
                                                               "' has none; expected " + expected);
}

constexpr const char* either = "'median-cut' or 'structured'";

IndexArray labels(const SampledMap& m) {
    const auto* regions = m.sampler.median_cut();
    const auto* strata = m.sampler.structured();
    if (!regions && !strata) no_parts(m, "labels", either);
    const std::size_t shape[] = {m.height(), m.width()};
    NewIndexArray out = new_index_array(shape);
    for (std::size_t y = 0; y < m.height(); ++y)
        for (std::size_t x = 0; x < m.width(); ++x) {
            const Vec2f middle{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            std::int64_t& label = out.data[y * m.width() + x] = -1;
            if (regions) {
                if (regions->pdf(middle) > 0) label = static_cast<std::int64_t>(regions->region_of(middle));
            } else if (const std::uint32_t s = strata->stratum_of(middle);
                       s != StructuredEnvironment::no_stratum) {
                label = s;
            }
        }
    return out.array;
}

DoubleArray centres(const SampledMap& m) {
    std::vector<double> places;
    if (const auto* cut = m.sampler.median_cut()) {
        for (const auto& r : cut->regions()) {
            places.push_back(0.5 * (double(r.x0) + double(r.x1)));
            places.push_back(m.grid().line_below(0.5 * (r.share0 + r.share1)));
        }
    } else if (const auto* strata = m.sampler.structured()) {
        for (std::size_t s = 0; s < strata->strata(); ++s) {
            const Vec2f centre = strata->centre_of(s);
            places.push_back(static_cast<double>(centre.x));
            places.push_back(static_cast<double>(centre.y));
        }
    } else {
        no_parts(m, "centres", either);
    }
    return new_array(places, places.size() / 2, 2);
}

DoubleArray regions(const SampledMap& m) {
    const auto* cut = m.sampler.median_cut();
    if (!cut) no_parts(m, "regions", "'median-cut'");
    std::vector<double> edges;
    for (const auto& r : cut->regions())
        for (const float edge : {r.x0, r.x1, r.y0, r.y1}) edges.push_back(static_cast<double>(edge));
    return new_array(edges, edges.size() / 4, 4);
}

IndexArray levels(const SampledMap& m) {
    const auto* strata = m.sampler.structured();
    if (!strata) no_parts(m, "levels", "'structured'");
    const std::size_t shape[] = {strata->strata()};
    NewIndexArray out = new_index_array(shape);
    for (std::size_t s = 0; s < strata->strata(); ++s) out.data[s] = strata->level_of(s);
    return out.array;
}

} // namespace

void bind_environments(nb::module_& m) {
    nb::class_<SampledMap>(
        m, "EnvironmentSampler",
        "Directions drawn to an environment map, as renders draw them (docs/environment-light.md).\n\n"
        "image: a file, or an array of shape (height, width, 3), linear. layout: 'equirectangular' "
        "(latitude-longitude), 'equal-area' (square, octahedral), or 'auto', by the shape. sampling: 'auto', "
        "'tabulated', 'median-cut' or 'structured'. compensation: leaves out what BSDF sampling finds as "
        "well; the density is then zero where there is light, so that samples of a BSDF have to be joined "
        "with these. parts: regions of 'median-cut' (a power of two) or strata of 'structured' (about so "
        "many); 0: as many as renders take.\n\n"
        "Directions are unit vectors in the space of the map: rows go from +z to -z, columns from +x by way "
        "of +y; the centre of an equal-area map is +z. Densities are per steradian. Radiance is that of the "
        "nearest texel.")
        .def(
            "__init__",
            [](SampledMap* self, const nb::object& image, const std::string& layout,
               const std::string& sampling, bool compensation, int parts) {
                Image map = light_map(image, "EnvironmentSampler");
                const EnvironmentLayout known = map_layout(layout, map, "EnvironmentSampler");
                const EnvironmentSettings settings{
                    .sampling = map_samplings.value(sampling), .compensated = compensation, .parts = parts};
                new (self) SampledMap(std::move(map), known, settings);
            },
            "image"_a, nb::kw_only(), "layout"_a = "auto", "sampling"_a = "auto", "compensation"_a = false,
            "parts"_a = 0)
        .def("sample", &sample_map, "u"_a,
             nb::sig("def sample(self, u: object) -> tuple[numpy.typing.NDArray[numpy.float64], "
                     "numpy.typing.NDArray[numpy.float64]]"),
             "Directions of shape (n, 3) and the densities that they were drawn with, shape (n,), for "
             "uniform numbers u of shape (n, 2).")
        .def("pdf", &pdf, "directions"_a, "Density of directions of shape (n, 3): shape (n,).")
        .def("radiance", &radiance, "directions"_a,
             "R, G, B of the map in directions of shape (n, 3): shape (n, 3).")
        .def("locate", &locate, "directions"_a,
             "Places on the map of directions of shape (n, 3): shape (n, 2), x and y in pixels. Within a "
             "pixel equal areas are equal solid angles.")
        .def("direction", &direction, "places"_a,
             "Directions of places on the map, shape (n, 2), x and y in pixels: shape (n, 3).")
        .def_prop_ro(
            "sampling", [](const SampledMap& s) { return std::string(name_of(s.sampler.sampling())); },
            "'tabulated', 'median-cut' or 'structured'.")
        .def_prop_ro(
            "layout", [](const SampledMap& s) { return std::string(name_of(s.grid().layout())); },
            "'equirectangular' or 'equal-area'.")
        .def_prop_ro(
            "compensated", [](const SampledMap& s) { return s.sampler.compensated(); },
            "Whether the density was compensated: never of maps that are nearly constant.")
        .def_prop_ro(
            "mean_radiance", [](const SampledMap& s) { return s.sampler.mean_radiance(); },
            "Mean of R, G and B over the sphere.")
        .def_prop_ro(
            "sun_share", [](const SampledMap& s) { return s.sampler.sun() ? s.sampler.sun()->share() : 0.0; },
            "Of the samples, those that go to a sun, which 'median-cut' and 'structured' sample by itself; 0 "
            "without one.")
        .def_prop_ro("solid_angles", &solid_angles, "Of each pixel, in steradians, shape (height, width).")
        .def_prop_ro("labels", &labels,
                     "The region or stratum that the middle of each pixel lies in, shape (height, width); -1 "
                     "in none.")
        .def_prop_ro(
            "centres", &centres,
            "Of 'median-cut' the middles of the regions, of 'structured' the points that strata grew "
            "from: shape (n, 2), x and y in pixels.")
        .def_prop_ro("regions", &regions,
                     "Edges x0, x1, y0, y1 of the regions of 'median-cut' in pixels, shape (n, 4).")
        .def_prop_ro("levels", &levels,
                     "Of each stratum of 'structured' the threshold that it lies above, in standard "
                     "deviations of radiance, shape (n,).")
        .def("__repr__", [](const SampledMap& s) {
            return nb::str(("<montelux.EnvironmentSampler " + s.sampler.description() + ">").c_str());
        });
}

} // namespace montelux::python
