#include "montelux/denoise/denoiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

bool is_finite(const float* rgb) {
    return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
}

void check_size(const char* name, std::span<const float> pixels, const DenoiserInput& input) {
    std::size_t expected = std::size_t{3} * input.width * input.height;
    if (pixels.size() != expected)
        throw Error("Denoiser", std::string(name) + " has " + std::to_string(pixels.size()) +
                                    " numbers; three for each of the " + std::to_string(input.width) + " x " +
                                    std::to_string(input.height) + " pixels are expected");
}

// The mean of the finite ones among the eight neighbours in the picture as it was given, so the order of
// pixels does not matter.
std::array<float, 3> mean_of_neighbours(const DenoiserInput& input, int x, int y) {
    std::array<double, 3> sum{};
    int count = 0;
    for (int v = std::max(0, y - 1); v <= std::min(input.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(input.width - 1, x + 1); ++u) {
            const float* rgb = &input.color[3 * (static_cast<std::size_t>(v) * input.width + u)];
            if (!is_finite(rgb)) continue; // the pixel itself among them
            for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(rgb[c]);
            ++count;
        }
    std::array<float, 3> mean{};
    if (count > 0)
        for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<float>(sum[c] / count);
    return mean;
}

// What the filter may see of a guide: finite numbers from `lowest` to 1.
std::vector<float> clean_guide(std::span<const float> guide, float lowest, std::vector<bool>& bad) {
    std::vector<float> clean(guide.begin(), guide.end());
    for (std::size_t p = 0; p < bad.size(); ++p) {
        float* v = &clean[3 * p];
        if (!is_finite(v)) {
            bad[p] = true;
            std::fill(v, v + 3, 0.0f);
        }
        for (int c = 0; c < 3; ++c) v[c] = std::clamp(v[c], lowest, 1.0f);
    }
    return clean;
}

} // namespace

Denoiser::Denoiser(OidnApi api, int threads)
    : api_(std::make_unique<OidnApi>(std::move(api))), device_(nullptr, Release{api_.get()}) {
    if (threads < 0) throw Error("Denoiser", "the number of threads must not be negative");
    device_.reset(api_->new_device(OidnApi::cpu_device));
    check("no device could be made");
    if (!device_) throw Error(api_->file, "no device could be made, and the library does not say why");
    api_->set_device_int(device_.get(), "numThreads", threads);
    // Pinned threads would stay pinned after the filter, when they are the caller's again.
    api_->set_device_bool(device_.get(), "setAffinity", false);
    api_->commit_device(device_.get());
    check("the device could not be started");
    int version = api_->get_device_int(device_.get(), "version");
    check("the version is unknown");
    name_ = "Open Image Denoise " + std::to_string(version / 10000) + "." +
            std::to_string(version / 100 % 100) + "." + std::to_string(version % 100);
    if (version < 10400) throw Error(api_->file, "this is " + name_ + "; 1.4 or newer is expected");
}

void Denoiser::check(const char* what) const {
    const char* message = nullptr;
    int code = api_->get_device_error(device_.get(), &message);
    if (code == OidnApi::no_error) return;
    throw Error(api_->file, std::string("Open Image Denoise failed, ") + what + ": " +
                                (message && *message ? message : "no reason is given") + " (error " +
                                std::to_string(code) + ")");
}

void Denoiser::run(int width, int height, std::span<const NamedImage> inputs, std::vector<float>& output,
                   bool is_beauty) const {
    Filter filter(api_->new_filter(device_.get(), "RT"), Release{api_.get()});
    check("no filter could be made");
    if (!filter) throw Error(api_->file, "no filter could be made, and the library does not say why");
    auto set = [&](const char* name, std::vector<float>& pixels) {
        api_->set_filter_image(filter.get(), name, pixels.data(), OidnApi::float3_format,
                               static_cast<std::size_t>(width), static_cast<std::size_t>(height), 0, 0, 0);
    };
    for (const NamedImage& input : inputs) set(input.name, *input.pixels);
    set("output", output);
    if (is_beauty) {
        api_->set_filter_bool(filter.get(), "hdr", true);
        if (inputs.size() > 1) api_->set_filter_bool(filter.get(), "cleanAux", true);
    }
    api_->commit_filter(filter.get());
    check("the filter could not be prepared");
    api_->execute_filter(filter.get());
    check("the picture could not be filtered");
}

DenoiserOutput Denoiser::denoise(const DenoiserInput& input) const {
    if (input.width < 1 || input.height < 1) throw Error("Denoiser", "the picture has no pixels");
    check_size("the colour", input.color, input);
    if (!input.albedo.empty()) check_size("the albedo", input.albedo, input);
    if (!input.normal.empty()) check_size("the normal", input.normal, input);
    if (input.albedo.empty() && !input.normal.empty())
        throw Error("Denoiser", "a normal without an albedo cannot be used");

    DenoiserOutput out;
    std::size_t pixels = static_cast<std::size_t>(input.width) * input.height;
    std::vector<bool> bad(pixels, false);
    std::vector<float> color(input.color.begin(), input.color.end());
    for (std::size_t p = 0; p < pixels; ++p) {
        if (!is_finite(&input.color[3 * p])) {
            bad[p] = true;
            auto mean = mean_of_neighbours(input, static_cast<int>(p % input.width),
                                           static_cast<int>(p / input.width));
            std::copy(mean.begin(), mean.end(), &color[3 * p]);
        } else if (std::any_of(&color[3 * p], &color[3 * p] + 3, [](float v) { return v < 0; })) {
            ++out.negative;
        }
        for (std::size_t c = 0; c < 3; ++c) color[3 * p + c] = std::max(color[3 * p + c], 0.0f);
    }

    std::vector<float> albedo, normal;
    std::vector<NamedImage> inputs{{"color", &color}};
    auto add_guide = [&](const char* name, std::span<const float> given, float lowest,
                         std::vector<float>& to) {
        if (given.empty()) return;
        to = clean_guide(given, lowest, bad);
        const NamedImage alone{name, &to};
        std::vector<float> filtered(to.size());
        run(input.width, input.height, {&alone, 1}, filtered, false);
        to = std::move(filtered);
        inputs.push_back({name, &to});
    };
    add_guide("albedo", input.albedo, 0, albedo);
    add_guide("normal", input.normal, -1, normal);
    out.not_finite = static_cast<std::uint64_t>(std::count(bad.begin(), bad.end(), true));

    out.color.resize(3 * pixels);
    run(input.width, input.height, inputs, out.color, true);
    auto wrong =
        std::find_if_not(out.color.begin(), out.color.end(), [](float v) { return std::isfinite(v); });
    if (wrong != out.color.end()) {
        auto p = static_cast<std::size_t>(wrong - out.color.begin()) / 3;
        throw Error(api_->file, name_ + " gave a number that is not finite at pixel " +
                                    std::to_string(p % input.width) + "," + std::to_string(p / input.width));
    }
    return out;
}

} // namespace montelux
