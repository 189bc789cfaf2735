// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "recordings/session/session.h"
#include "tests/recordings/session_text.h"

namespace marey::recordings {
namespace {

TEST(SessionFamilies, MayDifferForTheBoardAndEachTag) {
  std::string text =
      with("type = \"aprilgrid\"", "type = \"aprilgrid\"\nfamily = \"tag36h11b2\"");
  const std::string head = "id = 73\n";
  text.replace(text.find(head), head.size(), "id = 29\nfamily = \"tagCircle21h7\"\n");
  text.replace(text.find("rows = 6"), 8, "rows = 5");
  const Result<Session> session = read(text);
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_EQ(session->families.size(), 3U);
  EXPECT_EQ(session->families[0].name, "tag36h11b2");
  EXPECT_EQ(session->families[0].ids.size(), 25U);
  EXPECT_EQ(session->family_of(TagId{3}), "tag36h11b2");
  EXPECT_EQ(session->family_of(TagId{41}), "tag36h11");
  EXPECT_EQ(session->family_of(TagId{29}), "tagCircle21h7");
}

TEST(SessionFamilies, ThatAreNotKnownAreDeclinedWithTheNearest) {
  EXPECT_EQ(mistake(with("tag36h11", "tag36h12")),
            "session.toml:9: unknown tag family \"tag36h12\". Next: perhaps you mean "
            "\"tag36h11\".");
}

TEST(SessionFamilies, LimitTheirOwnIds) {
  const std::string message =
      mistake(with("id = 73\n", "id = 73\nfamily = \"tagCircle21h7\"\n"));
  EXPECT_NE(message.find("\"id\""), std::string::npos) << message;
  EXPECT_NE(message.find("37"), std::string::npos) << message;
}

// Ids identify tags, independent of their family.
TEST(SessionFamilies, DoNotShareIds) {
  const std::string message =
      mistake(with("id = 73\n", "id = 41\nfamily = \"tagStandard41h12\"\n"));
  EXPECT_NE(message.find("tag 41 is listed twice"), std::string::npos) << message;
}

}  // namespace
}  // namespace marey::recordings
