#include "montelux/formats/mitsuba/grid_volume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "montelux/mc/math/error.h"

namespace montelux::mitsuba {
namespace {

constexpr std::size_t volume_header_bytes = 48;

// Numbers are little-endian, as the machines that this is compiled for.
template <typename T>
T number_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

} // namespace

GridVolume read_grid_volume(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (bytes.size() < volume_header_bytes || bytes[0] != 'V' || bytes[1] != 'O' || bytes[2] != 'L')
        throw Error(name, "is no volume file (.vol)");
    if (bytes[3] != 3)
        throw Error(name, "has version " + std::to_string(bytes[3]) + " of the format; expected 3");
    if (const auto encoding = number_at<std::int32_t>(bytes, 4); encoding != 1)
        throw Error(name,
                    "has samples of encoding " + std::to_string(encoding) + "; expected 1, 32-bit floats");
    GridVolume volume;
    const std::size_t samples = (bytes.size() - volume_header_bytes) / sizeof(float);
    std::size_t count = 1;
    const auto multiply = [&](std::int32_t factor, const std::string& what) {
        if (factor < 1) throw Error(name, "has " + std::to_string(factor) + " " + what);
        if (static_cast<std::size_t>(factor) > samples / count)
            throw Error(name, "ends before its last sample: " + std::to_string(samples) +
                                  " are fewer than its header promises");
        count *= static_cast<std::size_t>(factor);
    };
    for (std::size_t a = 0; a < 3; ++a) {
        volume.size[a] = number_at<std::int32_t>(bytes, 8 + 4 * a);
        multiply(volume.size[a], std::string("samples along ") + "xyz"[a]);
    }
    volume.channels = number_at<std::int32_t>(bytes, 20);
    if (volume.channels != 1 && volume.channels != 3 && volume.channels != 6)
        throw Error(name, "has " + std::to_string(volume.channels) + " channels; expected 1, 3 or 6");
    multiply(volume.channels, "channels");
    for (int a = 0; a < 3; ++a) {
        volume.lower[a] = number_at<float>(bytes, 24 + 4 * static_cast<std::size_t>(a));
        volume.upper[a] = number_at<float>(bytes, 36 + 4 * static_cast<std::size_t>(a));
    }
    volume.values.resize(count);
    std::memcpy(volume.values.data(), bytes.data() + volume_header_bytes, count * sizeof(float));
    if (!std::ranges::all_of(volume.values, [](float v) { return std::isfinite(v); }))
        throw Error(name, "has a sample that is not finite");
    return volume;
}

} // namespace montelux::mitsuba
