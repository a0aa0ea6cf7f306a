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

// What the device wrote, and its copy for the processor.
template <typename T>
class DeviceOutput {
  public:
    explicit DeviceOutput(std::shared_ptr<Device> device) : array_(device), device_(std::move(device)) {}
    ~DeviceOutput() {
        if (host_ != nullptr) device_->release_host(host_);
    }
    DeviceOutput(const DeviceOutput&) = delete;
    DeviceOutput& operator=(const DeviceOutput&) = delete;

    T* reserve(std::size_t size) { return array_.reserve(size); }
    // Room for the copies of `size` elements, which fetch_part() fills in; valid until more are asked for.
    const T* reserve_copies(std::size_t size) {
        if (size <= capacity_) return host_;
        if (host_ != nullptr) device_->release_host(std::exchange(host_, nullptr));
        capacity_ = 0;
        host_ = static_cast<T*>(device_->allocate_host(size * sizeof(T)));
        capacity_ = size;
        return host_;
    }
    void fetch_part(std::size_t first, std::size_t count) {
        device_->copy_out(host_ + first, array_.data() + first, count * sizeof(T));
    }
    // The first `size` elements.
    const T* fetch(std::size_t size) {
        reserve_copies(size);
        fetch_part(0, size);
        return host_;
    }

  private:
    DeviceArray<T> array_;
    std::shared_ptr<Device> device_;
    T* host_ = nullptr;
    std::size_t capacity_ = 0;
};

} // namespace montelux
