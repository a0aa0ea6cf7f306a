#include "python/src/images.h"

#include "python/src/bindings.h"
#include "python/src/names.h"
#include "python/src/numpy_bridge.h"
#include <cmath>
#include <filesystem>
#include <utility>

#include "montelux/image/difference_picture.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/tone_curve.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::python {

Image picture_of(const nb::object& given, const std::string& what) {
    std::filesystem::path path;
    if (nb::isinstance<nb::str>(given) || nb::hasattr(given, "__fspath__")) {
        path = nb::cast<std::filesystem::path>(given);
        return read_image(path);
    }
    const bool bytes =
        nb::hasattr(given, "dtype") && nb::cast<std::string>(given.attr("dtype").attr("name")) == "uint8";
    const Numbers n = numbers_of(given, what);
    const bool grey = n.shape.size() == 2;
    if (!grey && !(n.shape.size() == 3 && n.shape[2] == 3))
        throw Error(what, "expected a file, or an array of shape (h, w, 3) or (h, w)");
    const std::vector<std::string> names =
        grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    Image image(static_cast<int>(n.shape[1]), static_cast<int>(n.shape[0]), names,
                bytes ? PixelFormat::u8 : PixelFormat::f32,
                bytes ? ColorEncoding::srgb() : ColorEncoding::linear());
    for (std::size_t i = 0; i < n.values.size(); ++i) {
        if (bytes)
            image.u8()[i] = static_cast<std::uint8_t>(n.values[i]);
        else
            image.f32()[i] = static_cast<float>(n.values[i]);
    }
    return image;
}

Image rgb_image(const Image& picture, const std::string& what) {
    Image rgb = rgb_map(picture);
    if (rgb.empty()) throw Error(what, "the picture has neither channels R, G and B nor Y");
    return rgb;
}

Image light_map(const nb::object& given, const std::string& what) {
    Image map = rgb_image(picture_of(given, what), what);
    for (const float v : map.f32())
        if (!(v >= 0 && std::isfinite(v)))
            throw Error(what, "the map has a pixel that is negative or not finite");
    return map;
}

namespace {
constexpr Names<EnvironmentLayout, 2> layouts{
    "layout",
    {{{name_of(EnvironmentLayout::equirectangular), EnvironmentLayout::equirectangular},
      {name_of(EnvironmentLayout::equal_area), EnvironmentLayout::equal_area}}}};
} // namespace

EnvironmentLayout map_layout(std::string_view name, const Image& map, const std::string& what) {
    const std::string pixels = std::to_string(map.width()) + " x " + std::to_string(map.height()) + " pixels";
    if (name == "auto") {
        if (const auto usual = layout_of_size(map.width(), map.height())) return *usual;
        throw Error(what, "the map has " + pixels +
                              "; expected a square map (equal-area octahedral), or one twice as wide as high "
                              "(latitude-longitude)");
    }
    const EnvironmentLayout layout = layouts.value(name);
    if (layout == EnvironmentLayout::equal_area && map.width() != map.height())
        throw Error(what, "an equal-area map of " + pixels + " was given; expected a square one");
    return layout;
}

nb::object channels_of(const std::shared_ptr<const Image>& image, int first, int count) {
    nb::capsule owner(new std::shared_ptr<const Image>(image),
                      [](void* p) noexcept { delete static_cast<std::shared_ptr<const Image>*>(p); });
    return float_view(image->f32().data() + first, static_cast<std::size_t>(image->height()),
                      static_cast<std::size_t>(image->width()), static_cast<std::size_t>(image->channels()),
                      static_cast<std::size_t>(count), owner);
}

void bind_images(nb::module_& m) {
    nb::class_<Image>(m, "Picture", "A picture with named channels, as files hold it.")
        .def_prop_ro("width", &Image::width)
        .def_prop_ro("height", &Image::height)
        .def_prop_ro("channels", [](const Image& i) { return i.channel_names(); });
    m.def(
        "read_channels",
        [](const std::filesystem::path& path) {
            auto image = std::make_shared<const Image>(read_image(path).to_linear_f32());
            nb::dict layers;
            for (int c = 0; c < image->channels(); ++c)
                layers[image->channel_names()[static_cast<std::size_t>(c)].c_str()] =
                    channels_of(image, c, 1);
            return layers;
        },
        "path"_a,
        "The channels of a picture file, linear float32, each of shape (height, width), by their names.");
}

} // namespace montelux::python
