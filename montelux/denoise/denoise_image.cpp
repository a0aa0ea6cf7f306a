#include "montelux/denoise/denoise_image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

using Names = std::array<const char*, 3>;
using Channels = std::array<int, 3>;

constexpr Names color{"R", "G", "B"}, denoised{"denoised.R", "denoised.G", "denoised.B"},
    albedo{"albedo.R", "albedo.G", "albedo.B"}, normal{"N.X", "N.Y", "N.Z"};

std::optional<Channels> find(const Image& image, const Names& names) {
    Channels channels{};
    for (std::size_t c = 0; c < 3; ++c) {
        auto found = image.find_channel(names[c]);
        if (!found) return std::nullopt;
        channels[c] = *found;
    }
    return channels;
}

Channels require(const Image& image, const Names& names, const char* what) {
    if (auto channels = find(image, names)) return *channels;
    std::string known;
    for (const std::string& name : image.channel_names()) known += (known.empty() ? "" : ", ") + name;
    throw Error("denoise", std::string(what) + " needs the channels " + names[0] + ", " + names[1] + " and " +
                               names[2] + ", but there are " + (known.empty() ? "none" : known));
}

std::vector<float> triples(const Image& image, const Channels& channels) {
    std::vector<float> values;
    values.reserve(3 * image.pixel_count());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c : channels) values.push_back(image.linear(x, y, c));
    return values;
}

void store(Image& image, const Channels& channels, const std::vector<float>& values) {
    auto value = values.begin();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c : channels) image.set(x, y, c, *value++);
}

} // namespace

DenoiseReport denoise_image(const Denoiser& denoiser, Image& image) {
    const std::vector<float> beauty = triples(image, require(image, color, "denoising"));
    DenoiseReport report;
    std::vector<float> first_guide, second_guide;
    if (auto channels = find(image, albedo)) {
        first_guide = triples(image, *channels);
        report.guides = "albedo";
        if (auto normals = find(image, normal)) {
            second_guide = triples(image, *normals);
            report.guides += " and normal";
        }
    }
    DenoiserOutput out = denoiser.denoise({image.width(), image.height(), beauty, first_guide, second_guide});
    report.not_finite = out.not_finite;
    report.negative = out.negative;

    Image result = image.to_linear_f32();
    if (!find(result, denoised))
        result.append(Image(result.width(), result.height(), {denoised.begin(), denoised.end()}));
    store(result, require(result, denoised, "the result"), out.color);
    result.attributes()["denoiser"] = denoiser.name();
    result.attributes()["denoiserGuides"] = report.guides.empty() ? "none" : report.guides;
    image = std::move(result);
    return report;
}

Image denoised_picture(const Image& image) {
    const Channels channels = require(image, denoised, "the denoised picture");
    Image picture(image.width(), image.height(), {color.begin(), color.end()});
    store(picture, {0, 1, 2}, triples(image, channels));
    picture.attributes() = image.attributes();
    return picture;
}

void write_picture(const std::filesystem::path& path, const Image& image, const WriteOptions& options) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".exr" && image.find_channel("denoised.R"))
        write_image(path, denoised_picture(image), options);
    else
        write_image(path, image, options);
}

} // namespace montelux
