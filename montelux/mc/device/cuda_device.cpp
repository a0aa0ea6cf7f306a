#include <array>
#include <utility>

#include "montelux/mc/device/cuda_driver.h"
#include "montelux/mc/device/device.h"
#include "montelux/mc/device/nvrtc.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

CudaDriver::Pointer address(const void* memory) {
    return static_cast<CudaDriver::Pointer>(reinterpret_cast<std::uintptr_t>(memory));
}

// The driver, and the primary context of a GPU, which other libraries of the process share.
class CudaContextOwner {
  public:
    CudaContextOwner() {
        const CudaDriver::Result started = driver.init(0);
        int count = 0;
        if (started == CudaDriver::no_device ||
            (started == 0 && driver.device_count(&count) == 0 && count == 0))
            throw Error("device 'cuda'", "the NVIDIA driver shows no GPU (CUDA_VISIBLE_DEVICES may hide it)");
        if (started == CudaDriver::system_driver_mismatch)
            throw Error("device 'cuda'",
                        "the NVIDIA driver and its library have different versions; restart the machine");
        driver.check(started, "the driver cannot be started");
        driver.check(driver.device(&number, 0), "the first GPU cannot be opened");
        std::array<char, 256> text{};
        driver.check(driver.device_name(text.data(), static_cast<int>(text.size()) - 1, number),
                     "the GPU's name cannot be read");
        name = text.data();
        int major = 0, minor = 0;
        driver.check(driver.device_attribute(&major, CudaDriver::capability_major, number),
                     "the GPU's compute capability cannot be read");
        driver.check(driver.device_attribute(&minor, CudaDriver::capability_minor, number),
                     "the GPU's compute capability cannot be read");
        architecture = 10 * major + minor;
        driver.check(driver.retain_context(&context_, number), "no context can be made on the GPU");
    }
    ~CudaContextOwner() { driver.release_context(number); }
    CudaContextOwner(const CudaContextOwner&) = delete;
    CudaContextOwner& operator=(const CudaContextOwner&) = delete;

    // Calls of the driver concern the current context of the calling thread. This one is current while a Visit lives;
    // then the caller's is again, which may be another library's.
    class Visit {
      public:
        explicit Visit(const CudaContextOwner& cuda)
            : driver_(cuda.driver), result_(driver_.push_context(cuda.context_)) {}
        ~Visit() {
            CudaDriver::Context left = nullptr;
            // After a failed push there is nothing to pop, unless it reports the failure of an earlier launch and
            // pushed all the same: the driver does not say. The context, whose every call fails then, stays current.
            if (entered()) driver_.pop_context(&left);
        }
        Visit(const Visit&) = delete;
        Visit& operator=(const Visit&) = delete;
        bool entered() const { return result_ == 0; }
        void check() const { driver_.check(result_, "the GPU's context cannot be entered"); }

      private:
        const CudaDriver& driver_;
        CudaDriver::Result result_;
    };

    CudaDriver driver;
    CudaDriver::DeviceNumber number = 0;
    std::string name;
    int architecture = 0;

  private:
    CudaDriver::Context context_ = nullptr;
};

class CudaProgram final : public DeviceProgram {
  public:
    CudaProgram(std::shared_ptr<const CudaContextOwner> cuda, const std::string& image)
        : cuda_(std::move(cuda)) {
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        const CudaDriver::Result loaded = cuda_->driver.load_module(&module_, image.data());
        if (loaded == CudaDriver::unsupported_ptx || loaded == CudaDriver::no_binary ||
            loaded == CudaDriver::invalid_ptx)
            throw Error("device 'cuda'",
                        "the NVIDIA driver is too old for the code that this NVRTC makes; update the "
                        "driver, or name an older NVRTC in MONTELUX_NVRTC");
        cuda_->driver.check(loaded, "the kernels cannot be loaded");
        CudaDriver::Result found = cuda_->driver.find_function(&evaluate_, module_, "montelux_evaluate");
        if (found == 0) found = cuda_->driver.find_function(&summarise_, module_, "montelux_summarise");
        if (found != 0) cuda_->driver.unload_module(module_);
        cuda_->driver.check(found, "the kernels cannot be found");
    }
    ~CudaProgram() override {
        if (const CudaContextOwner::Visit visit(*cuda_); visit.entered())
            cuda_->driver.unload_module(module_);
    }
    CudaProgram(const CudaProgram&) = delete;
    CudaProgram& operator=(const CudaProgram&) = delete;

    void run(const DeviceJob& job) override {
        if (job.count == 0) return;
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        launch(evaluate_, job, job.count, device_block_threads);
        if (job.summaries != nullptr) launch(summarise_, job, job.batches, device_summary_threads);
        const CudaDriver::Result ended = cuda_->driver.synchronise();
        cuda_->driver.check(ended, ended == CudaDriver::launch_timeout
                                       ? "a kernel was stopped, because this GPU also drives a screen, which "
                                         "limits the time of a kernel; use another GPU"
                                       : "a kernel failed; does the integrand stay in its arrays?");
    }

  private:
    void launch(CudaDriver::Function kernel, DeviceJob job, unsigned long long all, unsigned int threads) {
        std::array<void*, 1> parameters{&job};
        cuda_->driver.check(cuda_->driver.launch(kernel, device_blocks(all, threads), 1, 1, threads, 1, 1, 0,
                                                 nullptr, parameters.data(), nullptr),
                            "a kernel cannot be started");
    }

    std::shared_ptr<const CudaContextOwner> cuda_;
    CudaDriver::Module module_ = nullptr;
    CudaDriver::Function evaluate_ = nullptr, summarise_ = nullptr;
};

class CudaDevice final : public Device {
  public:
    std::string description() const override {
        return cuda_->name + ", compute capability " + std::to_string(cuda_->architecture / 10) + "." +
               std::to_string(cuda_->architecture % 10);
    }
    std::unique_ptr<DeviceProgram> compile(const std::string& source, const std::string& file) override {
        return std::make_unique<CudaProgram>(cuda_, nvrtc_.compile(source, file, cuda_->architecture));
    }

    void* allocate(std::size_t bytes) override {
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        CudaDriver::Pointer memory = 0;
        check_memory(cuda_->driver.allocate(&memory, bytes), bytes, "the GPU");
        // The driver's addresses are integers.
        return reinterpret_cast<void*>(std::uintptr_t{memory}); // NOLINT(performance-no-int-to-ptr)
    }
    void release(void* memory) noexcept override {
        if (const CudaContextOwner::Visit visit(*cuda_); visit.entered())
            cuda_->driver.release(address(memory));
    }
    void* allocate_host(std::size_t bytes) override {
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        void* memory = nullptr;
        check_memory(cuda_->driver.allocate_host(&memory, bytes), bytes, "the processor, for copies");
        return memory;
    }
    void release_host(void* memory) noexcept override {
        if (const CudaContextOwner::Visit visit(*cuda_); visit.entered()) cuda_->driver.release_host(memory);
    }
    void copy_in(void* to, const void* from, std::size_t bytes) override {
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        cuda_->driver.check(cuda_->driver.copy_in(address(to), from, bytes),
                            "numbers cannot be copied to the GPU");
    }
    void copy_out(void* to, const void* from, std::size_t bytes) override {
        const CudaContextOwner::Visit visit(*cuda_);
        visit.check();
        cuda_->driver.check(cuda_->driver.copy_out(to, address(from), bytes),
                            "numbers cannot be copied from the GPU");
    }

  private:
    void check_memory(CudaDriver::Result result, std::size_t bytes, const std::string& where) const {
        if (result == CudaDriver::out_of_memory)
            throw Error("device 'cuda'",
                        "there is no memory for " + std::to_string(bytes) + " bytes on " + where);
        cuda_->driver.check(result, "memory cannot be allocated on " + where);
    }

    std::shared_ptr<const CudaContextOwner> cuda_ = std::make_shared<CudaContextOwner>();
    Nvrtc nvrtc_;
};

} // namespace

std::shared_ptr<Device> open_cuda_device() { return std::make_shared<CudaDevice>(); }

} // namespace montelux
