// Device arrays and the serialisation of threads, on a fake device with little memory and no compiler.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/device_memory.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class SmallDevice final : public Device {
  public:
    static constexpr std::size_t room = 100; // bytes of an array
    int held = 0;                            // arrays that are allocated

    // Largest number of simultaneous runs.
    int most_at_once() const { return most_; }

    std::string description() const override { return "a small device"; }
    std::unique_ptr<DeviceProgram> compile(const std::string&, const std::string&) override {
        return std::make_unique<Program>(*this);
    }
    void* allocate(std::size_t bytes) override {
        if (bytes > room) throw Error("small device", "there is no room");
        ++held;
        return ::operator new(bytes);
    }
    void release(void* memory) noexcept override {
        --held;
        ::operator delete(memory);
    }
    void* allocate_host(std::size_t bytes) override { return allocate(bytes); }
    void release_host(void* memory) noexcept override { release(memory); }
    void copy_in(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
    void copy_out(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }

  private:
    // The value at a point is its first coordinate.
    class Program final : public DeviceProgram {
      public:
        explicit Program(SmallDevice& device) : device_(device) {}
        void run(const DeviceJob& job) override {
            device_.wait_for_others();
            std::copy_n(job.given, job.count, job.values);
        }

      private:
        SmallDevice& device_;
    };

    // Waits long enough for other threads to enter, if nothing serialises them.
    void wait_for_others() {
        std::unique_lock lock(mutex_);
        most_ = std::max(most_, ++running_);
        changed_.notify_all();
        changed_.wait_for(lock, std::chrono::milliseconds(20), [this] { return most_ > 1; });
        --running_;
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    int running_ = 0, most_ = 0;
};

TEST(DeviceMemory, AnArrayThatCannotGrowIsEmpty) {
    const auto device = std::make_shared<SmallDevice>();
    {
        DeviceArray<double> array(device);
        DeviceOutput<double> output(device);
        for (int round = 0; round < 2; ++round) {
            ASSERT_NE(array.reserve(5), nullptr);
            ASSERT_NE(output.reserve(5), nullptr);
            ASSERT_NE(output.reserve_copies(5), nullptr);
            EXPECT_EQ(device->held, 3);
            EXPECT_THROW(array.reserve(1000), Error);
            EXPECT_THROW(output.reserve(1000), Error);
            EXPECT_THROW(output.reserve_copies(1000), Error);
            EXPECT_EQ(array.data(), nullptr);
            EXPECT_EQ(device->held, 0);
        }
        const std::vector<double> values{1, 2, 3};
        ASSERT_NE(array.reserve(3), nullptr);
        const double* const there = array.assign(values);
        EXPECT_EQ(std::vector<double>(there, there + 3), values);
    }
    EXPECT_EQ(device->held, 0);
}

TEST(DeviceMemory, ThreadsThatEvaluateAtPointsTakeTurns) {
    const auto device = std::make_shared<SmallDevice>();
    const DeviceFunction f(device, {.text = "not compiled"}, 1);
    const auto values_at = [&](double x) {
        const std::vector<double> points(4, x);
        std::vector<double> values(4);
        f.at(points.data(), 4, 4, values.data(), 4);
        return values;
    };
    EXPECT_EQ(values_at(7), std::vector<double>(4, 7)); // arrays grow here, not in the threads
    std::vector<std::vector<double>> found(3);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < found.size(); ++t)
        threads.emplace_back([&, t] { found[t] = values_at(static_cast<double>(t)); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(device->most_at_once(), 1);
    for (std::size_t t = 0; t < found.size(); ++t)
        EXPECT_EQ(found[t], std::vector<double>(4, static_cast<double>(t)));
}

} // namespace
} // namespace montelux
