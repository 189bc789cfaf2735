// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/result.h"

#include <memory>

#include <gtest/gtest.h>

#include "core/source.h"

namespace marey {
namespace {

TEST(ErrorMessage, ContainsThePlaceTheCauseAndTheNextStep) {
  const Error error = bad_input("walk/cam2.mp4: frame 63",
                                "the video ends after 63 of 127 frames",
                                "copy the file from the camera again");
  EXPECT_EQ(error.code, Errc::kBadInput);
  EXPECT_EQ(error.message(),
            "walk/cam2.mp4: frame 63: the video ends after 63 of 127 frames. "
            "Next: copy the file from the camera again.");
}

TEST(ErrorMessage, OmitsUnknownParts) {
  EXPECT_EQ((Error{Errc::kInternal, "", "no memory", ""}).message(), "no memory.");
  EXPECT_EQ((Error{Errc::kDevice, "cam0", "unplugged", ""}).message(),
            "cam0: unplugged.");
}

TEST(ResultOf, HoldsAValueThatCanBeMovedOut) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
  ASSERT_TRUE(result);
  const std::unique_ptr<int> value = *std::move(result);
  EXPECT_EQ(*value, 7);
}

TEST(ResultOf, HoldsAnError) {
  const Result<int> result(bad_input("a.toml", "empty", "write it"));
  EXPECT_FALSE(result);
  EXPECT_EQ(result.error().where, "a.toml");
}

TEST(ResultDeathTest, AbortsWhenAMissingValueIsRead) {
  const Result<int> result(bad_input("a.toml", "empty", "write it"));
  EXPECT_DEATH((void)*result, "contract broken: has_value");
}

TEST(ResultDeathTest, AbortsWhenAMissingErrorIsRead) {
  const Status status = Done{};
  EXPECT_DEATH((void)status.error(), "contract broken: !has_value");
}

TEST(SourceName, IsTheWordOfTheTables) {
  EXPECT_EQ(name(Source::kMeasured), "measured");
  EXPECT_EQ(name(Source::kRepaired), "repaired");
  EXPECT_EQ(name(Source::kInferred), "inferred");
}

}  // namespace
}  // namespace marey
