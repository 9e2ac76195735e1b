#include "app/desk/history.h"

#include <gtest/gtest.h>

namespace sightlines {
namespace {

Session with_step(std::uint32_t step) {
    Session session;
    session.selection.step = step;
    return session;
}

TEST(History, UndoesAndRedoesInOrder) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), false);
    edit(history, with_step(2), false);
    undo(history);
    EXPECT_EQ(history.now, with_step(1));
    undo(history);
    EXPECT_EQ(history.now, with_step(0));
    EXPECT_FALSE(can_undo(history));
    redo(history);
    redo(history);
    EXPECT_EQ(history.now, with_step(2));
    EXPECT_FALSE(can_redo(history));
}

TEST(History, MakesOneStepOfAGesture) {
    History history{with_step(0), {}, {}};
    for (std::uint32_t step = 1; step < 10; ++step) edit(history, with_step(step), true);
    end_gesture(history);
    EXPECT_EQ(history.past.size(), 1u);
    undo(history);
    EXPECT_EQ(history.now, with_step(0));
}

TEST(History, KeepsTwoGesturesApart) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), true);
    edit(history, with_step(2), true);
    end_gesture(history);
    edit(history, with_step(3), true);
    end_gesture(history);
    undo(history);
    EXPECT_EQ(history.now, with_step(2));
    undo(history);
    EXPECT_EQ(history.now, with_step(0));
}

TEST(History, KeepsAnEditAfterAnOpenGestureApart) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), true);
    edit(history, with_step(2), false);
    undo(history);
    EXPECT_EQ(history.now, with_step(1));
}

TEST(History, ForgetsAGestureThatCameBackToWhereItBegan) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), true);
    edit(history, with_step(0), true);
    end_gesture(history);
    EXPECT_FALSE(can_undo(history));
}

TEST(History, ForgetsWhatWasUndoneOnceSomethingElseIsDone) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), false);
    undo(history);
    edit(history, with_step(2), false);
    EXPECT_FALSE(can_redo(history));
    undo(history);
    EXPECT_EQ(history.now, with_step(0));
}

TEST(History, TakesNoNoteOfAnEditThatChangesNothing) {
    History history{with_step(0), {}, {}};
    edit(history, with_step(1), false);
    undo(history);
    edit(history, with_step(0), false);
    EXPECT_TRUE(can_redo(history));
}

TEST(History, ForgetsTheOldestStepsFirst) {
    History history{with_step(0), {}, {}};
    for (std::uint32_t step = 1; step <= most_undo_steps + 10; ++step) edit(history, with_step(step), false);
    EXPECT_EQ(history.past.size(), most_undo_steps);
    EXPECT_EQ(history.past.front(), with_step(10));
}

}  // namespace
}  // namespace sightlines
