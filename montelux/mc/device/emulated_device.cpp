#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "montelux/mc/device/device.h"
#include "montelux/mc/io/shared_library.h"
#include "montelux/mc/io/system_compiler.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

class EmulatedProgram final : public DeviceProgram {
  public:
    explicit EmulatedProgram(SharedLibrary library) : library_(std::move(library)) {
        run_ = find("montelux_run_grid");
        summarise_ = find("montelux_run_summaries");
    }
    void run(const DeviceJob& job) override {
        run_(&job, device_blocks(job.count, device_block_threads), device_block_threads, normal_quantile);
        if (job.summaries != nullptr)
            summarise_(&job, device_blocks(job.batches, device_summary_threads), device_summary_threads,
                       normal_quantile);
    }

  private:
    using RunGrid = void (*)(const DeviceJob*, unsigned int, unsigned int, double (*quantile)(double));

    RunGrid find(const std::string& name) const {
        if (const auto found = library_.find<RunGrid>(name.c_str())) return found;
        throw Error("emulated device", "the compiled kernels have no " + name);
    }

    SharedLibrary library_;
    RunGrid run_, summarise_;
};

class EmulatedDevice final : public Device {
  public:
    std::string description() const override { return "emulation by one thread of the processor"; }
    std::unique_ptr<DeviceProgram> compile(const std::string& source, const std::string& file) override {
        const BuildFolder folder;
        const std::string text = (folder.path() / "kernel.cpp").string();
        if (!(std::ofstream(text) << source).flush())
            throw Error(text, "cannot be written; set TMPDIR to a folder with more room");
        const std::string library = (folder.path() / "kernel.so").string();
        montelux::compile({.source = text,
                           .library = library,
                           .language = Compilation::Language::cpp,
                           .messages = Compilation::Messages::in_error,
                           .options = {"-std=c++17"},
                           // Arithmetic as written, whatever the user's flags are.
                           .overrides = {"-fno-fast-math", "-ffp-contract=off"},
                           .name = file});
        std::string reason;
        std::optional<SharedLibrary> opened = SharedLibrary::open(library, reason);
        if (!opened) throw Error(file, "its kernels cannot be loaded: " + reason);
        return std::make_unique<EmulatedProgram>(std::move(*opened));
    }

    void* allocate(std::size_t bytes) override {
        if (void* memory = std::malloc(bytes)) return memory;
        throw Error("emulated device", "there is no memory for " + std::to_string(bytes) + " bytes");
    }
    void release(void* memory) noexcept override { std::free(memory); }
    void* allocate_host(std::size_t bytes) override { return allocate(bytes); }
    void release_host(void* memory) noexcept override { std::free(memory); }
    void copy_in(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
    void copy_out(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
};

} // namespace

std::shared_ptr<Device> open_emulated_device() { return std::make_shared<EmulatedDevice>(); }

} // namespace montelux
