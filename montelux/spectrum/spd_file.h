// Reading spectra from text files of wavelengths and values (".spd").
#pragma once

#include <filesystem>
#include <string_view>

#include "montelux/spectrum/piecewise_linear.h"

namespace montelux {

// Pairs of wavelength (nm, ascending) and value, separated by white space or commas; '#' starts a comment up
// to the end of its line. The spectrum is 0 outside its wavelengths. Throws Error that names the file and the
// line; files above 16 MiB are refused.
PiecewiseLinear read_spd_file(const std::filesystem::path& path);

// The same for a text in memory; `where` names it in errors.
PiecewiseLinear parse_spd(std::string_view text, std::string_view where);

} // namespace montelux
