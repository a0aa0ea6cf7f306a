// Memory of a device, and memory of the processor for copies, that grow and are released with their owner.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "montelux/mc/device/device.h"

namespace montelux {

// An array on the device. Growing loses what it holds.
template <typename T>
class DeviceArray {
  public:
    explicit DeviceArray(std::shared_ptr<Device> device) : device_(std::move(device)) {}
    ~DeviceArray() {
        if (memory_ != nullptr) device_->release(memory_);
    }
    DeviceArray(const DeviceArray&) = delete;
    DeviceArray& operator=(const DeviceArray&) = delete;

    T* data() const { return memory_; }
    // With room for `size` elements at least.
    T* reserve(std::size_t size) {
        if (size <= capacity_) return memory_;
        if (memory_ != nullptr) device_->release(std::exchange(memory_, nullptr));
        capacity_ = 0;
        memory_ = static_cast<T*>(device_->allocate(size * sizeof(T)));
        capacity_ = size;
        return memory_;
    }
    T* assign(std::span<const T> values) {
        reserve(values.size());
        if (!values.empty()) device_->copy_in(memory_, values.data(), values.size_bytes());
        return memory_;
    }

  private:
    std::shared_ptr<Device> device_;
    T* memory_ = nullptr;
    std::size_t capacity_ = 0;
};

// Numbers that the device wrote, and their copy for the processor.
class DeviceOutput {
  public:
    explicit DeviceOutput(std::shared_ptr<Device> device) : array_(device), device_(std::move(device)) {}
    ~DeviceOutput() {
        if (host_ != nullptr) device_->release_host(host_);
    }
    DeviceOutput(const DeviceOutput&) = delete;
    DeviceOutput& operator=(const DeviceOutput&) = delete;

    double* reserve(std::size_t size) { return array_.reserve(size); }
    // The first `size` numbers; valid until the next call.
    const double* fetch(std::size_t size) {
        if (size > capacity_) {
            if (host_ != nullptr) device_->release_host(std::exchange(host_, nullptr));
            capacity_ = 0;
            host_ = static_cast<double*>(device_->allocate_host(size * sizeof(double)));
            capacity_ = size;
        }
        device_->copy_out(host_, array_.data(), size * sizeof(double));
        return host_;
    }

  private:
    DeviceArray<double> array_;
    std::shared_ptr<Device> device_;
    double* host_ = nullptr;
    std::size_t capacity_ = 0;
};

} // namespace montelux
