// The denoiser: a noisy picture and what its pixels show in, a smooth picture out.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "montelux/denoise/oidn_api.h"

namespace montelux {

// Three floats a pixel, row 0 the top one. The guides may be empty, the normal alone never.
struct DenoiserInput {
    int width = 0, height = 0;
    std::span<const float> color;  // linear light, any range
    std::span<const float> albedo; // 0 to 1
    std::span<const float> normal; // components -1 to 1, any frame
};

struct DenoiserOutput {
    std::vector<float> color;
    // Pixels with a value that is not a number or infinite. Before the filter sees it the colour of such a
    // pixel is replaced by the mean of its eight neighbours that have none (0 without any), a guide by 0.
    std::uint64_t not_finite = 0;
    // Pixels with a colour below 0, which the filter takes for 0.
    std::uint64_t negative = 0;
};

// Open Image Denoise's filter for ray tracing, on the CPU: a trained network (U-Net), so its output is a
// guess with an unknown bias, and no standard error of the input holds for it.
class Denoiser {
  public:
    // At most `threads` threads; 0: the library's choice, within the process's ThreadLimit where it
    // shares oneTBB. Throws Error where the library is missing, too old, or cannot make a device.
    static Denoiser load(int threads = 0) { return Denoiser(load_oidn(), threads); }
    explicit Denoiser(OidnApi api, int threads = 0);

    // Such as "Open Image Denoise 2.5.1".
    const std::string& name() const { return name_; }
    const std::string& file() const { return api_->file; }

    // Guides are denoised first, each alone, and then taken as free of noise: edges that they show stay
    // sharp. Throws Error when sizes do not fit, the library fails, or its picture is not finite.
    DenoiserOutput denoise(const DenoiserInput& input) const;

  private:
    struct Release {
        const OidnApi* api;
        void operator()(OidnDevice* device) const { api->release_device(device); }
        void operator()(OidnFilter* filter) const { api->release_filter(filter); }
    };
    using Filter = std::unique_ptr<OidnFilter, Release>;
    struct NamedImage {
        const char* name;
        std::vector<float>* pixels;
    };

    void check(const char* what) const;
    void run(int width, int height, std::span<const NamedImage> inputs, std::vector<float>& output,
             bool is_beauty) const;

    std::unique_ptr<OidnApi> api_; // lives at one place: devices and filters are released through it
    std::unique_ptr<OidnDevice, Release> device_;
    std::string name_;
};

} // namespace montelux
