// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_request.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

const std::array<StageHandle, 2> kHandles{{{"cup", true}, {"ball", false}}};

template <class T>
T read_as(const char* text) {
  const auto request = read_stage_request(text, kHandles);
  if (!request) {
    ADD_FAILURE() << text << " " << request.error().message();
    return {};
  }
  const T* found = std::get_if<T>(&*request);
  if (found == nullptr) ADD_FAILURE() << text << " is of another kind";
  return found == nullptr ? T{} : *found;
}

TEST(StageRequest, ReadsActionsAndTargets) {
  EXPECT_EQ(read_as<live::RunAction>(R"({"type":"run","action":"pause"})"),
            live::RunAction::kPause);
  EXPECT_EQ(read_as<live::RunAction>(R"({"type":"run","action":"restart"})"),
            live::RunAction::kRestart);
  const auto move = read_as<MoveTarget>(
      R"({"type":"drag","id":"cup","p_in_world":[1,2,3],"phase":"move"})");
  EXPECT_EQ(move.target, 0U);
  EXPECT_EQ(move.p_in_world, glm::dvec3(1.0, 2.0, 3.0));
  (void)read_as<HoldTarget>(R"({"type":"constraint","id":"cup","active":true})");
  (void)read_as<ReleaseTarget>(R"({"type":"constraint","id":"cup","active":false})");
  (void)read_as<std::monostate>(R"({"type":"hello","version":1})");
  (void)read_as<std::monostate>(R"({"type":"shown","sent_s":2})");
}

TEST(StageRequest, RefusesByCause) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"type":"drag","id":"cap","p_in_world":[1,2,3],"phase":"move"})",
       "there is no target"},
      {R"({"type":"drag","id":"ball","p_in_world":[1,2,3],"phase":"move"})",
       "cannot be dragged"},
      {R"({"type":"drag","id":"cup","p_in_world":[1,2,1e9],"phase":"move"})",
       "within 10 km"},
      {R"({"type":"drag","id":"cup","p_in_world":[1,2,null],"phase":"move"})",
       "three numbers"},
      {R"({"type":"constraint","id":"ball","active":true})", "cannot be dragged"},
      {R"({"type":"run","action":"stop"})", "not one of"},
      {R"({"type":"record","on":true})", "shows a scene"},
      {R"({"type":"wizard","action":"start"})", "shows a scene"},
      {"[]", "not a JSON object"},
      {"", "not a JSON object"}};
  for (const auto& [text, cause] : cases) {
    const auto request = read_stage_request(text, kHandles);
    ASSERT_FALSE(request) << text;
    EXPECT_NE(request.error().message().find(cause), std::string::npos)
        << text << ": " << request.error().message();
  }
}

// Truth: each text is read or refused; nothing else can happen.
TEST(StageRequest, ReadsOrRefusesDamagedMessages) {
  const std::string good[] = {
      R"({"type":"drag","id":"cup","p_in_world":[1,2,3],"phase":"move"})",
      R"({"type":"constraint","id":"cup","active":false})",
      R"({"type":"run","action":"play"})"};
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 30000; ++i) {
    std::string text = good[i % 3];
    for (int k = 0; k <= i % 4; ++k)
      text[random() % text.size()] = static_cast<char>(random() % 256);
    if (i % 5 == 0) text.resize(random() % text.size());
    if (!read_stage_request(text, kHandles)) ++refused;
  }
  EXPECT_GT(refused, 20000);
}

}  // namespace
}  // namespace marey::app
