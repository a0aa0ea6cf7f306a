#include "test/denoise/denoise_testing.h"
#include <algorithm>
#include <map>

// The library's opaque types are ours to define in a program that it is not part of.
namespace montelux {
struct OidnDevice {};
struct OidnFilter {
    std::map<std::string, float*> images;
    std::size_t numbers = 0;
    std::string asked;
};
} // namespace montelux

namespace montelux::denoise_testing {

namespace {

StandIn* current = nullptr;

void called(const char* name) {
    if (current->fail_at == name) current->error = std::string(name) + " went wrong";
}

void execute(OidnFilter* filter) {
    called("execute_filter");
    current->runs.push_back(filter->asked);
    for (const auto& [name, pixels] : filter->images)
        if (name != "output") current->inputs.try_emplace(name, pixels, pixels + filter->numbers);
    for (const auto& [name, pixels] : filter->images)
        for (std::size_t i = 0; i < filter->numbers; ++i) {
            if (name == "output")
                pixels[i] = current->output;
            else if (!std::isfinite(pixels[i]) || (name == "color" && pixels[i] < 0))
                current->bad_input = true;
        }
}

} // namespace

OidnApi api_of(StandIn& stand_in) {
    current = &stand_in;
    OidnApi api;
    api.file = "stand-in";
    api.new_device = [](int) -> OidnDevice* {
        called("new_device");
        if (current->no_device) return nullptr;
        ++current->devices;
        return new OidnDevice;
    };
    api.release_device = [](OidnDevice* device) {
        --current->devices;
        delete device;
    };
    api.set_device_bool = [](OidnDevice*, const char* name, bool value) {
        if (name == std::string("setAffinity")) current->affinity = value;
    };
    api.set_device_int = [](OidnDevice*, const char* name, int value) {
        if (name == std::string("numThreads")) current->threads = value;
    };
    api.get_device_int = [](OidnDevice*, const char*) { return current->version; };
    api.commit_device = [](OidnDevice*) { called("commit_device"); };
    api.get_device_error = [](OidnDevice*, const char** message) {
        static std::string last;
        last = std::exchange(current->error, "");
        if (last.empty()) return 0;
        *message = last.c_str();
        return 2;
    };
    api.new_filter = [](OidnDevice*, const char* type) -> OidnFilter* {
        called("new_filter");
        if (current->no_filter) return nullptr;
        ++current->filters;
        auto* filter = new OidnFilter;
        filter->asked = type;
        return filter;
    };
    api.release_filter = [](OidnFilter* filter) {
        --current->filters;
        delete filter;
    };
    api.set_filter_image = [](OidnFilter* filter, const char* name, void* pixels, int, std::size_t width,
                              std::size_t height, std::size_t, std::size_t, std::size_t) {
        filter->images[name] = static_cast<float*>(pixels);
        filter->numbers = 3 * width * height;
        filter->asked += std::string(" ") + name;
    };
    api.set_filter_bool = [](OidnFilter* filter, const char* name, bool value) {
        filter->asked += std::string(" ") + name + (value ? "=1" : "=0");
    };
    api.commit_filter = [](OidnFilter*) { called("commit_filter"); };
    api.execute_filter = execute;
    return api;
}

} // namespace montelux::denoise_testing
