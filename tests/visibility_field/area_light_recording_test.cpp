// The kernel of area lights as recording C++: what it would tell of a segment.
#include "shaders/recording.h"  // first: makes the kernel below record

#include "shaders/area_light.h"

#include <gtest/gtest.h>

namespace sightlines::visibility_field {
namespace {

TEST(AreaLightRecording, TellsWhyASegmentIsTracedAndWhatItBrings) {
    const recording_kernel::Recording recording;
    EXPECT_TRUE(recording_kernel::decide_segment(true, true, true).trace);
    EXPECT_TRUE(recording_kernel::decide_segment(true, false, false).trace);
    EXPECT_TRUE(recording_kernel::decide_segment(true, true, false).open);
    EXPECT_TRUE(recording_kernel::decide_segment(true, false, true).blocked);
    EXPECT_TRUE(recording_kernel::decide_segment(false, true, false).blocked);
    EXPECT_FLOAT_EQ(recording_kernel::segment_adds(vec3(2.0f), 0.5f, 0.5f, 2.0f, 0.25f).x, 0.5f);
    ASSERT_EQ(recording.steps.size(), 6u);
    EXPECT_EQ(recording.steps.front().values.size(), 6u);
    EXPECT_EQ(recording.steps.back().values.back().name, "adds");
}

}  // namespace
}  // namespace sightlines::visibility_field
