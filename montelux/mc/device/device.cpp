#include "montelux/mc/device/device.h"

#include <array>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux {
namespace {

constexpr std::array<std::string_view, 2> device_names{"cuda", "emulated"};

} // namespace

std::shared_ptr<Device> Device::open(std::string_view name) {
    if (name == device_names[0]) return open_cuda_device();
    if (name == device_names[1]) return open_emulated_device();
    throw Error("device", "there is no device '" + std::string(name) + "'" +
                              did_you_mean(std::string(name), device_names) +
                              "; expected one of cuda, emulated");
}

std::span<const std::string_view> Device::names() { return device_names; }

} // namespace montelux
