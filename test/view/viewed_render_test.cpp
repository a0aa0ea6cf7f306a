// ViewedRender: what viewers ask of a render changes no bit of it, or restarts it.
#include "test/view/view_testing.h"
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <thread>

#include "montelux/mc/math/error.h"
#include "montelux/view/orbit_camera.h"
#include "montelux/view/viewed_render.h"

namespace montelux::testing {
namespace {

using namespace std::chrono_literals;

// Waits two minutes at most: a busy machine with sanitizers takes its time.
template <typename Condition>
bool eventually(const Condition& condition) {
    for (int i = 0; i < 12000; ++i, std::this_thread::sleep_for(10ms))
        if (condition()) return true;
    return false;
}

// A render on another thread, ended by the test at the latest.
class Watched {
  public:
    Watched(RenderSession& session, ViewedRenderSettings settings)
        : render(std::move(settings)), thread_([&] { last = &render.run(session, {}); }) {}
    ~Watched() { join(); }
    void join() {
        if (!thread_.joinable()) return;
        render.quit();
        thread_.join();
    }
    // Without asking it to end.
    void wait() { thread_.join(); }

    ViewedRender render;
    RenderSession* last = nullptr;

  private:
    std::thread thread_;
};

TEST(ViewedRender, PausesAndSnapshotsChangeNoBit) {
    for (const RenderTarget& target : {RenderTarget{}, RenderTarget{.error = 0.06, .adaptive = true}}) {
        const auto d = viewed_scene(target.error > 0 ? 4096 : 48);
        RenderSession plain(d, {.target = target}), session(d, {.target = target});
        plain.render();
        const RenderSnapshot expected = plain.finish();
        Watched watched(session, {});
        std::mt19937 random(1);
        int pauses = 0;
        while (watched.render.status().state != ViewState::ended && pauses < 200) {
            watched.render.pause();
            ++pauses;
            if (random() % 4 == 0) (void)watched.render.snapshot(0.5);
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
            watched.render.resume();
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
        }
        watched.wait();
        EXPECT_GT(pauses, 3);
        const RenderSnapshot finished = watched.last->finish();
        EXPECT_TRUE(same_bits(*expected.image, *finished.image));
        EXPECT_EQ(expected.report.stop, finished.report.stop);
        EXPECT_EQ(expected.report.samples, finished.report.samples);
    }
}

TEST(ViewedRender, AreAsWithoutViewersWhenTimeIsUp) {
    const auto d = viewed_scene(1u << 20);
    RenderSession session(d, {.target = {.time = 0.2}});
    Watched watched(session, {});
    watched.wait();
    EXPECT_EQ(watched.last->report().stop, RenderStop::time);
    // How many samples there are depends on the machine; two give an error.
    const RenderSnapshot finished = watched.last->finish();
    const std::size_t pixels = finished.image->pixel_count();
    EXPECT_GE(finished.report.samples, pixels);
    if (finished.report.samples >= 64 * pixels) {
        EXPECT_TRUE(std::isfinite(finished.error.relative));
    }
}

TEST(ViewedRender, ClockStandsStillWhilePaused) {
    const auto d = viewed_scene(1u << 20);
    RenderSession session(d, {.target = {.time = 0.5}});
    Watched watched(session, {});
    ASSERT_TRUE(eventually([&] { return watched.render.status().progress.seconds > 0.1; }));
    watched.render.pause();
    ASSERT_TRUE(eventually([&] { return watched.render.status().state == ViewState::paused; }));
    const auto snapshot = watched.render.snapshot(1);
    ASSERT_TRUE(snapshot);
    const double before = snapshot->report.seconds;
    EXPECT_LT(before, 0.5);
    std::this_thread::sleep_for(600ms);
    EXPECT_EQ(watched.render.snapshot(1)->report.seconds, before);
    EXPECT_EQ(watched.render.status().state, ViewState::paused);
    watched.render.resume();
    watched.wait();
    EXPECT_EQ(watched.last->report().stop, RenderStop::time);
}

TEST(ViewedRender, SnapshotsGoOnAfterAPause) {
    RenderSession session(viewed_scene(1u << 20), {});
    Watched watched(session, {});
    ASSERT_TRUE(eventually([&] { return watched.render.status().progress.samples_done > 0; }));
    watched.render.pause();
    ASSERT_TRUE(eventually([&] { return watched.render.status().state == ViewState::paused; }));
    const auto still = watched.render.snapshot(1);
    ASSERT_TRUE(still);
    watched.render.resume();
    ASSERT_TRUE(
        eventually([&] { return watched.render.status().progress.samples_done > still->report.samples; }));
    std::optional<RenderSnapshot> later;
    ASSERT_TRUE(eventually([&] { return (later = watched.render.snapshot(10)).has_value(); }));
    EXPECT_GT(later->report.samples, still->report.samples);
}

// A render to an error, stopped by a smaller one later, is the render to the smaller one.
TEST(ViewedRender, LimitsMayChange) {
    const auto d = viewed_scene(1u << 16);
    RenderSession plain(d, {.target = {.error = 0.06}}), session(d, {.target = {.error = 0.12}});
    plain.render();
    const RenderSnapshot expected = plain.finish();
    Watched watched(session, {.stays = true});
    ASSERT_TRUE(eventually([&] { return watched.render.status().ended_by == RenderStop::error; }));
    const auto first = watched.render.snapshot(1);
    ASSERT_TRUE(first);
    EXPECT_LE(first->error.relative, 0.12);
    EXPECT_GT(first->error.relative, 0.06);
    watched.render.set_limits(0.06, 0);
    ASSERT_TRUE(eventually([&] {
        const ViewStatus s = watched.render.status();
        return s.state == ViewState::ended && s.target.error == 0.06;
    }));
    watched.join();
    const RenderSnapshot finished = watched.last->finish();
    EXPECT_EQ(finished.report.stop, RenderStop::error);
    EXPECT_TRUE(same_bits(*expected.image, *finished.image));
    EXPECT_EQ(finished.image->attributes().at("targetError"), Attribute(0.06f));
}

TEST(ViewedRender, TimeMayBeExtended) {
    RenderSession session(viewed_scene(1u << 20), {.target = {.time = 0.1}});
    Watched watched(session, {.stays = true});
    ASSERT_TRUE(eventually([&] { return watched.render.status().ended_by == RenderStop::time; }));
    const std::uint64_t before = watched.render.snapshot(1)->report.samples;
    watched.render.set_limits(0, 0.3);
    ASSERT_TRUE(eventually([&] {
        const ViewStatus s = watched.render.status();
        return s.state == ViewState::ended && s.progress.seconds >= 0.3;
    }));
    EXPECT_GT(watched.render.snapshot(1)->report.samples, before);
}

TEST(ViewedRender, StopKeepsThePictureAndMayBeUndone) {
    const auto d = viewed_scene(48);
    RenderSession plain(d, {}), session(d, {});
    plain.render();
    Watched watched(session, {.stays = true});
    watched.render.stop();
    ASSERT_TRUE(eventually([&] { return watched.render.status().state == ViewState::ended; }));
    watched.render.resume();
    ASSERT_TRUE(eventually([&] { return watched.render.status().ended_by == RenderStop::samples; }));
    watched.join();
    EXPECT_TRUE(same_bits(*plain.finish().image, *watched.last->finish().image));
}

TEST(ViewedRender, CancelOfTheProgramEndsItAlsoWhilePaused) {
    CancelFlag cancel;
    RenderSession session(viewed_scene(1u << 20), {});
    Watched watched(session, {.stays = true, .cancel = &cancel});
    ASSERT_TRUE(eventually([&] { return watched.render.status().progress.samples_done > 0; }));
    watched.render.pause();
    ASSERT_TRUE(eventually([&] { return watched.render.status().state == ViewState::paused; }));
    cancel.request();
    watched.render.poll();
    watched.wait();
    EXPECT_TRUE(watched.last->report().cancelled());
    EXPECT_FALSE(watched.render.snapshot(0.1) && !watched.render.snapshot(0.1)->image);
    EXPECT_THROW(watched.render.replay(0, 0, 0), Error);
}

TEST(ViewedRender, ReplaysAreThoseOfTheRender) {
    RenderSession session(viewed_scene(1u << 20), {});
    Watched watched(session, {});
    ASSERT_TRUE(eventually([&] { return watched.render.status().progress.samples_done > 0; }));
    const std::string text = watched.render.replay(20, 12, 7);
    EXPECT_NE(text.find("sample 7 of"), std::string::npos);
    EXPECT_NE(text.find("pixel 20,12"), std::string::npos);
    EXPECT_NE(text.find("vertex 1"), std::string::npos);
    EXPECT_THROW(watched.render.replay(40, 0, 0), Error);
}

// A restart is the render of the scene with the camera elsewhere.
TEST(ViewedRender, RestartsWithAnotherCamera) {
    const auto d = viewed_scene(48);
    const CameraSettings camera = d->scene.camera;
    auto session = std::make_unique<RenderSession>(d, RenderSessionSettings{});
    ViewedRenderSettings settings{.stays = true};
    settings.restart = [&](const ViewChange& change) -> RenderSession& {
        const auto prepared = session->renderer().prepared();
        const Vec3d pivot = orbit_pivot(session->renderer());
        session.reset();
        d->scene.camera = orbited(camera, pivot, change.orbit);
        session = std::make_unique<RenderSession>(d, RenderSessionSettings{.prepared = prepared});
        return *session;
    };
    Watched watched(*session, settings);
    ASSERT_TRUE(eventually([&] { return watched.render.picture() != nullptr; }));
    const ViewChange change{{30, 10, 1.25}, false};
    watched.render.change(change);
    ASSERT_TRUE(eventually([&] {
        const ViewStatus s = watched.render.status();
        return s.epoch == 1 && s.state == ViewState::ended;
    }));
    const auto seen = watched.render.snapshot(1);
    ASSERT_TRUE(seen);
    EXPECT_EQ(watched.render.status().change, change);
    watched.join();
    const auto copy = std::make_shared<SceneDescription>(*d); // with tables of its own
    RenderSession plain(copy, {});
    plain.render();
    EXPECT_TRUE(same_bits(*plain.finish().image, *seen->image));
}

TEST(ViewedRender, WithoutRestartChangesAreRefused) {
    ViewedRender render({});
    EXPECT_THROW(render.change({{10, 0, 1}, false}), Error);
}

Vec3d eye_of(const CameraSettings& camera) { return camera.world_from_camera.point(Vec3d{0, 0, 0}); }

TEST(OrbitCamera, TurnsAboutWhatItLooksAt) {
    for (const bool mirrored : {false, true}) {
        CameraSettings camera;
        camera.world_from_camera = Transform::look_at({0, 1, -5}, {0, 1, 0}, {0, 1, 0})->inverse();
        if (mirrored) camera.world_from_camera = camera.world_from_camera * Transform::scale({-1, 1, 1});
        const Vec3d pivot{0, 1, 0}, right = camera.world_from_camera.vector(Vec3d{1, 0, 0});
        const CameraSettings turned = orbited(camera, pivot, {90, 0, 1});
        EXPECT_NEAR(length(eye_of(turned) - (pivot + 5.0 * right)), 0, 1e-9) << mirrored;
        // It still looks at the point, and is upright.
        EXPECT_NEAR(length(turned.world_from_camera.point(Vec3d{0, 0, 5}) - pivot), 0, 1e-9);
        EXPECT_NEAR(turned.world_from_camera.vector(Vec3d{0, 1, 0}).y, 1, 1e-9);
        EXPECT_EQ(turned.world_from_camera.swaps_handedness(), camera.world_from_camera.swaps_handedness());
        const CameraSettings raised = orbited(camera, pivot, {0, 30, 1});
        EXPECT_NEAR(eye_of(raised).y, 1 + 5 * 0.5, 1e-9);
        const CameraSettings nearer = orbited(camera, pivot, {40, 20, 2});
        EXPECT_NEAR(length(eye_of(nearer) - pivot), 2.5, 1e-9);
        EXPECT_NEAR(length(nearer.world_from_camera.point(Vec3d{0, 0, 2.5}) - pivot), 0, 1e-9);
    }
    const CameraSettings still = orbited({}, {0, 0, 1}, {});
    EXPECT_EQ(eye_of(still), (Vec3d{0, 0, 0}));
}

// A camera that moves by 2 to its right and 1 forwards while the shutter is open.
TEST(OrbitCamera, TurnsTheMotionOfTheCamera) {
    CameraSettings camera;
    camera.world_from_camera = Transform::look_at({0, 1, -5}, {0, 1, 0}, {0, 1, 0})->inverse();
    const Vec3d pivot{0, 1, 0}, right = camera.world_from_camera.vector(Vec3d{1, 0, 0}), forward{0, 0, 1};
    camera.motion.emplace(camera.world_from_camera,
                          Transform::translate(2.0 * right + forward) * camera.world_from_camera);
    const CameraSettings turned = orbited(camera, pivot, {90, 0, 1});
    ASSERT_TRUE(turned.motion);
    // From where it stands now its right is what was forward, and forward what was its left.
    const Vec3d start = pivot + 5.0 * right, end = start + 2.0 * forward - right;
    EXPECT_NEAR(length(turned.motion->start().point(Vec3d{0, 0, 0}) - start), 0, 1e-9);
    EXPECT_NEAR(length(turned.motion->end().point(Vec3d{0, 0, 0}) - end), 0, 1e-9);
    EXPECT_NEAR(length(turned.motion->end().vector(Vec3d{0, 0, 1}) + right), 0, 1e-9);
    EXPECT_FALSE(orbited(CameraSettings{}, pivot, {90, 0, 1}).motion);
}

} // namespace
} // namespace montelux::testing
