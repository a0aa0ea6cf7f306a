// A replayed sample as text: its path vertex by vertex, and its contribution.
#pragma once

#include <string>

#include "montelux/mc/random/sampler_settings.h"
#include "montelux/render/sample_record.h"

namespace montelux {

// The four columns are the wavelengths of the path. Ends with a newline.
std::string sample_record_text(const SampleRecord& record, const SceneDescription& description);

} // namespace montelux
