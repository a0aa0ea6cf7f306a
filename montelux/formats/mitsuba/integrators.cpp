#include "montelux/formats/mitsuba/integrators.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace montelux::mitsuba {
namespace {

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
    return std::ranges::find(names, name) != names.end();
}

constexpr auto paths = std::to_array<std::string_view>({"path", "volpath", "volpathmis", "depth", "ptracer"});
constexpr auto volumetric = std::to_array<std::string_view>({"volpath", "volpathmis"});
constexpr auto wrappers = std::to_array<std::string_view>({"aov", "moment"});

// Mitsuba counts the segments of a path, from the camera to the light: one event fewer scatters.
void read_path(Plugin& plugin, IntegratorSettings& settings) {
    const std::int64_t segments = plugin.integer("max_depth", -1, -1);
    if (segments == 0) plugin.error("'max_depth' is 0, which shows nothing; expected -1 or at least 1");
    settings.max_depth = segments < 0
                             ? unlimited_depth
                             : static_cast<int>(std::min<std::int64_t>(segments - 1, unlimited_depth));
    plugin.skip("rr_depth"); // when Russian roulette begins: without effect on the mean
    if (plugin.type() == "depth" || plugin.type() == "ptracer")
        plugin.warn(plugin.describe() + " is replaced by paths from the camera");
    if (plugin.type() == "volpathmis") plugin.skip("use_spectral_mis");
    settings.count_passages = !is_one_of(plugin.type(), volumetric);
}

void read_direct(Plugin& plugin, IntegratorSettings& settings) {
    constexpr std::int64_t most = std::int64_t{1} << 32;
    const std::int64_t both = plugin.integer("shading_samples", 1, 0, most);
    const std::int64_t lights = plugin.integer("emitter_samples", both, 0, most),
                       surfaces = plugin.integer("bsdf_samples", both, 0, most);
    if (lights == 0 && surfaces == 0)
        plugin.error("'emitter_samples' and 'bsdf_samples' are both 0; expected a sample of at least one");
    settings.max_depth = 1;
    if (lights == 0) settings.strategy = Strategy::bsdf;
    if (surfaces == 0) settings.strategy = Strategy::light;
}

} // namespace

void read_integrator(Plugin plugin, IntegratorSettings& settings) {
    if (is_one_of(plugin.type(), wrappers)) {
        const std::vector<Plugin> inner = plugin.children("integrator");
        if (inner.size() != 1)
            plugin.error(plugin.describe() + " has " + std::to_string(inner.size()) +
                         " integrators within; expected one");
        if (plugin.type() == "aov") {
            plugin.warn("the layers of the integrator 'aov' are chosen by --layers");
            plugin.skip("aovs");
        }
        for (const char* name : {"block_size", "samples_per_pass", "timeout", "hide_emitters"})
            plugin.skip(name);
        plugin.finish();
        return read_integrator(inner.front(), settings);
    }
    if (is_one_of(plugin.type(), paths))
        read_path(plugin, settings);
    else if (plugin.type() == "direct")
        read_direct(plugin, settings);
    else
        plugin.refuse();
    if (plugin.flag("hide_emitters", false)) {
        settings.background = Vec3f(0, 0, 0);
        plugin.warn("'hide_emitters' hides the environment; surfaces that shine stay visible");
    }
    for (const char* name : {"block_size", "samples_per_pass", "timeout"}) plugin.skip(name);
    plugin.finish();
}

} // namespace montelux::mitsuba
