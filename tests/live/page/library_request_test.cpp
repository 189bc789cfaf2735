// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Truth: docs/formats/library_page.md.
#include "live/page/library_request.h"

#include <string>
#include <variant>

#include <gtest/gtest.h>

namespace marey::live {
namespace {

std::string cause_of(const std::string& text) {
  const auto request = read_library_request(text);
  return request ? "" : request.error().cause;
}

TEST(LibraryRequest, ReadsAList) {
  const auto request = read_library_request(
      R"({"type":"list","id":"7","revision":3,"offset":100,"count":50,)"
      R"("query":"content=walk","quality":"fail","sort":"seconds","descending":true})");
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(request->id, "7");
  EXPECT_EQ(request->revision, 3);
  const auto& list = std::get<LibraryListRequest>(request->body);
  EXPECT_EQ(list.offset, 100);
  EXPECT_EQ(list.count, 50);
  EXPECT_EQ(list.query, "content=walk");
  EXPECT_EQ(list.quality, Verdict::kFail);
  EXPECT_EQ(list.sort, LibrarySort::kSeconds);
  EXPECT_TRUE(list.is_descending);
}

TEST(LibraryRequest, ReadsAListWithoutVerdict) {
  const auto request = read_library_request(
      R"({"type":"list","id":"","revision":1,"offset":0,"count":1,"query":"",)"
      R"("quality":null,"sort":"number","descending":false})");
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(std::get<LibraryListRequest>(request->body).quality, std::nullopt);
}

TEST(LibraryRequest, ReadsAVerdictWithFrames) {
  const auto request = read_library_request(
      R"({"type":"verdict","id":"1","revision":1,"clip_id":"0123456789abcdef",)"
      R"("figure":"spike","frames":[4,9],"verdict":"pass","by":" Anna ","note":""})");
  ASSERT_TRUE(request) << request.error().message();
  const auto& verdict = std::get<LibraryVerdictRequest>(request->body);
  EXPECT_EQ(verdict.frames->first, 4);
  EXPECT_EQ(verdict.frames->last, 9);
  EXPECT_EQ(verdict.verdict, Verdict::kPass);
  EXPECT_EQ(verdict.by, "Anna");
}

TEST(LibraryRequest, ReadsALabel) {
  const auto request = read_library_request(
      R"({"type":"label","id":"1","revision":1,"clip_id":"0123456789abcdef",)"
      R"("start_s":0.5,"end_s":1.25,"label":"turn","by":"Anna","sure":false})");
  ASSERT_TRUE(request) << request.error().message();
  const auto& label = std::get<LibraryLabelRequest>(request->body);
  EXPECT_EQ(label.start_s, 0.5);
  EXPECT_EQ(label.end_s, 1.25);
  EXPECT_FALSE(label.is_sure);
}

TEST(LibraryRequest, RefusesWhatThePageNeverSends) {
  EXPECT_EQ(cause_of("[]"), "it is not a JSON object");
  EXPECT_EQ(cause_of(R"({"type":"delete","id":"","revision":1})"), "its type is unknown");
  EXPECT_NE(cause_of(R"({"type":"clip","id":"","revision":1,"clip":-1,"mirrored":true})"),
            "");
  EXPECT_NE(cause_of(R"({"type":"clip","id":"","revision":1,"clip":1,"mirrored":true,)"
                     R"("file":"/etc/passwd"})"),
            "");
  EXPECT_NE(cause_of(R"({"type":"poses","id":"","revision":1,"clips":[]})"), "");
  EXPECT_NE(cause_of(R"({"type":"poses","id":"","revision":1,"clips":["a"]})"), "");
  EXPECT_NE(cause_of(R"({"type":"list","id":"","revision":1,"offset":0,"count":501,)"
                     R"("query":"","quality":null,"sort":"name","descending":false})"),
            "");
  EXPECT_NE(cause_of(R"({"type":"list","id":"","revision":1,"offset":0,"count":5,)"
                     R"("query":"","quality":"good","sort":"name","descending":false})"),
            "");
  EXPECT_NE(cause_of(std::string(16 * 1024 + 1, ' ')), "");
}

TEST(LibraryRequest, RefusesTextsThatCannotBeStored) {
  const std::string head =
      R"({"type":"label","id":"1","revision":1,"clip_id":"0123456789abcdef",)";
  EXPECT_NE(cause_of(head + R"("start_s":1,"end_s":0.5,"label":"turn","by":"A",)"
                            R"("sure":true})"),
            "");
  EXPECT_NE(cause_of(head + R"("start_s":0,"end_s":1,"label":"a\nb","by":"A",)"
                            R"("sure":true})"),
            "");
  EXPECT_NE(cause_of(head + R"("start_s":0,"end_s":1,"label":"   ","by":"A",)"
                            R"("sure":true})"),
            "");
  EXPECT_NE(cause_of(R"({"type":"label","id":"1","revision":1,"clip_id":"../../x",)"
                     R"("start_s":0,"end_s":1,"label":"a","by":"A","sure":true})"),
            "");
}

}  // namespace
}  // namespace marey::live
