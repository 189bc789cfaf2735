// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The page of a library over a real connection. Truth: docs/formats/library_page.md.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/library/page/library_page_server.h"
#include "app/library/page/library_view.h"
#include "app/view/page_server.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/label_file.h"
#include "recordings/library/verdict_file.h"
#include "tests/app/library/build/walk_library.h"
#include "tests/app/library/page/page_library.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/program/web_socket.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;
using testing::WebSocketClient;

constexpr int kClips = 6;

/// A served library and one page of it.
class LibraryPage : public ::testing::Test {
 protected:
  void open(int clips = kClips) {
    testing::write_page_library(folder.path(), testing::sample_page_clips(clips));
    start();
  }
  void start() { start(folder.path()); }
  void start(const std::filesystem::path& place) {
    PageServerOptions options;
    options.port = 0;
    options.open = false;
    auto started = start_page(options);
    ASSERT_TRUE(started) << started.error().message();
    page = std::make_unique<PageServer>(*std::move(started));
    library_server = std::make_unique<LibraryPageServer>(place, "", page->server);
    socket = std::make_unique<WebSocketClient>(page->server.port());
    ASSERT_EQ(testing::status(socket->upgrade()), 101);
    library = receive();
  }
  Json receive() {
    const auto message = socket->receive_message();
    if (!message) throw std::runtime_error("the server closed");
    return Json::parse(message->payload);
  }
  /// Returns the answer to a request.
  Json ask(Json request) {
    request["id"] = "q";
    if (!request.contains("revision")) request["revision"] = library["revision"];
    socket->send_frame(1, request.dump());
    EXPECT_TRUE(page->server.wait_for_text(5000ms));
    std::vector<live::ReceivedText> texts;
    page->server.take_texts(texts);
    for (const auto& text : texts) library_server->answer(text);
    return receive();
  }
  Json list(const std::string& query = "", const Json& quality = nullptr) {
    return ask({{"type", "list"},
                {"offset", 0},
                {"count", 100},
                {"query", query},
                {"quality", quality},
                {"sort", "number"},
                {"descending", false}});
  }
  Json clip(int number, bool is_mirrored = false) {
    return ask({{"type", "clip"}, {"clip", number}, {"mirrored", is_mirrored}});
  }

  testing::ScratchFolder folder;
  std::unique_ptr<PageServer> page;
  std::unique_ptr<LibraryPageServer> library_server;
  std::unique_ptr<WebSocketClient> socket;
  Json library;
};

TEST_F(LibraryPage, ListsAllClipsWithTheirVerdicts) {
  open();
  EXPECT_EQ(library["type"], "library");
  EXPECT_EQ(library["clips"], kClips);
  EXPECT_EQ(library["trouble"], "");
  const Json clips = list();
  ASSERT_EQ(clips["type"], "clips");
  ASSERT_EQ(clips["rows"].size(), std::size_t{kClips});
  EXPECT_EQ(clips["rows"][0]["name"], "walk_100");
  EXPECT_EQ(clips["rows"][0]["labels"], Json::array({"walk"}));
  int counted = 0;
  for (const Json& count : clips["counts"]) counted += count.get<int>();
  EXPECT_EQ(counted, kClips);
  EXPECT_GT(clips["counts"]["fail"].get<int>() + clips["counts"]["warn"].get<int>(), 0);
}

TEST_F(LibraryPage, FiltersByQueryAndVerdictAndPages) {
  open();
  const Json strolls = list("label=stroll");
  EXPECT_EQ(strolls["found"], 4);
  const Json wrong = list("label=");
  EXPECT_EQ(wrong["type"], "error");
  EXPECT_EQ(wrong["about"], "list");
  EXPECT_NE(wrong["text"], "");
  for (const char* verdict : {"pass", "warn", "fail"}) {
    const Json some = list("", verdict);
    EXPECT_EQ(some["found"], some["counts"][verdict]);
    for (const Json& row : some["rows"]) EXPECT_EQ(row["quality"], verdict);
  }
  const Json page_2 = ask({{"type", "list"},
                           {"offset", 4},
                           {"count", 4},
                           {"query", ""},
                           {"quality", nullptr},
                           {"sort", "seconds"},
                           {"descending", true}});
  ASSERT_EQ(page_2["rows"].size(), 2U);
  EXPECT_GE(page_2["rows"][0]["seconds"], page_2["rows"][1]["seconds"]);
}

TEST_F(LibraryPage, DrawsFourPosturesOfEachClip) {
  open();
  const Json drawings = ask({{"type", "poses"}, {"clips", {2, 0}}});
  ASSERT_EQ(drawings["type"], "drawings");
  ASSERT_EQ(drawings["drawings"].size(), 2U);
  EXPECT_EQ(drawings["drawings"][0]["clip"], 2);
  const Json& poses = drawings["drawings"][1]["poses"];
  ASSERT_EQ(poses.size(), 4U);
  ASSERT_EQ(poses[0].size(), 44U);
  EXPECT_EQ(poses[0][0], 0);             // The hips are the origin.
  EXPECT_GT(poses[0][1], 700);           // The hips of an adult. [mm]
  EXPECT_GT(poses[0][11], poses[0][1]);  // The head is above the hips.
}

TEST_F(LibraryPage, ShowsAClipWithItsNeighbours) {
  open();
  const Json shown = clip(1);
  ASSERT_EQ(shown["type"], "clip");
  EXPECT_EQ(shown["row"]["clip"], 1);
  EXPECT_FALSE(shown["figures"].empty());
  EXPECT_EQ(shown["neighbours"].size(), 3U);
  EXPECT_LE(shown["neighbours"][0]["distance"], shown["neighbours"][1]["distance"]);
  for (const Json& other : shown["neighbours"]) EXPECT_NE(other["clip"], 1);
  ASSERT_EQ(shown["scene"]["skeletons"].size(), 4U);
  const std::string block = shown["scene"]["file"]["block"];
  const std::string answer = testing::fetch(page->server.port(), block);
  EXPECT_EQ(testing::status(answer), 200);
  EXPECT_EQ(testing::body(answer).substr(0, 4), "MRMB");
  EXPECT_TRUE(clip(1, true)["mirrored"].get<bool>());
}

TEST_F(LibraryPage, ShowsNeighboursOfABuiltLibrary) {
  const WalkLibrary walks(3);
  const std::filesystem::path place = walks.make("library");
  ASSERT_TRUE(recordings::write_file(walks.walks() / "deep/broken.bvh", "HIERARCHY"));
  const auto built =
      testing::run_program(testing::program(), {"library", "build", place.string()});
  ASSERT_TRUE(std::filesystem::exists(place / "library.sqlite")) << built.err;
  start(place);
  EXPECT_EQ(library["clips"], 3);
  EXPECT_EQ(library["failed"], 1);
  const Json shown = clip(0);  // The shortest: all others are long enough.
  EXPECT_EQ(shown["neighbour_trouble"], "");
  EXPECT_EQ(shown["neighbours"].size(), 2U);
  EXPECT_EQ(shown["scene"]["skeletons"].size(), 3U);
}

TEST_F(LibraryPage, RemovesOldMotions) {
  open();
  const std::string first = clip(0)["scene"]["file"]["block"];
  for (int i = 0; i < 13; ++i) (void)clip(1 + i % 5);
  EXPECT_EQ(testing::status(testing::fetch(page->server.port(), first)), 404);
}

TEST_F(LibraryPage, StoresVerdictsAndLabelsThatABuildReads) {
  open();
  const std::string id = list()["rows"][1]["clip_id"];
  const Json verdict = {{"type", "verdict"},
                        {"clip_id", id},
                        {"figure", "spike"},
                        {"frames", {3, 5}},
                        {"verdict", "pass"},
                        {"by", "Anna"},
                        {"note", "a jump, \"meant\""}};
  EXPECT_EQ(ask(verdict)["type"], "stored");
  EXPECT_EQ(ask(verdict)["file"], "labels/verdicts.csv");
  const auto rows = recordings::read_verdicts(folder / "labels/verdicts.csv");
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->back().clip, id);
  EXPECT_EQ(rows->back().figure, "spike");
  EXPECT_EQ(rows->back().frames->last, 5);
  EXPECT_EQ(rows->back().note, "a jump, \"meant\"");

  const Json label = {{"type", "label"},
                      {"clip_id", id},
                      {"start_s", 0.25},
                      {"end_s", 1.0},
                      {"label", "turn"},
                      {"by", "Anna"},
                      {"sure", false}};
  EXPECT_EQ(ask(label)["type"], "stored");
  EXPECT_EQ(ask(label)["file"], "labels/page.csv");
  const auto labels = recordings::read_labels(folder / "labels/page.csv");
  ASSERT_TRUE(labels) << labels.error().message();
  ASSERT_EQ(labels->size(), 2U);
  EXPECT_EQ(labels->front().target, id);
  EXPECT_EQ(labels->front().start_s, 0.25);
  EXPECT_EQ(labels->front().certainty, 0.5);
}

TEST_F(LibraryPage, KeepsATableWithAMistake) {
  open();
  const std::string id = list()["rows"][0]["clip_id"];
  const std::string text = "clip_or_source,start_s,end_s,label,by,sure\nabc,1\n";
  ASSERT_TRUE(recordings::write_file(folder / "labels/page.csv", text));
  const Json answer = ask({{"type", "label"},
                           {"clip_id", id},
                           {"start_s", 0.0},
                           {"end_s", 1.0},
                           {"label", "turn"},
                           {"by", "Anna"},
                           {"sure", true}});
  EXPECT_EQ(answer["type"], "error");
  EXPECT_NE(answer["text"].get<std::string>().find("page.csv:2"), std::string::npos)
      << answer["text"];
  EXPECT_EQ(*recordings::read_file(folder / "labels/page.csv"), text);
}

TEST_F(LibraryPage, ReportsAMissingMotion) {
  open();
  std::filesystem::remove_all(folder / "objects");
  const Json shown = clip(0);
  ASSERT_EQ(shown["type"], "clip");
  EXPECT_TRUE(shown["scene"].is_null());
  EXPECT_NE(shown["trouble"].get<std::string>().find("missing"), std::string::npos);
  EXPECT_FALSE(shown["figures"].empty());
  const Json drawings = ask({{"type", "poses"}, {"clips", {0}}});
  EXPECT_TRUE(drawings["drawings"][0]["poses"].is_null());
}

TEST_F(LibraryPage, ReadsNoObjectOutsideTheLibrary) {
  open();
  const testing::ScratchFolder elsewhere;
  std::filesystem::rename(folder / "objects", elsewhere / "objects");
  std::filesystem::create_directory_symlink(elsewhere / "objects", folder / "objects");
  const Json shown = clip(0);
  EXPECT_TRUE(shown["scene"].is_null());
  EXPECT_NE(shown["trouble"].get<std::string>().find("leads out"), std::string::npos);
}

TEST_F(LibraryPage, ListsWithoutSearchFiles) {
  testing::write_page_library(folder.path(), testing::sample_page_clips(kClips));
  std::filesystem::remove_all(folder / "search");
  start();
  EXPECT_EQ(library["clips"], kClips);
  const Json shown = clip(0);
  EXPECT_NE(shown["neighbour_trouble"], "");
  EXPECT_EQ(shown["scene"]["skeletons"].size(), 1U);
}

TEST_F(LibraryPage, NoticesThatTheLibraryWasBuiltAgain) {
  open();
  const Json before = list();
  std::filesystem::remove(folder / "library.sqlite");
  testing::write_page_library(folder.path(), testing::sample_page_clips(3));
  library_server->look();
  const Json now = receive();
  EXPECT_EQ(now["type"], "library");
  EXPECT_EQ(now["clips"], 3);
  EXPECT_GT(now["revision"], library["revision"]);
  EXPECT_EQ(list()["type"], "outdated");  // The old revision.
  library = now;
  EXPECT_EQ(list()["found"], 3);
}

TEST_F(LibraryPage, NamesTheCommandThatBuildsALibrary) {
  std::ofstream(folder / "library.toml") << "format = 1\nname = \"new\"\n";
  start();
  EXPECT_EQ(library["clips"], 0);
  EXPECT_NE(library["trouble"].get<std::string>().find("marey library build"),
            std::string::npos);
  EXPECT_EQ(list()["type"], "error");
}

TEST_F(LibraryPage, ReportsADamagedIndex) {
  std::ofstream(folder / "library.toml") << "format = 1\nname = \"new\"\n";
  std::ofstream(folder / "library.sqlite") << "no database";
  start();
  EXPECT_EQ(library["clips"], 0);
  EXPECT_NE(library["trouble"], "");
}

TEST_F(LibraryPage, RefusesNumbersOfOtherLibraries) {
  open();
  EXPECT_EQ(clip(kClips)["type"], "error");
  EXPECT_EQ(ask({{"type", "poses"}, {"clips", {kClips}}})["type"], "error");
}

TEST(LibraryFolder, IsRecognisedByItsSettings) {
  const testing::ScratchFolder folder;
  EXPECT_FALSE(is_library_folder(folder.path()));
  std::ofstream(folder / "library.toml") << "format = 1\n";
  EXPECT_TRUE(is_library_folder(folder.path()));
}

}  // namespace
}  // namespace marey::app
