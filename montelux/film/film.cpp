#include "montelux/film/film.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"

namespace montelux {

double share_of_replicate(const SkewMoments<3>& replicates, Vec3d replicate) {
    if (replicates.count() < 2) return 0;
    double own = 0, all = 0;
    for (int c = 0; c < 3; ++c) {
        const double deviation = replicate[c] - replicates.mean(c),
                     w = luminance_weight[c] * luminance_weight[c];
        own += w * deviation * deviation;
        all += w * replicates.variance(c) * static_cast<double>(replicates.count() - 1);
    }
    return all > 0 ? own / all : 0;
}

Film::Film(const FilmSettings& settings, FilmLayers layers)
    : settings_(settings), layers_(std::move(layers)) {
    const PixelBounds& c = settings.crop;
    if (settings.width < 1 || settings.height < 1 || settings.width > Image::max_dimension ||
        settings.height > Image::max_dimension)
        throw Error("film", "the resolution " + std::to_string(settings.width) + "x" +
                                std::to_string(settings.height) + " must be between 1 and " +
                                std::to_string(Image::max_dimension) + " pixels each way");
    if (c.x0 < 0 || c.y0 < 0 || c.x1 > settings.width || c.y1 > settings.height || c.width() < 1 ||
        c.height() < 1)
        throw Error("film", "the crop window holds no pixel of the film");
    pixels_.resize(static_cast<std::size_t>(c.width()) * static_cast<std::size_t>(c.height()));
    layer_sums_.resize(pixels_.size() * layers_.sums());
    if (const auto& spectral = settings.spectral) {
        if (!(spectral->lambda_min >= lambda_min && spectral->lambda_min < spectral->lambda_max &&
              spectral->lambda_max <= lambda_max))
            throw Error("film", "the wavelengths of a spectral film must lie between 360 nm and 830 nm");
        if (spectral->buckets < 1 || spectral->buckets > SpectralSettings::most_buckets)
            throw Error("film", "a spectral film has 1 to " + std::to_string(SpectralSettings::most_buckets) +
                                    " buckets");
        buckets_.resize(pixels_.size() * static_cast<std::size_t>(spectral->buckets));
    }
}

void Film::copy_row(const Film& from, int x, int y, int width) {
    std::copy_n(&from.pixel(x, y), width, &pixel(x, y));
    const auto copy = [&](std::size_t n, const auto& values, auto& into) {
        if (n > 0)
            std::copy_n(&values[index(x, y) * n], static_cast<std::size_t>(width) * n,
                        &into[index(x, y) * n]);
    };
    copy(buckets_per_pixel(), from.buckets_, buckets_);
    copy(layers_.sums(), from.layer_sums_, layer_sums_);
}

void Film::end_bucket_replicates(std::uint32_t points) {
    const std::size_t n = buckets_per_pixel();
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::uint32_t samples = pixels_[i].open_samples();
        const bool drops = pixels_[i].drops_last_replicate(points);
        for (BucketMoments& b : std::span(buckets_).subspan(i * n, n)) {
            if (samples > 0 && !drops) b.end_replicate(samples, pixels_[i].replicates().count() + 1);
            b.open = 0;
        }
    }
}

std::vector<std::string> film_layers(bool of_slice) {
    std::vector<std::string> layers = FilmLayers().channels();
    if (of_slice) layers.insert(layers.end(), {"brightest.R", "brightest.G", "brightest.B"});
    return layers;
}

void Film::end_replicates(std::uint32_t points) {
    if (!buckets_.empty()) end_bucket_replicates(points);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        if (layers_.sums() > 0) {
            double* const sums = &layer_sums_[i * layers_.sums()];
            if (p.drops_last_replicate(points))
                layers_.drop_replicate(sums);
            else
                layers_.end_replicate(sums, p.open_samples());
        }
        p.end_last_replicate(points);
    }
}

void Film::end_replicates(const PixelBounds& part) {
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x) {
            Pixel& p = pixel(x, y);
            if (layers_.sums() > 0)
                layers_.end_replicate(&layer_sums_[index(x, y) * layers_.sums()], p.open_samples());
            for (std::size_t k = 0, n = buckets_per_pixel(); k < n && p.open_samples() > 0; ++k)
                buckets_[index(x, y) * n + k].end_replicate(p.open_samples(), p.replicates().count() + 1);
            p.end_replicate();
        }
}

void Film::drop_replicates() {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (layers_.sums() > 0) layers_.drop_replicate(&layer_sums_[i * layers_.sums()]);
        pixels_[i].drop_replicate();
    }
    for (BucketMoments& b : buckets_) b.open = 0;
}

Image Film::develop(bool as_slice) const {
    std::vector<std::string> channels = layers_.channels();
    if (as_slice) channels.insert(channels.end(), {"brightest.R", "brightest.G", "brightest.B"});
    Image image(bounds().width(), bounds().height(), std::move(channels));
    auto out = image.f32().begin();
    auto put = [&](double v) { *out++ = static_cast<float>(v); };
    const LayerSet set = layers_.set();
    const std::vector<PixelWarning> warnings =
        set.has(Layer::warning) ? pixel_warnings(*this) : std::vector<PixelWarning>();
    std::vector<float> others;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Pixel& p = pixels_[i];
        const SkewMoments<3>& replicates = p.replicates();
        const auto each = [&](Layer layer, const auto& value) {
            for (int c = 0; c < 3 && set.has(layer); ++c) put(value(c));
        };
        const auto one = [&](Layer layer, const auto& value) {
            if (set.has(layer)) put(static_cast<double>(value()));
        };
        // Replicates are means over points of a sampler: this is the variance of a single sample with the same
        // error.
        const auto variance = [&](int c) {
            return replicates.count() >= 2 ? std::pow(replicates.standard_error(c), 2) * p.samples() : 0;
        };
        each(Layer::mean, [&](int c) { return replicates.mean(c); });
        each(Layer::error, [&](int c) { return replicates.standard_error(c); });
        each(Layer::skewness, [&](int c) { return replicates.skewness_of_mean(c); });
        one(Layer::samples, [&] { return p.samples(); });
        one(Layer::replicates, [&] { return replicates.count(); });
        one(Layer::outlier, [&] { return p.largest_share(); });
        one(Layer::warning, [&] { return warnings[i]; });
        each(Layer::albedo, [&](int c) { return double(p.albedo()[c]); });
        each(Layer::normal, [&](int c) { return double(p.normal()[c]); });
        one(Layer::depth, [&] { return p.depth(); });
        each(Layer::variance, variance);
        each(Layer::relative_variance,
             [&](int c) { return replicates.mean(c) != 0 ? variance(c) / replicates.mean(c) : 0; });
        if (layers_.sums() > 0) {
            layers_.develop(p, &layer_sums_[i * layers_.sums()], others);
            out = std::ranges::copy(others, out).out;
        }
        if (as_slice)
            for (int c = 0; c < 3; ++c) put(p.brightest()[c]);
    }
    if (!buckets_.empty()) append_spectral_layers(image, *this);
    return image;
}

} // namespace montelux
