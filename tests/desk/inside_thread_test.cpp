#include "app/desk/inside_thread.h"

#include <gtest/gtest.h>

#include "tests/desk/desk_testing.h"
#include "tests/visualizers/visualizer_testing.h"

namespace sightlines {
namespace {

InsideRequest small_request() {
    InsideRequest request;
    request.picture = std::make_shared<const InsidePicture>(furnished_picture());
    request.size = {200, 150};
    return request;
}

TEST(InsideThread, DrawsWhatTheViewDrawsSharpInTheEnd) {
    Watch watch;
    InsideThread thread(watch.callback());
    const InsideRequest request = small_request();
    draw(thread, request);
    ASSERT_TRUE(watch.until([&] { return shown(thread) && shown(thread)->samples_per_axis == 2; }));
    EXPECT_EQ(shown(thread)->request, request);
    InsideView view;
    EXPECT_EQ(shown(thread)->pixels, render(view, *request.picture, request.state, {}, request.size, 2, 1.0f));
    EXPECT_EQ(shown(thread)->camera, shown_camera(*request.picture, request.state, request.size));
    EXPECT_EQ(failure(thread), "");
}

TEST(InsideThread, DrawsTheNewestOfManyRequests) {
    Watch watch;
    InsideThread thread(watch.callback());
    InsideRequest request = small_request();
    const OrbitCamera camera = shown_camera(*request.picture, request.state, request.size);
    for (int i = 0; i < 30; ++i) {
        request.state = turned(request.state, request.state.camera.value_or(camera), {2.0f, 0.0f});
        draw(thread, request);
    }
    ASSERT_TRUE(watch.until([&] {
        const auto now = shown(thread);
        return now && now->request == request && now->samples_per_axis == 2;
    }));
    InsideView view;
    EXPECT_EQ(shown(thread)->pixels, render(view, *request.picture, request.state, {}, request.size, 2, 1.0f));
}

TEST(InsideThread, StaysSharpWhereOnlyTheMarksChange) {
    Watch watch;
    InsideThread thread(watch.callback());
    InsideRequest request = small_request();
    draw(thread, request);
    ASSERT_TRUE(watch.until([&] { return shown(thread) && shown(thread)->samples_per_axis == 2; }));
    request.lit.step = {{"midpoint", TraceShape::point, {vec3(8.0f)}}};
    draw(thread, request);
    ASSERT_TRUE(watch.until([&] {
        EXPECT_EQ(shown(thread)->samples_per_axis, 2);
        return shown(thread)->request == request;
    }));
}

TEST(InsideThread, EndsWhileItDraws) {
    Watch watch;
    InsideThread thread(watch.callback());
    draw(thread, small_request());
}

}  // namespace
}  // namespace sightlines
