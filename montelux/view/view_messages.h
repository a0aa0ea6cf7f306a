// The texts of docs/view-protocol.md: what the viewer's program and page tell each other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "montelux/view/picture_statistics.h"
#include "montelux/view/viewed_render.h"

namespace montelux {

// The fixed properties of a render, sent to a page when it connects.
struct ViewIntroduction {
    std::string name; // of the scene
    std::uint32_t spp = 0;
    std::optional<float> exposure{}; // stops; empty: the page chooses
    ToneKind tone = ToneKind::srgb;
};

std::string scene_message(const ViewIntroduction& introduction, const ViewedRender& render,
                          const LivePicture& picture, const ViewStatus& status);
// `statistics`: of the picture as it is, or a little older; null before the first ones.
std::string progress_message(const ViewStatus& status, const PictureStatistics* statistics);
std::string pixel_message(const LivePicture& picture, int x, int y);
std::string replay_message(int x, int y, std::uint64_t sample, std::string_view outline);
std::string refused_message(std::string_view request, std::string_view why);
std::string goodbye_message(std::string_view why);

struct ShowRequest {
    std::vector<std::string> layers;
};
struct PixelRequest {
    int x = 0, y = 0;
};
struct ReplayRequest {
    int x = 0, y = 0;
    std::uint64_t sample = 0;
};
struct LimitsRequest {
    double error = 0, time = 0; // 0: none
};
struct OrbitRequest {
    ViewOrbit orbit;
};
struct LightGroupsRequest {
    bool on = false;
};
enum class PlainRequest : std::uint8_t { pause, resume, stop, quit };
using ViewRequest = std::variant<ShowRequest, PixelRequest, ReplayRequest, LimitsRequest, OrbitRequest,
                                 LightGroupsRequest, PlainRequest>;

// Empty for a text that is not a request of the protocol. Numbers are finite, and those that have bounds within them.
std::optional<ViewRequest> parse_request(std::string_view text);

} // namespace montelux
