// Requests of pages: the good ones are read, all others are none.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>

#include "montelux/view/view_messages.h"

namespace montelux::testing {
namespace {

template <typename T>
T request(const std::string& text) {
    const std::optional<ViewRequest> r = parse_request(text);
    EXPECT_TRUE(r && std::holds_alternative<T>(*r)) << text;
    return r && std::holds_alternative<T>(*r) ? std::get<T>(*r) : T{};
}

TEST(ViewMessages, RequestsAreRead) {
    EXPECT_EQ(request<ShowRequest>(R"({"type":"show","layers":["mean","error"]})").layers,
              (std::vector<std::string>{"mean", "error"}));
    const auto pixel = request<PixelRequest>(R"({"type":"pixel","x":3,"y":7})");
    EXPECT_EQ(pixel.x, 3);
    EXPECT_EQ(pixel.y, 7);
    EXPECT_EQ(request<ReplayRequest>(R"({"type":"replay","x":3,"y":7,"sample":9})").sample, 9u);
    const auto limits = request<LimitsRequest>(R"({"type":"target","error":0.01,"time":null})");
    EXPECT_EQ(limits.error, 0.01);
    EXPECT_EQ(limits.time, 0);
    EXPECT_EQ(request<OrbitRequest>(R"({"type":"orbit","azimuth":-10,"elevation":5,"zoom":2})").orbit,
              (ViewOrbit{-10, 5, 2}));
    EXPECT_TRUE(request<LightGroupsRequest>(R"({"type":"light groups","on":true})").on);
    EXPECT_EQ(request<PlainRequest>(R"({"type":"pause"})"), PlainRequest::pause);
    EXPECT_EQ(request<PlainRequest>(R"({"type":"quit","more":1})"), PlainRequest::quit);
}

TEST(ViewMessages, OtherTextsAreNone) {
    const std::string deep(4000, '[');
    for (const std::string& text : {std::string(),
                                    std::string("x"),
                                    std::string("[]"),
                                    std::string("null"),
                                    std::string("{}"),
                                    deep,
                                    std::string(R"({"type":1})"),
                                    std::string(R"({"type":"no such"})"),
                                    std::string(R"({"type":"show"})"),
                                    std::string(R"({"type":"show","layers":"mean"})"),
                                    std::string(R"({"type":"show","layers":[1]})"),
                                    std::string(R"({"type":"pixel","x":-1,"y":0})"),
                                    std::string(R"({"type":"pixel","x":1.5,"y":0})"),
                                    std::string(R"({"type":"pixel","x":1e99,"y":0})"),
                                    std::string(R"({"type":"pixel","x":99999999,"y":0})"),
                                    std::string(R"({"type":"replay","x":1,"y":1,"sample":-1})"),
                                    std::string(R"({"type":"target","error":-1})"),
                                    std::string(R"({"type":"target","time":1e300})"),
                                    std::string(R"({"type":"target","error":"1%"})"),
                                    std::string(R"({"type":"orbit","azimuth":0,"elevation":0,"zoom":0})"),
                                    std::string(R"({"type":"orbit","azimuth":0,"elevation":0})"),
                                    std::string(R"({"type":"light groups","on":1})"),
                                    std::string("{\"type\":\"pause\"}{"),
                                    std::string("\xff\xfe{\"type\":\"pause\"}")})
        EXPECT_FALSE(parse_request(text)) << text.substr(0, 80);
}

TEST(ViewMessages, OutlinesKeepTheirLevels) {
    const auto json = nlohmann::json::parse(
        replay_message(1, 2, 3, "vertex 1\n  position   (0, 0)\n    weight 1\n\nend\n"));
    ASSERT_EQ(json["lines"].size(), 4u);
    EXPECT_EQ(json["lines"][1]["level"], 1);
    EXPECT_EQ(json["lines"][1]["text"], "position   (0, 0)");
    EXPECT_EQ(json["lines"][2]["level"], 2);
    EXPECT_EQ(json["lines"][3]["level"], 0);
    EXPECT_EQ(json["sample"], 3);
}

// Names in scenes may be in any encoding: a message is UTF-8 nevertheless.
TEST(ViewMessages, AreUtf8) {
    EXPECT_NO_THROW(nlohmann::json::parse(refused_message("replay", "\xff\xfe caf\xe9")));
}

TEST(ViewMessages, ProgressSaysWhatIsKnown) {
    ViewStatus status;
    auto json = nlohmann::json::parse(progress_message(status, nullptr));
    EXPECT_EQ(json["state"], "preparing");
    for (const char* name :
         {"error", "samples", "visible", "target_error", "target_time", "ended_by", "seconds_left"})
        EXPECT_TRUE(json[name].is_null()) << name;
    PictureStatistics early;
    early.error = 0.4;
    EXPECT_EQ(nlohmann::json::parse(progress_message(status, &early))["error"], 0.4);
    status.state = ViewState::ended;
    status.ended_by = RenderStop::time;
    status.target.error = 0.01;
    status.curve = {{1, 0.5}, {2, 0.25}};
    PictureStatistics statistics;
    statistics.histogram.counts[3] = 7;
    json = nlohmann::json::parse(progress_message(status, &statistics));
    EXPECT_EQ(json["state"], "ended");
    EXPECT_EQ(json["ended_by"], "time");
    EXPECT_EQ(json["error"], 0.25);
    EXPECT_EQ(json["target_error"], 0.01);
    EXPECT_EQ(json["curve"].size(), 2u);
    EXPECT_EQ(json["histogram"]["counts"][3], 7);
}

} // namespace
} // namespace montelux::testing
