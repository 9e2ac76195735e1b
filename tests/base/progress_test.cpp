#include "techniques/base/progress.h"

#include <gtest/gtest.h>

#include "techniques/base/parallel.h"

namespace sightlines {
namespace {

TEST(Progress, TellsTheStageAndHowMuchOfItIsDone) {
    Progress progress;
    progress.begin("voxelising", 4);
    EXPECT_EQ(progress.stage(), "voxelising");
    EXPECT_EQ(progress.fraction(), 0.0);
    progress.advance();
    progress.advance(2);
    EXPECT_EQ(progress.fraction(), 0.75);
    progress.begin("rendering", 0);  // a stage without steps is no division by zero
    EXPECT_EQ(progress.fraction(), 0.0);
}

TEST(Progress, ThrowsAtTheNextStepOnceCancelled) {
    Progress progress;
    progress.begin("voxelising", 4);
    EXPECT_NO_THROW(progress.check());
    progress.cancel();
    EXPECT_TRUE(progress.cancelled());
    EXPECT_THROW(progress.check(), Cancelled);
    EXPECT_THROW(progress.advance(), Cancelled);
}

TEST(Progress, CountsStepsOfAllThreads) {
    Progress progress;
    progress.begin("tiles", 10000);
    parallel_for(10000, 2, [&](std::int64_t) { progress.advance(); });
    EXPECT_EQ(progress.fraction(), 1.0);
}

}  // namespace
}  // namespace sightlines
