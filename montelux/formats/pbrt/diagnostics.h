// Diagnostics of pbrt's files, and text of them in messages.
#pragma once

#include <string>
#include <string_view>

#include "montelux/formats/text_diagnostics.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::pbrt {

using Location = SourceLocation;
using Diagnostics = TextDiagnostics;

using montelux::in_quotes;
inline std::string printable(std::string_view text) { return shown(text); }

} // namespace montelux::pbrt
