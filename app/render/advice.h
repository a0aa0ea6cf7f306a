// advice_text: what makes a finished picture cleaner, in one line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "montelux/film/film_error.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"

namespace montelux::app {

struct PictureOutcome {
    RenderTarget target;
    RenderReport report;
    FilmError error;
    OutlierReport outliers;
    std::optional<double> visible{}; // visible_error_share
    bool has_checkpoint = false;     // the render can be resumed
    bool can_denoise = false;        // a denoiser is installed and was not used
};

// Above this share of pixels whose error is visible a picture is not clean.
inline constexpr double clean_share = 0.01;

// Empty where nothing is to be said: the picture is clean, or not finished and without a checkpoint.
std::string advice_text(const PictureOutcome& outcome);

} // namespace montelux::app
