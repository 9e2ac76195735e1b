#include "app/workbench/actions.h"

#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "app/workbench/panes.h"

namespace sightlines {
namespace {

TEST(Actions, HaveAKeyOfTheirOwnAndAPlaceInTheList) {
    std::set<std::tuple<int, bool, bool>> taken;
    for (const Action& action : actions()) {
        EXPECT_NE(action.key.key, 0) << action.title;
        for (const KeyPress& key : {action.key, action.other_key})
            EXPECT_TRUE(key.key == 0 || taken.insert({key.key, key.control, key.shift}).second)
                << action.title << " shares a key";
        EXPECT_FALSE(keys_text(action).empty());
        EXPECT_FALSE(action.group.empty());
    }
}

TEST(Actions, AreFoundByTheirName) {
    for (const Action& action : actions()) EXPECT_EQ(&find_action(action.id), &action);
}

TEST(Actions, SpellTheirKeysAsTheyArePrinted) {
    EXPECT_EQ(keys_text(find_action(ActionId::redo)), "Ctrl+Shift+Z or Ctrl+Y");
    EXPECT_EQ(keys_text(find_action(ActionId::lit)), "1");
    EXPECT_EQ(keys_text(find_action(ActionId::exposure_up)), "]");
}

TEST(Actions, CoverEveryChannelInTheOrderOfItsMenu) {
    const auto lit = static_cast<std::size_t>(ActionId::lit);
    for (std::size_t i = 0; i < channel_rows().size(); ++i)
        EXPECT_EQ(keys_text(find_action(static_cast<ActionId>(lit + i))), std::to_string(i + 1));
}

}  // namespace
}  // namespace sightlines
