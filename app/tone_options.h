// Options of .png and .jpg outputs: exposure, tone curve, bits and quality; and what is said about the exposure.
#pragma once

#include "app/usage_error.h"
#include <optional>
#include <string>
#include <vector>

#include "montelux/image/image_write.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct ToneOptions {
    std::optional<float> exposure{}; // stops
    bool automatic = false;          // --exposure auto
    std::optional<ToneKind> tone{};
    std::optional<int> bits{}, quality{};
};

// --exposure, --tone, --bits and --quality.
void declare(CLI::App& command, ToneOptions& options);

// Throws UsageError for an option that none of the outputs takes.
void check(const ToneOptions& options, const std::vector<std::string>& outputs);

// Of a picture without --exposure.
enum class DefaultExposure {
    suitable, // suitable_exposure: nothing else chooses one
    zero,     // the scene's film chooses one
};

// The curve by which `picture` is shown.
ToneCurve tone_curve_of(const ToneOptions& options, const Image& picture, DefaultExposure by_default);

// How `picture`, whose colours are shown, is written to `path`. Unless `quiet`, prints an exposure that was chosen for
// it, or that it is black or white all over.
WriteOptions tone_of(const ToneOptions& options, const std::string& path, const Image& picture,
                     DefaultExposure by_default, bool quiet);

} // namespace montelux::app
