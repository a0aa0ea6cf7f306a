#include "montelux/view/view_messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace montelux {

namespace {

using Json = nlohmann::json;

constexpr std::string_view name_of(ViewState state) {
    switch (state) {
    case ViewState::preparing:
        return "preparing";
    case ViewState::rendering:
        return "rendering";
    case ViewState::paused:
        return "paused";
    case ViewState::ended:
        break;
    }
    return "ended";
}

// JSON has no infinite numbers.
Json number(float v) {
    if (std::isfinite(v)) return v;
    return std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf";
}
template <typename Values>
Json numbers(const Values& values) {
    Json list = Json::array();
    for (const float v : values) list.push_back(number(v));
    return list;
}
Json positive_or_null(double v) { return v > 0 ? Json(v) : Json(nullptr); }

// Names in scenes may be in any encoding.
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

} // namespace

std::string scene_message(const ViewIntroduction& introduction, const ViewedRender& render,
                          const LivePicture& picture, const ViewStatus& status) {
    Json layers = Json::array(), lights = Json::array();
    for (const ViewLayer& layer : picture.layers()) {
        layers.push_back({{"name", layer.name},
                          {"kind", layer.kind},
                          {"channels", layer.channels},
                          {"format", layer.exact ? "float" : "half"}});
        constexpr std::string_view prefix = "light ";
        if (layer.name.starts_with(prefix)) lights.push_back(layer.name.substr(prefix.size()));
    }
    const bool restarts = render.settings().restart != nullptr;
    return dump({{"type", "scene"},
                 {"epoch", status.epoch},
                 {"name", introduction.name},
                 {"width", picture.bounds().width()},
                 {"height", picture.bounds().height()},
                 {"x0", picture.bounds().x0},
                 {"y0", picture.bounds().y0},
                 {"layers", std::move(layers)},
                 {"lights", std::move(lights)},
                 {"reference", render.settings().reference != nullptr},
                 {"stays", render.settings().stays},
                 {"can_orbit", restarts},
                 {"orbit",
                  {{"azimuth", status.change.orbit.azimuth},
                   {"elevation", status.change.orbit.elevation},
                   {"zoom", status.change.orbit.zoom}}},
                 {"can_group_lights", restarts},
                 {"exposure", introduction.exposure ? Json(*introduction.exposure) : Json(nullptr)},
                 {"tone", tone_names()[static_cast<std::size_t>(introduction.tone)]},
                 {"spp", introduction.spp}});
}

std::string progress_message(const ViewStatus& status, const PictureStatistics* statistics) {
    const RenderProgress& p = status.progress;
    Json message = {
        {"type", "progress"},
        {"epoch", status.epoch},
        {"state", name_of(status.state)},
        {"seconds", p.seconds},
        {"samples", nullptr},
        {"share", p.forecast.share},
        {"seconds_left", p.forecast.seconds_left ? Json(*p.forecast.seconds_left) : Json(nullptr)},
        {"error", nullptr},
        {"visible", nullptr},
        {"target_error", positive_or_null(status.target.error)},
        {"target_quantile", positive_or_null(status.target.quantile)},
        {"target_time", positive_or_null(status.target.time)},
        {"ended_by", status.ended_by ? Json(to_string(*status.ended_by)) : Json(nullptr)},
        {"samples_per_second",
         p.seconds > 0 ? Json(static_cast<double>(p.samples_done) / p.seconds) : Json(nullptr)}};
    Json curve = Json::array();
    for (const auto& [seconds, error] : status.curve) curve.push_back({seconds, error});
    message["curve"] = std::move(curve);
    if (!status.curve.empty()) message["error"] = status.curve.back().second;
    if (statistics != nullptr) {
        // Before the first whole replicates of all pixels.
        if (status.curve.empty() && statistics->error && !(status.target.quantile > 0))
            message["error"] = *statistics->error;
        message["samples"] = statistics->samples;
        message["visible"] = statistics->visible;
        message["histogram"] = {{"least", ErrorHistogram::least},
                                {"most", ErrorHistogram::most},
                                {"counts", statistics->histogram.counts},
                                {"infinite", statistics->histogram.infinite}};
    }
    return dump(message);
}

std::string pixel_message(const LivePicture& picture, int x, int y) {
    const LivePixel pixel = picture.pixel(x, y);
    Json layers = Json::object();
    for (std::size_t i = 0; i < picture.layers().size(); ++i)
        if (const std::vector<float> values = picture.values(i, x, y); !values.empty())
            layers[picture.layers()[i].name] = numbers(values);
    return dump({{"type", "pixel"},
                 {"x", x},
                 {"y", y},
                 {"mean", numbers(pixel.mean)},
                 {"error", numbers(pixel.error)},
                 {"samples", number(pixel.samples)},
                 {"layers", std::move(layers)}});
}

std::string replay_message(int x, int y, std::uint64_t sample, std::string_view outline) {
    Json lines = Json::array();
    while (!outline.empty()) {
        std::string_view line = outline.substr(0, outline.find('\n'));
        outline.remove_prefix(std::min(outline.size(), line.size() + 1));
        if (line.empty()) continue;
        const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
        line.remove_prefix(indent);
        lines.push_back({{"level", indent / 2}, {"text", line}});
    }
    return dump({{"type", "replay"}, {"x", x}, {"y", y}, {"sample", sample}, {"lines", std::move(lines)}});
}

std::string refused_message(std::string_view request, std::string_view why) {
    return dump({{"type", "refused"}, {"request", request}, {"why", why}});
}
std::string goodbye_message(std::string_view why) { return dump({{"type", "goodbye"}, {"why", why}}); }

namespace {

constexpr std::size_t most_shown = 64; // layers at once
constexpr double most_time = 1e9;      // seconds

// Reads members of a request; `good` becomes false at one that is missing, of another type or out of bounds.
class Members {
  public:
    explicit Members(const Json& json) : json_(json) {}

    bool good() const { return good_; }
    double real(const char* name, double least, double most) {
        const Json* const value = find(name);
        if (value == nullptr || !value->is_number()) return fail(0.0);
        const auto v = value->get<double>();
        return v >= least && v <= most ? v : fail(0.0);
    }
    // null and a missing member: 0.
    double real_or_none(const char* name, double most) {
        const Json* const value = find(name);
        return value == nullptr || value->is_null() ? 0 : real(name, 0, most);
    }
    std::uint64_t whole(const char* name, std::uint64_t most) {
        const Json* const value = find(name);
        if (value == nullptr || !value->is_number_unsigned()) return fail(std::uint64_t{0});
        const auto v = value->get<std::uint64_t>();
        return v <= most ? v : fail(std::uint64_t{0});
    }
    bool boolean(const char* name) {
        const Json* const value = find(name);
        return value != nullptr && value->is_boolean() ? value->get<bool>() : fail(false);
    }
    std::vector<std::string> texts(const char* name) {
        const Json* const value = find(name);
        if (value == nullptr || !value->is_array() || value->size() > most_shown)
            return fail(std::vector<std::string>());
        std::vector<std::string> list;
        for (const Json& text : *value) {
            if (!text.is_string()) return fail(std::vector<std::string>());
            list.push_back(text.get<std::string>());
        }
        return list;
    }

  private:
    const Json* find(const char* name) const {
        const auto found = json_.find(name);
        return found == json_.end() ? nullptr : &*found;
    }
    template <typename T>
    T fail(T value) {
        good_ = false;
        return value;
    }

    const Json& json_;
    bool good_ = true;
};

std::optional<ViewRequest> request_of(std::string_view type, Members& m) {
    const auto pixel = [&](const char* name) {
        return static_cast<int>(m.whole(name, Image::max_dimension));
    };
    if (type == "show") return ShowRequest{m.texts("layers")};
    if (type == "pixel") return PixelRequest{pixel("x"), pixel("y")};
    if (type == "replay") return ReplayRequest{pixel("x"), pixel("y"), m.whole("sample", 1u << 31)};
    if (type == "target")
        return LimitsRequest{m.real_or_none("error", 1e6), m.real_or_none("time", most_time)};
    if (type == "orbit")
        return OrbitRequest{
            {m.real("azimuth", -1e6, 1e6), m.real("elevation", -180, 180), m.real("zoom", 1e-3, 1e3)}};
    if (type == "light groups") return LightGroupsRequest{m.boolean("on")};
    if (type == "pause") return PlainRequest::pause;
    if (type == "resume") return PlainRequest::resume;
    if (type == "stop") return PlainRequest::stop;
    if (type == "quit") return PlainRequest::quit;
    return std::nullopt;
}

} // namespace

std::optional<ViewRequest> parse_request(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    const auto type = json.find("type");
    if (type == json.end() || !type->is_string()) return std::nullopt;
    Members members(json);
    std::optional<ViewRequest> request = request_of(type->get_ref<const std::string&>(), members);
    return members.good() ? request : std::nullopt;
}

} // namespace montelux
