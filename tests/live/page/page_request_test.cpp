// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_request.h"

#include <string>

#include <gtest/gtest.h>

namespace marey::live {
namespace {

template <class T>
T read(const char* text) {
  const auto request = read_page_request(text);
  if (!request) {
    ADD_FAILURE() << text << " " << request.error().message();
    return {};
  }
  const T* found = std::get_if<T>(&*request);
  if (found == nullptr) ADD_FAILURE() << text << " is of another kind";
  return found == nullptr ? T{} : *found;
}

TEST(PageRequest, ReadsEveryTypeOfRequest) {
  EXPECT_EQ(read<HelloRequest>(R"({"type":"hello","version":1})").version, 1);
  EXPECT_EQ(read<ShownRequest>(R"({"type":"shown","sent_s":2.5})").sent_s, 2.5);
  const auto constraint =
      read<ConstraintRequest>(R"({"type":"constraint","id":"left hand","active":false})");
  EXPECT_EQ(constraint.id, "left hand");
  EXPECT_FALSE(constraint.active);
  EXPECT_EQ(read<WizardRequest>(R"({"type":"wizard","action":"accept"})").action,
            WizardAction::kAccept);
  EXPECT_TRUE(read<RecordRequest>(R"({"type":"record","on":true})").on);
  EXPECT_TRUE(read<ThumbnailsRequest>(R"({"type":"thumbnails","on":true,"x":1})").on);
  EXPECT_EQ(read<RunRequest>(R"({"type":"run","action":"restart"})").action,
            RunAction::kRestart);
  EXPECT_EQ(read<TrialRequest>(R"({"type":"trial","name":"walk"})").name, "walk");
}

TEST(PageRequest, ReadsDrags) {
  const auto live = read<DragRequest>(
      R"({"type":"drag","id":"left hand","p_in_world":[1,2.5,-3],"phase":"begin"})");
  EXPECT_EQ(live.id, "left hand");
  EXPECT_EQ(live.p_in_world, glm::dvec3(1.0, 2.5, -3.0));
  EXPECT_EQ(live.phase, DragPhase::kBegin);
  EXPECT_FALSE(live.frame);
  const auto file = read<DragRequest>(
      R"({"type":"drag","id":"a","p_in_world":[0,0,0],"phase":"end","frame":12})");
  EXPECT_EQ(file.frame, 12);
}

TEST(PageRequest, RejectsUnknownRequests) {
  struct Case {
    std::string text;
    const char* cause;
  };
  const std::string drag = R"({"type":"drag","id":"a","phase":"move","p_in_world":)";
  const Case cases[] = {
      {"", "it is not a JSON object"},
      {"[]", "it is not a JSON object"},
      {"{", "it is not a JSON object"},
      {R"({"type":"hello","version":1} )" + std::string("x"), "it is not a JSON object"},
      {"{\"type\":\"\xff\"}", "it is not a JSON object"},
      {R"({"type":"shown","sent_s":1e999})", "it is not a JSON object"},
      {R"({"type":"shown","sent_s":NaN})", "it is not a JSON object"},
      {"{}", "type is missing"},
      {R"({"type":1})", "type is not a text"},
      {R"({"type":"erase"})", "its type is unknown"},
      {R"({"type":"hello","version":2})",
       "version is not 1: the page is from another marey version"},
      {R"({"type":"shown","sent_s":"1"})", "sent_s is not a finite number"},
      {R"({"type":"record","on":1})", "on is not true or false"},
      {R"({"type":"record"})", "on is missing"},
      {R"({"type":"constraint","id":"","active":true})", "id is not 1 to 200 bytes long"},
      {R"({"type":"constraint","id":")" + std::string(201, 'a') + R"(","active":true})",
       "id is not 1 to 200 bytes long"},
      {R"({"type":"trial","name":""})", "name is not 1 to 200 bytes long"},
      {R"({"type":"wizard","action":"fly"})",
       "action is not one of start, next, cancel, accept"},
      {drag + "[1,2]}", "p_in_world is not three numbers within 10 km"},
      {drag + "[1,2,3,4]}", "p_in_world is not three numbers within 10 km"},
      {drag + "[1,2,\"3\"]}", "p_in_world is not three numbers within 10 km"},
      {drag + "[1,2,1e5]}", "p_in_world is not three numbers within 10 km"},
      {drag + "[1,2,3],\"frame\":-1}", "frame is not the number of a frame"},
      {drag + "[1,2,3],\"frame\":1.5}", "frame is not the number of a frame"},
      {drag + "[1,2,3],\"frame\":18446744073709551615}",
       "frame is not the number of a frame"},
      {std::string(17'000, ' '), "it is larger than 16 kB"},
      {std::string(16'000, '['), "it is not a JSON object"},
  };
  for (const Case& c : cases) {
    const auto request = read_page_request(c.text);
    ASSERT_FALSE(request) << c.text;
    EXPECT_EQ(request.error().code, Errc::kBadInput);
    EXPECT_EQ(request.error().cause, c.cause) << c.text.substr(0, 200);
  }
}

}  // namespace
}  // namespace marey::live
