// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The edit page over a real connection. Truth: docs/formats/edit_page.md.
#include "app/edit/edit_page.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/view/page_server.h"
#include "tests/app/edit/arm_clip.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/program/web_socket.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;
using testing::WebSocketClient;

constexpr int kText = 1;

/// A server with an edit of the clip, without a program around it.
class ServedEdit {
 public:
  ServedEdit() {
    testing::write_arm_clip(folder / "arm.bvh");
    PageServerOptions options;
    options.port = 0;
    options.open = false;
    auto started = start_page(options);
    EXPECT_TRUE(started) << started.error().message();
    page = std::make_unique<PageServer>(*std::move(started));
    publisher = std::make_unique<EditPagePublisher>(page->server);
    EditSessionOptions edit;
    edit.recipe_file = folder / "arm.edit.toml";
    edit.source = folder / "arm.bvh";
    edit.output = {folder / "out", {MotionFormat::kNpz}};
    auto opened = EditSession::open(edit, *publisher);
    EXPECT_TRUE(opened) << opened.error().message();
    session = *std::move(opened);
    desk = std::make_unique<EditPageDesk>(*session, page->server);
    session->wait_until_idle();
  }
  ~ServedEdit() { session.reset(); }
  ServedEdit(const ServedEdit&) = delete;
  ServedEdit& operator=(const ServedEdit&) = delete;

  /// Answers one message that a page has sent.
  void answer() {
    ASSERT_TRUE(page->server.wait_for_text(5000ms));
    std::vector<live::ReceivedText> texts;
    page->server.take_texts(texts);
    for (const auto& text : texts) desk->answer(text);
    session->wait_until_idle();
  }
  [[nodiscard]] int port() const { return page->server.port(); }

  testing::ScratchFolder folder;
  std::unique_ptr<PageServer> page;
  std::unique_ptr<EditPagePublisher> publisher;
  std::unique_ptr<EditSession> session;
  std::unique_ptr<EditPageDesk> desk;
};

/// A browser: sends messages and keeps the newest of each type.
class Browser {
 public:
  explicit Browser(ServedEdit& served) : served_(served), socket_(served.port()) {
    EXPECT_EQ(testing::status(socket_.upgrade()), 101);
  }
  void send(const std::string& text) {
    socket_.send_frame(kText, text);
    served_.answer();
  }
  /// Receives until a message of this type; returns it.
  Json until(const std::string& type) {
    for (int i = 0; i < 100; ++i) {
      const auto message = socket_.receive_message();
      if (!message) break;
      Json json = Json::parse(message->payload);
      newest[json.at("type")] = json;
      if (json.at("type") == type) return json;
    }
    ADD_FAILURE() << "no " << type;
    return {};
  }
  /// Receives `rendered` until it is this revision, which must have come before.
  Json rendered(int revision) {
    for (int i = 0; i < 20; ++i) {
      Json json = until("rendered");
      if (json.is_null()) break;
      EXPECT_GE(newest["revision"].value("revision", 0), json.at("revision").get<int>());
      if (json.at("revision") == revision) return json;
    }
    throw std::runtime_error("the revision was not rendered");
  }

  std::map<std::string, Json> newest;

 private:
  ServedEdit& served_;
  WebSocketClient socket_;
};

std::string edit_message(int base, const std::string& steps) {
  return R"({"type":"edit","id":"e","base_revision":)" + std::to_string(base) +
         R"(,"ops_patch":[)" + steps + "]}";
}

TEST(EditPage, SendsTheSceneTheRevisionAndItsMotionToANewPage) {
  ServedEdit served;
  Browser browser(served);
  const Json rendered = browser.rendered(1);
  const Json scene = browser.newest.at("scene");
  EXPECT_EQ(scene.at("mode"), "edit");
  EXPECT_EQ(scene.at("file"), nullptr);
  ASSERT_EQ(scene.at("skeletons").size(), 2U);
  EXPECT_EQ(scene.at("skeletons")[0].at("name"), "source");
  EXPECT_EQ(scene.at("skeletons")[1].at("name"), "result");
  const Json revision = browser.newest.at("revision");
  EXPECT_EQ(revision.at("revision"), 1);
  EXPECT_EQ(revision.at("cause"), "open");
  EXPECT_EQ(revision.at("sources")[0].at("file"), "arm.bvh");
  EXPECT_EQ(revision.at("recipe_file"), "arm.edit.toml");
  EXPECT_EQ(rendered.at("scene"), scene.at("revision"));
  const Json output = rendered.at("outputs")[0];
  EXPECT_EQ(output.at("frames"), 121);
  EXPECT_EQ(output.at("contacts").size(), 4U);
  EXPECT_EQ(output.at("graphs")[0].at("values").size(), 121U);
  EXPECT_EQ(output.at("graphs")[0].at("before").size(), 121U);
  EXPECT_EQ(output.at("lineage")[0], Json::parse("[0,120,0,0.0,120.0]"));
  const std::string block =
      testing::fetch(served.port(), output.at("block").get<std::string>());
  EXPECT_EQ(testing::status(block), 200);
  EXPECT_EQ(testing::body(block).substr(0, 4), "MRMB");
}

TEST(EditPage, ShowsOneRevisionOnAllPages) {
  ServedEdit served;
  Browser first(served);
  Browser second(served);
  (void)first.rendered(1);
  (void)second.rendered(1);
  first.send(
      edit_message(1, R"({"insert":0,"op":{"do":"cut@1","from_s":0.5,"why":"ä"}})"));
  for (Browser* browser : {&first, &second}) {
    const Json rendered = browser->rendered(2);
    EXPECT_EQ(rendered.at("outputs")[0].at("frames"), 91);
    EXPECT_EQ(rendered.at("outputs")[0].at("lineage")[0],
              Json::parse("[0,90,0,30.0,120.0]"));
    const Json revision = browser->newest.at("revision");
    EXPECT_EQ(revision.at("ops")[0].at("keys"),
              Json::parse(R"({"do":"cut@1","from_s":0.5,"why":"ä"})"));
    EXPECT_TRUE(revision.at("undo_possible"));
  }
  second.send(edit_message(1, R"({"remove":0})"));
  const Json stale = second.until("stale");
  EXPECT_EQ(stale.at("revision"), 2);
  EXPECT_EQ(stale.at("id"), "e");
  EXPECT_EQ(stale.at("about"), "edit");
  second.send(R"({"type":"undo","base_revision":2})");
  EXPECT_EQ(first.rendered(3).at("outputs")[0].at("frames"), 121);
  EXPECT_TRUE(first.newest.at("revision").at("redo_possible"));
}

TEST(EditPage, ReplacesAnOperationByItsOwnKeys) {
  ServedEdit served;
  Browser browser(served);
  (void)browser.rendered(1);
  browser.send(edit_message(
      1,
      R"({"insert":0,"op":{"do":"contacts@1","edits":[{"do":"clear","foot":"left",
          "part":"heel","from_s":0.25,"to_s":0.5}]}},
         {"insert":1,"op":{"do":"pose@1","at_frame":60,"bone":"leftHand",
          "moved_m":[0.1,0.0,0.05]}},
         {"insert":2,"op":{"do":"offset@1","bone":"head","rotation_deg":[0,12.5,0]}})"));
  (void)browser.rendered(2);
  const Json before = browser.newest.at("revision");
  std::string steps;
  for (std::size_t i = 0; i < before.at("ops").size(); ++i) {
    if (i > 0) steps += ",";
    steps += Json{{"replace", i}, {"op", before.at("ops")[i].at("keys")}}.dump();
  }
  browser.send(edit_message(2, steps));
  (void)browser.rendered(3);
  EXPECT_EQ(browser.newest.at("revision").at("recipe_text"), before.at("recipe_text"));
  EXPECT_EQ(browser.newest.at("revision").at("sha256"), before.at("sha256"));
}

TEST(EditPage, AnswersPreviewsExportsAndLoops) {
  ServedEdit served;
  Browser browser(served);
  (void)browser.rendered(1);
  browser.send(R"({"type":"preview","id":"p","base_revision":1,"span":[5,9],
                   "ops_patch":[{"insert":0,"op":{"do":"mirror@1"}}]})");
  const Json preview = browser.until("preview");
  EXPECT_EQ(preview.at("id"), "p");
  EXPECT_EQ(preview.at("outputs")[0].at("span"), Json::parse("[5,9]"));
  EXPECT_EQ(preview.at("outputs")[0].at("figures"), nullptr);
  EXPECT_EQ(preview.at("skeletons"), nullptr);
  browser.send(R"({"type":"export","id":"x","base_revision":1})");
  const Json exported = browser.until("exported");
  EXPECT_EQ(exported.at("files")[0], "arm.npz");
  EXPECT_TRUE(std::filesystem::exists(served.folder / "out" / std::string("arm.npz")));
  browser.send(R"({"type":"loops","id":"l","base_revision":1,"min_period_s":0.5,
                   "max_period_s":1.0,"map":true})");
  const Json loops = browser.until("loops");
  const std::size_t cells = loops.at("map").at("cells");
  EXPECT_GT(cells, 0U);
  EXPECT_EQ(loops.at("map").at("distance_mm").size(), cells * cells);
  EXPECT_EQ(browser.newest.count("revision"), 1U);
  EXPECT_EQ(browser.newest.at("revision").at("revision"), 1);
}

TEST(EditPage, StatesWhyAMotionHasNoCurvesOfAJump) {
  ServedEdit served;
  Browser browser(served);
  (void)browser.rendered(1);
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"type":"jump","id":"j","base_revision":1,"op":0,
           "ops_patch":[{"insert":0,"op":{"do":"jump@1"}}]})",
       "bears the body"},
      {R"({"type":"jump","id":"j","base_revision":1,"op":0})",
       "operation 1 is not a jump"},
      {R"({"type":"jump","id":"j","base_revision":1,"op":0,
           "ops_patch":[{"insert":0,"op":{"do":"mirror@1"}}]})",
       "operation 1 is not a jump"},
      {R"({"type":"jump","id":"j","base_revision":1,"op":0,"output":1,
           "ops_patch":[{"insert":0,"op":{"do":"jump@1"}}]})",
       "no such result"},
      {R"({"type":"jump","id":"j","base_revision":1,"op":0,
           "ops_patch":[{"insert":0,"op":{"do":"jump@1","apex":1}}]})",
       "apex"}};
  for (const auto& [message, reason] : cases) {
    browser.send(message);
    const Json error = browser.until("error");
    EXPECT_EQ(error.at("id"), "j");
    EXPECT_EQ(error.at("about"), "jump");
    const std::string text = error.at("text");
    EXPECT_NE(text.find(reason), std::string::npos) << message << "\n" << text;
  }
  EXPECT_EQ(served.session->revision().number, 1);
}

TEST(EditPage, RefusesBadMessagesAndStays) {
  ServedEdit served;
  Browser browser(served);
  (void)browser.rendered(1);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "not a JSON object"},
      {R"({"type":"record","on":true})", "type is unknown"},
      {edit_message(1, R"({"insert":0,"op":{"do":"retarget@1","avatar":"/etc/passwd"}})"),
       "no avatar"},
      {edit_message(1, R"({"insert":0,"op":{"do":"splice@1","source":"../b.bvh"}})"),
       "no source"},
      {edit_message(1, R"({"insert":0,"op":{"do":"cut@1","file":"x"}})"), "file"},
      {R"({"type":"undo","base_revision":1})", "nothing is left to undo"},
      {edit_message(1, R"({"remove":0})"), "does not exist"}};
  for (const auto& [message, reason] : cases) {
    browser.send(message);
    const std::string text = browser.until("error").at("text");
    EXPECT_NE(text.find(reason), std::string::npos) << message << "\n" << text;
  }
  EXPECT_EQ(served.session->revision().number, 1);
}

TEST(EditPage, ServesTheNewestBlocksOnly) {
  ServedEdit served;
  Browser browser(served);
  std::vector<std::string> blocks{browser.rendered(1).at("outputs")[0].at("block")};
  for (int revision = 1; revision <= 6; ++revision) {
    browser.send(edit_message(
        revision,
        revision == 1 ? R"({"insert":0,"op":{"do":"mirror@1"}})"
                      : R"({"toggle":0,"off":)" +
                            std::string(revision % 2 == 0 ? "true" : "false") + "}"));
    blocks.push_back(browser.rendered(revision + 1).at("outputs")[0].at("block"));
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const int want = i + 4 < blocks.size() ? 404 : 200;
    EXPECT_EQ(testing::status(testing::fetch(served.port(), blocks[i])), want) << i;
  }
}

}  // namespace
}  // namespace marey::app
