// DeviceFunction: an integrand that a device has compiled.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>

#include "montelux/mc/device/device.h"
#include "montelux/mc/device/device_memory.h"
#include "montelux/mc/device/kernel_text.h"

namespace montelux {

// Used by many threads: at() takes turns, and run() is one's own to order.
class DeviceFunction {
  public:
    // Throws Error with the compiler's messages where it cannot be compiled.
    DeviceFunction(std::shared_ptr<Device> device, const FunctionSource& source, int dimensions);

    int dimensions() const { return dimensions_; }
    int components() const { return components_; } // 1 where it returns its value
    const std::shared_ptr<Device>& device() const { return device_; }

    // Values at n points: coordinate d of point i is x[d * stride + i], and component c of its value
    // y[c * y_stride + i].
    void at(const double* x, std::size_t n, std::size_t stride, double* y, std::size_t y_stride) const;

    // Completes a job by the parameters, and runs it.
    void run(DeviceJob job) const;
    // Compiles the kernel for points of mixtures, unless that was done: before the first job of them.
    void prepare_mixtures() const;

  private:
    std::shared_ptr<Device> device_;
    FunctionSource source_;
    int dimensions_, components_;
    DeviceArray<double> parameters_;
    mutable std::mutex mutex_;
    std::unique_ptr<DeviceProgram> program_;
    mutable std::unique_ptr<DeviceProgram> mixture_program_;
    mutable DeviceArray<double> points_;
    mutable DeviceOutput<double> values_;
};

} // namespace montelux
