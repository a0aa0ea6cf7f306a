#include "python/src/bindings.h"
#include "python/src/names.h"
#include "python/src/scene_values.h"
#include <algorithm>
#include <string>
#include <vector>

#include "montelux/film/spectral_buckets.h"
#include "montelux/image/image.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/spectrum/camera_sensors.h"

namespace montelux::python {
namespace {

constexpr Names<LightGrouping, 2> light_groupings{
    "light_grouping", {{{"light", LightGrouping::light}, {"kind", LightGrouping::kind}}}};

void set_resolution(FilmSettings& f, std::int64_t w, std::int64_t h) {
    // The crop keeps its place on the film.
    auto scaled = [](int v, int from, std::int64_t to) {
        return static_cast<int>(std::int64_t{v} * to / from);
    };
    PixelBounds b{scaled(f.crop.x0, f.width, w), scaled(f.crop.y0, f.height, h),
                  scaled(f.crop.x1, f.width, w), scaled(f.crop.y1, f.height, h)};
    b.x1 = std::max(b.x1, b.x0 + 1);
    b.y1 = std::max(b.y1, b.y0 + 1);
    f.crop = b;
    f.width = static_cast<int>(w);
    f.height = static_cast<int>(h);
}

void bind_spectral(nb::module_& m) {
    auto c = value_class<SpectralSettings>(
        m, "Spectral", "Radiance in equal buckets of wavelengths, beside the colours of a picture.");
    attribute<SpectralSettings>(
        c, "buckets", "int", [](const SpectralSettings& s, const auto&) { return nb::int_(s.buckets); },
        [](SpectralSettings& s, nb::handle v, auto&, const std::string& what) {
            s.buckets = static_cast<int>(whole_number_of(v, 1, SpectralSettings::most_buckets, what));
        },
        "How many.");
    auto end = [&](const char* name, float SpectralSettings::*member, const char* expected, const char* doc) {
        attribute<SpectralSettings>(
            c, name, "float",
            [member](const SpectralSettings& s, const auto&) {
                return nb::float_(static_cast<double>(s.*member));
            },
            [member, expected](SpectralSettings& s, nb::handle v, auto&, const std::string& what) {
                s.*member = static_cast<float>(number_of(v, what));
                if (!(s.lambda_min >= lambda_min && s.lambda_min < s.lambda_max &&
                      s.lambda_max <= lambda_max))
                    throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected " + expected);
            },
            doc);
    };
    end("lambda_min", &SpectralSettings::lambda_min, "360 nm or more, and less than lambda_max",
        "Where the first begins, in nm.");
    end("lambda_max", &SpectralSettings::lambda_max, "830 nm or less, and more than lambda_min",
        "Where the last ends, in nm.");
    c.def_prop_ro(
        "wavelengths",
        [](const Ref<SpectralSettings>& r) {
            const BucketLayout layout(r.value());
            std::vector<double> centres;
            for (int i = 0; i < layout.count(); ++i) centres.push_back(static_cast<double>(layout.center(i)));
            return new_array(centres);
        },
        "The centres of the buckets in nm, shape (buckets,).");
}

} // namespace

void bind_film(nb::module_& m) {
    bind_spectral(m);
    auto c = value_class<FilmSettings>(m, "Film", "Resolution, crop, pixel filter and sensor.");
    attribute<FilmSettings>(
        c, "resolution", "tuple[int, int]",
        [](const FilmSettings& f, const auto&) { return nb::make_tuple(f.width, f.height); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> r = numbers_of(v, 2, what);
            for (const double n : r)
                if (!(n >= 1 && n <= Image::max_dimension && n == std::floor(n)))
                    throw Error(what, std::string(nb::repr(v).c_str()) +
                                          " was given; expected two whole numbers from 1 to " +
                                          std::to_string(Image::max_dimension));
            set_resolution(f, static_cast<std::int64_t>(r[0]), static_cast<std::int64_t>(r[1]));
        },
        "Width and height in pixels; a crop keeps its place.");
    auto side = [&](const char* name, int FilmSettings::*member, bool width, const char* doc) {
        attribute<FilmSettings>(
            c, name, "int", [member](const FilmSettings& f, const auto&) { return nb::int_(f.*member); },
            [width](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
                const std::int64_t n = whole_number_of(v, 1, Image::max_dimension, what);
                set_resolution(f, width ? n : f.width, width ? f.height : n);
            },
            doc);
    };
    side("width", &FilmSettings::width, true, "Pixels of a row of the whole film.");
    side("height", &FilmSettings::height, false, "Rows of the whole film.");
    attribute<FilmSettings>(
        c, "crop", "tuple[int, int, int, int]",
        [](const FilmSettings& f, const auto&) {
            return nb::make_tuple(f.crop.x0, f.crop.y0, f.crop.x1, f.crop.y1);
        },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> b = numbers_of(v, 4, what);
            if (!(b[0] >= 0 && b[0] < b[2] && b[2] <= f.width && b[1] >= 0 && b[1] < b[3] &&
                  b[3] <= f.height))
                throw Error(what,
                            "expected pixels x0, y0, x1, y1 with 0 <= x0 < x1 <= " + std::to_string(f.width) +
                                " and 0 <= y0 < y1 <= " + std::to_string(f.height));
            f.crop = {static_cast<int>(b[0]), static_cast<int>(b[1]), static_cast<int>(b[2]),
                      static_cast<int>(b[3])};
        },
        "The pixels that are rendered: x0, y0, x1, y1 from the top left, the last two exclusive.");
    number(c, "iso", &FilmSettings::iso, positive, "a number above zero",
           "Sensitivity; 100 leaves values as they are.");
    number(c, "exposure_time", &FilmSettings::exposure_time, positive, "a number above zero", "Seconds.");
    // The bound of scene files: daylight is not defined far below it.
    number(
        c, "white_balance", &FilmSettings::white_balance,
        [](double x) { return x == 0 || (x >= 2000 && std::isfinite(static_cast<float>(x))); },
        "0 (none) or a temperature of 2000 K or more",
        "Kelvin of the light that is to look white; 0: none, or 6500 K for a camera's sensor.");
    attribute<FilmSettings>(
        c, "sensor", "str", [](const FilmSettings& f, const auto&) { return nb::str(f.sensor.c_str()); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            if (!nb::isinstance<nb::str>(v))
                throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a name");
            const auto name = nb::cast<std::string>(v);
            const std::vector<std::string_view>& names = sensor_names();
            if (std::find(names.begin(), names.end(), name) == names.end())
                throw Error(what, "unknown sensor '" + name + "'" + did_you_mean(name, names));
            f.sensor = name;
        },
        "The sensor by its name in pbrt-v4, such as \"nikon_d850\"; \"cie1931\" is the standard observer.");
    optional_part(
        c, "spectral", &FilmSettings::spectral, "Spectral",
        "Buckets of wavelengths: pictures have the layers 'spectral' and 'spectral_standard_error', of "
        "shape (h, w, buckets); None: colours alone.");
    number(
        c, "max_component_value", &FilmSettings::max_component_value, [](double x) { return x > 0; },
        "a number above zero", "Largest RGB value of a sample; infinite: none.");
    attribute<FilmSettings>(
        c, "layers", "str",
        [](const FilmSettings& f, const auto&) { return nb::cast(text_of(f.layers.set)); },
        [](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
            std::string list;
            if (!nb::try_cast(v, list))
                throw Error(what,
                            std::string(nb::repr(v).c_str()) + " was given; expected names with commas");
            try {
                f.layers.set = parse_layers(list);
            } catch (const Error& e) {
                throw Error(what, e.what());
            }
        },
        "Names of the layers of a picture with commas, as of `montelux render --layers`: "
        "'default,position'.");
    choice(
        c, "light_grouping", [](auto& f) -> auto& { return f.layers.light_grouping; }, light_groupings,
        "With the layer 'light-groups': lights that a scene file puts into no group form one each ('light'), "
        "or one "
        "of each kind ('kind').");
    auto flag = [&](const char* name, bool LayerSettings::*member, const char* doc) {
        attribute<FilmSettings>(
            c, name, "bool",
            [member](const FilmSettings& f, const auto&) { return nb::cast(f.layers.*member); },
            [member](FilmSettings& f, nb::handle v, auto&, const std::string& what) {
                if (!nb::isinstance<nb::bool_>(v))
                    throw Error(what,
                                std::string(nb::repr(v).c_str()) + " was given; expected True or False");
                f.layers.*member = nb::cast<bool>(v);
            },
            doc);
    };
    flag("layers_in_camera_space", &LayerSettings::in_camera_space,
         "Positions and normals of the layers are those of the camera, not of the world.");
    flag("half", &LayerSettings::half, "EXR files hold 16-bit floats where those suffice.");
    c.def_prop_rw(
        "filter",
        [](const Ref<FilmSettings>& r) {
            return as_python(
                Slot<PixelFilter>(r, std::function<PixelFilter&(FilmSettings&)>(&FilmSettings::filter)));
        },
        [](Ref<FilmSettings>& r, const nb::object& o) {
            const Slot<PixelFilter>* given = filter_slot(o);
            if (!given) throw Error("Film.filter", "expected a pixel filter, such as GaussianFilter()");
            const PixelFilter filter = given->read();
            r.edit([&](FilmSettings& f) { f.filter = filter; });
        },
        "The pixel filter.");
}

} // namespace montelux::python
