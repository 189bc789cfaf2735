// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Messages of the page of marey edit. Truth: docs/formats/edit_page.md.
#include "live/page/edit_request.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace marey::live {
namespace {

std::string refusal(const std::string& text) {
  const auto request = read_edit_request(text);
  return request ? "accepted" : request.error().message();
}

std::string with_op(const std::string& op) {
  return R"({"type":"edit","base_revision":1,"ops_patch":[{"insert":0,"op":)" + op +
         "}]}";
}

std::string op_text(const std::string& op) {
  const auto request = read_edit_request(with_op(op));
  if (!request) return request.error().message();
  return std::get<EditRequest>(request->body).patch[0].op_toml;
}

TEST(EditRequest, ReadsAPatchOfAllSteps) {
  const auto request = read_edit_request(
      R"({"type":"edit","id":"7","base_revision":12,"ops_patch":[
          {"insert":0,"op":{"do":"cut@1","from_s":1.2,"to":"left.strike[2]"}},
          {"replace":2,"op":{"do":"plant@1"}},{"remove":3},{"move":4,"to":1},
          {"toggle":1,"off":true}]})");
  ASSERT_TRUE(request) << request.error().message();
  EXPECT_EQ(request->type, "edit");
  EXPECT_EQ(request->id, "7");
  const auto& edit = std::get<EditRequest>(request->body);
  EXPECT_EQ(edit.base_revision, 12);
  ASSERT_EQ(edit.patch.size(), 5U);
  using Kind = OpsPatchStep::Kind;
  EXPECT_EQ(edit.patch[0].kind, Kind::kInsert);
  EXPECT_EQ(edit.patch[0].op_toml,
            "[[op]]\ndo = \"cut@1\"\nfrom_s = 1.2\nto = \"left.strike[2]\"\n");
  EXPECT_EQ(edit.patch[1].kind, Kind::kReplace);
  EXPECT_EQ(edit.patch[1].index, 2);
  EXPECT_EQ(edit.patch[2].kind, Kind::kRemove);
  EXPECT_EQ(edit.patch[3].kind, Kind::kMove);
  EXPECT_EQ(edit.patch[3].to, 1);
  EXPECT_EQ(edit.patch[4].kind, Kind::kToggle);
  EXPECT_TRUE(edit.patch[4].off);
}

TEST(EditRequest, ReadsTheOtherTypes) {
  const auto preview = read_edit_request(
      R"({"type":"render","base_revision":3,"until":2,"output":1,"span":[10,20]})");
  ASSERT_TRUE(preview) << preview.error().message();
  const auto& render = std::get<PreviewRequest>(preview->body);
  EXPECT_TRUE(render.patch.empty());
  EXPECT_EQ(render.until, 2);
  EXPECT_EQ(render.output, 1);
  EXPECT_EQ(render.span->last, 20);
  const auto loops = read_edit_request(
      R"({"type":"loops","base_revision":3,"id":"","min_period_s":0.5,"map":true})");
  ASSERT_TRUE(loops) << loops.error().message();
  EXPECT_EQ(std::get<LoopsRequest>(loops->body).min_period_s, 0.5);
  EXPECT_TRUE(std::get<LoopsRequest>(loops->body).map);
  const auto jump = read_edit_request(
      R"({"type":"jump","base_revision":3,"op":2,"output":1,"ops_patch":[{"remove":0}]})");
  ASSERT_TRUE(jump) << jump.error().message();
  EXPECT_EQ(std::get<JumpRequest>(jump->body).base_revision, 3);
  EXPECT_EQ(std::get<JumpRequest>(jump->body).op, 2);
  EXPECT_EQ(std::get<JumpRequest>(jump->body).output, 1);
  EXPECT_EQ(std::get<JumpRequest>(jump->body).patch.size(), 1U);
  EXPECT_TRUE(read_edit_request(R"({"type":"jump","base_revision":3,"op":0})"));
  EXPECT_TRUE(read_edit_request(R"({"type":"undo","base_revision":3})"));
  EXPECT_TRUE(read_edit_request(R"({"type":"redo","base_revision":3})"));
  EXPECT_TRUE(read_edit_request(R"({"type":"export","base_revision":3})"));
  EXPECT_TRUE(read_edit_request(R"({"type":"hello","version":1})"));
  EXPECT_TRUE(read_edit_request(R"({"type":"shown","sent_s":1.5})"));
}

TEST(EditRequest, WritesValuesOfAllKindsAsToml) {
  EXPECT_EQ(op_text(R"({"a":1,"b":-2,"c":1.0,"d":1e-7,"e":true,"f":false})"),
            "[[op]]\na = 1\nb = -2\nc = 1.0\nd = 1e-07\ne = true\nf = false\n");
  EXPECT_EQ(op_text(R"({"a":[[0,1.5],[2,3]],"b":[]})"),
            "[[op]]\na = [[0, 1.5, ], [2, 3, ], ]\nb = []\n");
  EXPECT_EQ(op_text(R"({"a":[{"do":"set","foot":"left"}],"b":{}})"),
            "[[op]]\na = [{ do = \"set\", foot = \"left\" }, ]\nb = {  }\n");
  EXPECT_EQ(op_text(R"({"why":"two\nlines \"and\" \\ a tab\t, gänge \u007f"})"),
            "[[op]]\nwhy = \"two\\nlines \\\"and\\\" \\\\ a tab\\t, gänge \\u007f\"\n");
}

TEST(EditRequest, DeclinesBadMessagesWithTheReason) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "not a JSON object"},
      {"[1]", "not a JSON object"},
      {R"({"type":"edit")", "not a JSON object"},
      {R"({"base_revision":1})", "type is missing"},
      {R"({"type":7})", "type is not a text"},
      {R"({"type":"drag","id":"x","base_revision":1})", "its type is unknown"},
      {R"({"type":"undo"})", "base_revision is missing"},
      {R"({"type":"undo","base_revision":-1})", "base_revision is not a whole number"},
      {R"({"type":"undo","base_revision":1.5})", "base_revision is not a whole number"},
      {R"({"type":"undo","base_revision":99999999999})", "base_revision is not a whole"},
      {R"({"type":"undo","base_revision":1e999})", "not a JSON object"},
      {R"({"type":"undo","base_revision":1,"path":"/etc"})",
       "the member \"path\" is unknown here"},
      {R"({"type":"undo","base_revision":1,"id":7})", "id is not a text"},
      {R"({"type":"undo","base_revision":1,"id":")" + std::string(65, 'x') + "\"}",
       "id is not a text"},
      {R"({"type":"edit","base_revision":1})", "ops_patch is missing"},
      {R"({"type":"edit","base_revision":1,"ops_patch":{}})", "ops_patch is not a list"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[]})", "ops_patch is not a list"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[3]})", "is not an object"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{}]})", "a step is none of"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{"remove":1,"to":2}]})",
       "the member \"to\" is unknown here"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{"insert":1}]})",
       "op is missing"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{"insert":1,"op":"cut"}]})",
       "op is not an object"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{"move":1}]})", "to is missing"},
      {R"({"type":"edit","base_revision":1,"ops_patch":[{"toggle":1,"off":1}]})",
       "off is not true or false"},
      {R"({"type":"render","base_revision":1,"span":[5,4]})", "span is not in the order"},
      {R"({"type":"render","base_revision":1,"span":[5]})", "span is not a list"},
      {R"({"type":"render","base_revision":1,"ops_patch":[{"remove":1}]})",
       "the member \"ops_patch\" is unknown here"},
      {R"({"type":"loops","base_revision":1,"min_period_s":"1"})",
       "min_period_s is not a time"},
      {R"({"type":"jump","base_revision":1})", "op is missing"},
      {R"({"type":"jump","base_revision":1,"op":-1})", "op is not a whole number"},
      {R"({"type":"jump","base_revision":1,"op":0,"ops_patch":[]})",
       "ops_patch is not a list"},
      {with_op(R"({"a":null})"), "null"},
      {with_op(R"({"a":18446744073709551615})"), "too large"},
      {with_op(R"({"a b":1})"), "invalid key \"a b\""},
      {with_op(R"({"":1})"), "invalid key"},
      {with_op(R"({"a\n[x]":1})"), "invalid key"},
      {with_op(R"({"a":[[[[[[[1]]]]]]]})"), "more than 6 levels"},
      {with_op(R"({"a":)" + std::string(5000, '[') + std::string(5000, ']') + "}"),
       "more than 6 levels"},
      {std::string(16385, ' '), "larger than 16 kB"}};
  for (const auto& [text, reason] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(reason), std::string::npos) << text << "\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(EditRequest, DeclinesTooManySteps) {
  std::string steps = R"({"remove":0})";
  for (int i = 1; i < 64; ++i) steps += R"(,{"remove":0})";
  const std::string start = R"({"type":"edit","base_revision":1,"ops_patch":[)";
  EXPECT_EQ(refusal(start + steps + "]}"), "accepted");
  EXPECT_NE(refusal(start + steps + R"(,{"remove":0}]})").find("1 to 64"),
            std::string::npos);
}

}  // namespace
}  // namespace marey::live
