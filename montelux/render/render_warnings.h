// What speaks against a finished render, as sentences.
#pragma once

#include <string>

#include "montelux/render/render_session.h"

namespace montelux {

// Samples that were left out, and how to find the first; empty without any.
std::string bad_sample_warning(const BadSampleReport& bad, std::uint64_t seed);

// A render that was stopped may be without errors, which nothing in its picture would explain; empty where
// they are known, and for slices, which have them once they are joined.
std::string missing_error_warning(const RenderSnapshot& result, const Renderer& renderer);

} // namespace montelux
