#include "montelux/film/spectral_buckets.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "montelux/film/film.h"

namespace montelux {

std::string spectral_layer(float lambda) {
    char text[32];
    std::snprintf(text, sizeof text, "S0.%.3fnm", static_cast<double>(lambda));
    std::string name = text;
    std::replace(name.begin() + 3, name.end(), '.', ',');
    return name;
}

void append_spectral_layers(Image& image, const Film& film) {
    const BucketLayout layout(*film.settings().spectral);
    std::vector<std::string> names;
    names.reserve(2 * static_cast<std::size_t>(layout.count()));
    for (int i = 0; i < layout.count(); ++i) names.push_back(spectral_layer(layout.center(i)));
    for (int i = 0; i < layout.count(); ++i) names.push_back("stderr." + names[static_cast<std::size_t>(i)]);
    Image layers(image.width(), image.height(), std::move(names));
    auto out = layers.f32().begin();
    const std::span<const BucketMoments> buckets = film.buckets();
    const auto count = static_cast<std::size_t>(layout.count());
    for (std::size_t p = 0; p < film.pixels().size(); ++p) {
        const std::uint64_t replicates = film.pixels()[p].replicates().count();
        for (const BucketMoments& b : buckets.subspan(p * count, count)) *out++ = static_cast<float>(b.mean);
        for (const BucketMoments& b : buckets.subspan(p * count, count))
            *out++ = static_cast<float>(b.standard_error(replicates));
    }
    image.append(layers);
    image.attributes()["spectralLayoutVersion"] = std::string("1.0");
    image.attributes()["emissiveUnits"] = std::string("W.m^-2.sr^-1");
}

} // namespace montelux
