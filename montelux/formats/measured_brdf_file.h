// Files of measured BRDFs (.bsdf) in the tensor format of Dupuy and Jakob's material database.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "montelux/mc/io/file.h"
#include "montelux/scene/bsdf/measured_brdf.h"

namespace montelux {

// `name` is that of the file, for messages. Files are not trusted: all sizes and offsets are checked. Throws Error.
MeasuredBrdf read_measured_brdf(std::span<const std::uint8_t> bytes, const std::string& name);

// The inverse, without the fields that are not read.
void write_measured_brdf(AtomicFile& file, const MeasuredBrdf& brdf);

} // namespace montelux
