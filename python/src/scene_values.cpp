#include "python/src/scene_values.h"

#include "python/src/bindings.h"

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/emission.h"
#include "montelux/spectrum/named_spectra.h"

namespace montelux::python {
namespace {

std::string type_of(nb::handle v) { return nb::type_name(v.type()).c_str(); }

Vec3f to_rgb(const Spectrum& s) { return Vec3f(RgbColorSpace::srgb().rgb_from_xyz() * to_xyz(s)); }

std::string spectrum_text(const Spectrum& s) {
    char text[96];
    if (s.is_constant()) {
        std::snprintf(text, sizeof text, "Spectrum(%.9g)", static_cast<double>(s(550)));
    } else if (const auto* b = std::get_if<BlackbodySpectrum>(&s.kind())) {
        std::snprintf(text, sizeof text, "Spectrum.blackbody(%.9g)", static_cast<double>(b->temperature()));
    } else {
        const Vec3f c = to_rgb(s);
        std::snprintf(text, sizeof text, "<Spectrum of linear sRGB (%.4g, %.4g, %.4g)>",
                      static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z));
    }
    return text;
}

RgbMeaning meaning_of(const std::string& name) {
    if (name == "albedo") return RgbMeaning::albedo;
    if (name == "unbounded") return RgbMeaning::unbounded;
    if (name == "illuminant") return RgbMeaning::illuminant;
    throw Error("Spectrum.rgb",
                "there is no meaning '" + name + "'; expected albedo, unbounded or illuminant");
}

Spectrum rgb(Vec3f c, RgbMeaning meaning, const std::string& what) {
    const RgbColorSpace& space = RgbColorSpace::srgb();
    if (meaning == RgbMeaning::albedo && (c.x > 1 || c.y > 1 || c.z > 1))
        throw Error(what, "a reflectance above 1 was given; expected numbers from 0 to 1");
    switch (meaning) {
    case RgbMeaning::albedo:
        return RgbAlbedoSpectrum(space, c);
    case RgbMeaning::unbounded:
        return RgbUnboundedSpectrum(space, c);
    default:
        return RgbIlluminantSpectrum(space, c);
    }
}

Spectrum tabulated_spectrum(const nb::object& wavelengths, const nb::object& values) {
    const Numbers l = numbers_of(wavelengths, "Spectrum.tabulated"),
                  v = numbers_of(values, "Spectrum.tabulated");
    const std::vector<float> lambda(l.values.begin(), l.values.end()),
        value(v.values.begin(), v.values.end());
    if (lambda.size() != value.size())
        throw Error("Spectrum.tabulated", "expected as many values as wavelengths");
    return Spectrum(PiecewiseLinear(lambda, value, SpectrumEnds::constant));
}

} // namespace

double number_of(nb::handle v, const std::string& what) {
    const double x = PyFloat_Check(v.ptr()) || PyLong_Check(v.ptr()) || PyNumber_Check(v.ptr())
                         ? PyFloat_AsDouble(v.ptr())
                         : std::numeric_limits<double>::quiet_NaN();
    if (PyErr_Occurred() || std::isnan(x)) {
        PyErr_Clear();
        throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a number");
    }
    return x;
}

std::vector<double> numbers_of(nb::handle v, std::size_t n, const std::string& what) {
    const Numbers given = numbers_of(v, what);
    if (given.values.size() != n || given.shape.size() != 1)
        throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected " + std::to_string(n) +
                              " numbers");
    for (const double x : given.values)
        if (!std::isfinite(x)) throw Error(what, "a number that is not finite was given");
    return {given.values.begin(), given.values.end()};
}

bool boolean_of(nb::handle v, const std::string& what) {
    if (v.is(Py_True)) return true;
    if (v.is(Py_False)) return false;
    throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected True or False");
}

std::int64_t whole_number_of(nb::handle v, std::int64_t least, std::int64_t most, const std::string& what) {
    const double x = number_of(v, what);
    if (!(x == std::floor(x) && x >= static_cast<double>(least) && x <= static_cast<double>(most)))
        throw Error(what, std::string(nb::repr(v).c_str()) + " was given; expected a whole number from " +
                              std::to_string(least) + " to " + std::to_string(most));
    return static_cast<std::int64_t>(x);
}

Spectrum spectrum_of(nb::handle v, RgbMeaning meaning, const std::string& what) {
    if (nb::isinstance<Spectrum>(v)) return nb::cast<Spectrum>(v);
    if (nb::isinstance<nb::str>(v)) {
        const auto name = nb::cast<std::string>(v);
        if (const std::optional<Spectrum> found = find_named_spectrum(name)) return *found;
        throw Error(what, "there is no spectrum '" + name + "' (did you mean '" +
                              std::string(nearest_spectrum_name(name)) + "'?)");
    }
    const bool one = PyNumber_Check(v.ptr()) && !PySequence_Check(v.ptr());
    if (!one && !PySequence_Check(v.ptr()))
        throw Error(what,
                    "an object of type '" + type_of(v) +
                        "' was given; expected a number, three numbers R, G and B, a name or a Spectrum");
    const std::vector<double> c = one ? std::vector<double>{number_of(v, what)} : numbers_of(v, 3, what);
    for (const double x : c)
        if (!(x >= 0 && std::isfinite(x)))
            throw Error(what, std::string(nb::repr(v).c_str()) +
                                  " was given; expected numbers that are not negative");
    if (one) {
        if (meaning == RgbMeaning::albedo && c[0] > 1)
            throw Error(what, "a reflectance above 1 was given; expected a number from 0 to 1");
        // A light with the spectrum of the film's white, in the units of RGB.
        if (meaning == RgbMeaning::illuminant) return rgb(Vec3f(Vec3d{c[0], c[0], c[0]}), meaning, what);
        return Spectrum(static_cast<float>(c[0]));
    }
    return rgb(Vec3f(Vec3d{c[0], c[1], c[2]}), meaning, what);
}

Transform transform_of(nb::handle v, const std::string& what) {
    if (v.is_none()) return {};
    const Numbers n = numbers_of(v, what);
    if (n.shape != std::vector<std::size_t>{4, 4}) throw Error(what, "expected a matrix of shape (4, 4)");
    Matrix4 m;
    for (std::size_t i = 0; i < 16; ++i) m.m[i / 4][i % 4] = n.values[i];
    const std::optional<Transform> t = Transform::from_matrix(m);
    if (!t) throw Error(what, "the matrix has no inverse");
    return *t;
}

DoubleArray matrix_array(const Transform& t) {
    std::vector<double> rows;
    for (const auto& row : t.matrix().m) rows.insert(rows.end(), row.begin(), row.end());
    return new_array(rows, 4, 4);
}

DoubleArray vector_array(Vec3f v) {
    const double c[] = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    return new_array(c);
}

nb::object number_or_texture(const FloatParameter& p, const std::shared_ptr<SceneHolder>& scene) {
    if (p.is_constant()) return nb::float_(static_cast<double>(p.value));
    return nb::cast(FloatTextureHandle{scene, p.texture});
}

float photometric_scale(const Spectrum& s, const std::string& what) {
    try {
        return montelux::photometric_scale(s);
    } catch (const Error& e) {
        throw Error(what, e.what());
    }
}

void bind_spectra(nb::module_& m) {
    nb::class_<Spectrum>(
        m, "Spectrum",
        "A spectrum of a material or a light. Where one is expected, a number, three numbers R, "
        "G, B (linear sRGB) or the name of a measured spectrum is accepted, too.")
        .def(
            "__init__", [](Spectrum* s, double value) { new (s) Spectrum(static_cast<float>(value)); },
            "value"_a, "The same at every wavelength.")
        .def_static(
            "rgb",
            [](double r, double g, double b, const std::string& meaning) {
                return rgb(Vec3f(Vec3d{r, g, b}), meaning_of(meaning), "Spectrum.rgb");
            },
            "r"_a, "g"_a, "b"_a, "meaning"_a = "albedo",
            "Of a colour in linear sRGB; meaning: 'albedo' (0 to 1), 'unbounded' or 'illuminant' (times "
            "D65).")
        .def_static(
            "named",
            [](const nb::str& name) { return spectrum_of(name, RgbMeaning::unbounded, "Spectrum.named"); },
            "name"_a, "A measured one, such as 'metal-Au-eta' or 'stdillum-D65'.")
        .def_static(
            "blackbody",
            [](double kelvin) {
                if (!positive(kelvin)) throw Error("Spectrum.blackbody", "expected a temperature above zero");
                return Spectrum(BlackbodySpectrum(static_cast<float>(kelvin)));
            },
            "kelvin"_a, "Of a black body, relative to its peak.")
        .def_static(
            "tabulated", &tabulated_spectrum, "wavelengths"_a, "values"_a,
            "Straight lines between values at wavelengths in nm, ascending; constant beyond the ends.")
        .def_static(
            "names",
            [] {
                return std::vector<std::string>(named_spectrum_names().begin(), named_spectrum_names().end());
            },
            "The names of the measured spectra.")
        .def(
            "__call__",
            [](const Spectrum& s, const nb::object& wavelengths) {
                const Numbers n = numbers_of(wavelengths, "Spectrum");
                NewArray out = new_array(n.shape);
                for (std::size_t i = 0; i < n.values.size(); ++i)
                    out.data[i] = static_cast<double>(s(static_cast<float>(n.values[i])));
                return n.shape.empty() ? nb::object(nb::float_(*out.data)) : nb::object(out.array);
            },
            "wavelengths"_a, "Values at wavelengths in nm.")
        .def_prop_ro(
            "linear_srgb", [](const Spectrum& s) { return vector_array(to_rgb(s)); },
            "The colour that the CIE 1931 observer sees, linear sRGB, shape (3,).")
        .def("__repr__", &spectrum_text);
}

} // namespace montelux::python
