#include "python/src/bindings.h"
#include "python/src/images.h"
#include "python/src/numpy_bridge.h"
#include "python/src/render_job.h"
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"
#include "montelux/image/placement.h"

namespace montelux::python {
namespace {

// Arrays of colours, shape (h, w, 3) or (h, w), and of their errors, as a picture with layers.
Image picture_of_arrays(const nb::object& mean, const nb::object& error, const std::string& what) {
    Image image = rgb_image(picture_of(mean, what), what);
    if (error.is_none()) return image;
    const Image errors = rgb_image(picture_of(error, what + ", standard error"), what);
    if (errors.width() != image.width() || errors.height() != image.height())
        throw Error(what, "the standard errors have another shape than the picture");
    image.append(errors, "stderr.");
    return image;
}

nb::dict dict_of(const ZScores& z) {
    nb::dict d;
    d["count"] = z.count;
    d["mean"] = z.mean;
    d["standard_deviation"] = z.standard_deviation;
    d["within"] = nb::make_tuple(z.within[0], z.within[1], z.within[2]);
    d["largest"] = z.largest;
    d["equal_without_error"] = z.equal_without_error;
    d["unexplained"] = z.unexplained;
    d["invalid_errors"] = z.invalid_errors;
    return d;
}

// The pixels common to two crops.
Comparison compare_common(const Image& a, const std::string& a_name, const Image& b,
                          const std::string& b_name, const ComparisonOptions& options, PixelWindow& window) {
    const std::optional<PixelWindow> common = common_pixels(a_name, a, b_name, b);
    if (!common) {
        window = placement_of(a).data;
        return compare_pictures(measured_picture(a_name, a), measured_picture(b_name, b), options);
    }
    window = *common;
    const Image part_a = cut_out(a, window), part_b = cut_out(b, window);
    return compare_pictures(measured_picture(a_name, part_a), measured_picture(b_name, part_b), options);
}

nb::dict compare(const Image& a, const std::string& a_name, const Image& b, const std::string& b_name,
                 double epsilon, double set_aside) {
    Comparison c;
    PixelWindow window;
    {
        nb::gil_scoped_release unlocked;
        c = compare_common(a, a_name, b, b_name, {epsilon, set_aside}, window);
    }
    nb::list channels;
    for (const ChannelComparison& k : c.channels) {
        nb::dict d;
        d["name"] = k.name;
        d["mean_a"] = k.mean_a;
        d["mean_b"] = k.mean_b;
        d["relative_mean_difference"] = k.relative_mean_difference;
        d["mean_difference_error"] = k.mean_difference_error;
        d["rmse"] = k.rmse;
        d["rel_mse"] = k.rel_mse;
        channels.append(d);
    }
    nb::dict d;
    d["channels"] = channels;
    d["rmse"] = c.rmse;
    d["rel_mse"] = c.rel_mse;
    d["window"] = nb::make_tuple(window.x0, window.y0, window.x1, window.y1);
    d["pixels"] = c.pixels;
    d["set_aside"] = c.set_aside;
    d["not_finite"] = c.not_finite;
    const bool errors = c.a_has_error || c.b_has_error;
    d["z"] = errors ? nb::object(dict_of(c.z)) : nb::none();
    d["z_pooled"] = errors ? nb::object(dict_of(c.pooled)) : nb::none();
    d["z_skew_corrected"] = errors && c.skew_known ? nb::object(dict_of(c.skew_corrected)) : nb::none();
    return d;
}

} // namespace

void bind_compare(nb::module_& m) {
    m.def("picture_of_arrays", &picture_of_arrays, "mean"_a, "standard_error"_a.none(), "what"_a);
    m.def(
        "picture_of_file", [](const std::filesystem::path& path) { return read_image(path); }, "path"_a);
    m.def(
        "picture_of_snapshot", [](const RenderSnapshot& snapshot) { return *snapshot.image; }, "snapshot"_a);
    m.def("compare", &compare, "a"_a, "a_name"_a, "b"_a, "b_name"_a, "epsilon"_a, "set_aside"_a,
          "montelux.compare, with everything decided.");
}

} // namespace montelux::python
