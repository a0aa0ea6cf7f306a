#include "python/src/bindings.h"
#include "python/src/scene_values.h"
#include <string>

#include "montelux/film/pixel_filter.h"

namespace montelux::python {
namespace {

Vec2f offset_of(const double* x) { return {static_cast<float>(x[0]), static_cast<float>(x[1])}; }

DoubleArray values(const PixelFilter& filter, const nb::object& offsets) {
    const Rows x(offsets, 2, "pixel filter, value");
    NewArray out = new_array(x.shape());
    {
        nb::gil_scoped_release unlocked;
        for (std::size_t i = 0; i < x.count(); ++i)
            out.data[i] = static_cast<double>(filter_value(filter, offset_of(x[i])));
    }
    return out.array;
}

nb::object samples(const PixelFilter& filter, const nb::object& numbers) {
    const Rows u(numbers, 2, "pixel filter, sample");
    require_uniform(u.numbers.values, "pixel filter, sample");
    const PixelFilterSampler sampler(filter);
    NewArray offsets = new_array(u.numbers.shape), weights = new_array(u.shape());
    {
        nb::gil_scoped_release unlocked;
        for (std::size_t i = 0; i < u.count(); ++i) {
            const FilterSample s = sampler.sample(offset_of(u[i]));
            offsets.data[2 * i] = static_cast<double>(s.offset.x);
            offsets.data[2 * i + 1] = static_cast<double>(s.offset.y);
            weights.data[i] = static_cast<double>(s.weight);
        }
    }
    return nb::make_tuple(offsets.array, weights.array);
}

template <typename T>
nb::class_<Ref<T>> filter_class(nb::module_& m, const char* name, const char* doc) {
    auto c = value_class<T>(m, name, doc);
    attribute<T>(
        c, "radius", "tuple[float, float]",
        [](const T& t, const auto&) {
            return nb::make_tuple(static_cast<double>(t.radius.x), static_cast<double>(t.radius.y));
        },
        [](T& t, nb::handle v, auto&, const std::string& what) {
            const std::vector<double> r = numbers_of(v, 2, what);
            if (!(r[0] > 0 && r[1] > 0)) throw Error(what, "expected two numbers above zero");
            t.radius = {static_cast<float>(r[0]), static_cast<float>(r[1])};
        },
        "Half width and half height in pixels.");
    c.def(
        "value", [](const Ref<T>& r, const nb::object& offsets) { return values(r.value(), offsets); },
        "offsets"_a,
        "The filter at offsets from the middle of the pixel, pixels, shape (n, 2): shape (n,). Not "
        "normalised; zero outside the radius.");
    c.def(
        "sample", [](const Ref<T>& r, const nb::object& u) { return samples(r.value(), u); }, "u"_a,
        nb::sig("def sample(self, u: object) -> tuple[numpy.typing.NDArray[numpy.float64], "
                "numpy.typing.NDArray[numpy.float64]]"),
        "Offsets drawn in proportion to the filter's magnitude, shape (n, 2), and their weights, shape (n,), "
        "for uniform numbers u of shape (n, 2).\n\n"
        "A weight is the filter over the density, scaled to mean one; negative in negative lobes.");
    return c;
}

} // namespace

void bind_filters(nb::module_& m) {
    filter_class<BoxFilter>(m, "BoxFilter", "Every point of the pixel's box counts the same.");
    filter_class<TriangleFilter>(m, "TriangleFilter", "Falls linearly.");
    auto gaussian = filter_class<GaussianFilter>(m, "GaussianFilter", "A Gaussian that is zero at its edge.");
    number(gaussian, "sigma", &GaussianFilter::sigma, positive, "a number above zero",
           "Standard deviation, pixels.");
    auto mitchell = filter_class<MitchellFilter>(m, "MitchellFilter", "Mitchell and Netravali's cubic.");
    number(mitchell, "b", &MitchellFilter::b, finite, "a number", "Blur.");
    number(mitchell, "c", &MitchellFilter::c, finite, "a number", "Ringing.");
    auto lanczos = filter_class<LanczosFilter>(m, "LanczosFilter", "A windowed sinc.");
    number(lanczos, "tau", &LanczosFilter::tau, positive, "a number above zero", "Cycles of the window.");
}

} // namespace montelux::python
