// One encoder per file format, internal to the image room: Image in, bytes out.
#pragma once

#include "montelux/image/image.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/io/file.h"

namespace montelux {

void encode_exr(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options);
void encode_png(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options);
void encode_jpeg(AtomicFile& file, const std::string& name, const Image& image, const WriteOptions& options);
void encode_hdr(AtomicFile& file, const std::string& name, const Image& image);
void encode_pfm(AtomicFile& file, const std::string& name, const Image& image);

// The colour channels of an image, or an Error that names those it has.
std::vector<int> require_color_channels(const std::string& name, const Image& image);

// What a PNG or JPEG file holds: the colour channels and A, as codes of 8 or 16 bits.
Image coded_picture(const std::string& name, const Image& image, const ToneCurve& tone, int bits);

} // namespace montelux
