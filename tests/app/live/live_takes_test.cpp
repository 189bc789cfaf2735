// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Takes of `marey live` that are begun and ended from its page, in the middle of a run.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "recordings/takes/live_take.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/program/web_socket.h"

namespace marey::testing {
namespace {

using nlohmann::json;

const std::filesystem::path kTakesSample = marey::testing::sample_session();
const std::filesystem::path kTakesResults = marey::testing::sample_results() / "once";
const std::filesystem::path kTakesProgram = marey::testing::program();

/// Returns a port that no program used a moment ago.
int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof any;
  EXPECT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&any), size), 0);
  EXPECT_EQ(getsockname(socket, reinterpret_cast<sockaddr*>(&any), &size), 0);
  close(socket);
  return ntohs(any.sin_port);
}

/// The sample's walk played over and over, in a session of its own.
class LiveTakesOfThePage : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy(kTakesSample / "session.toml", session_ / "session.toml");
    const std::string glb = (session_ / "body.glb").string();
    ASSERT_EQ(run_program(kTakesProgram, {"mannequin", "--out", glb}).exit_code, 0);
    std::filesystem::rename(glb, avatar_);
  }

  void start(double seconds, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"live",
                                   session_.path().string(),
                                   "--results",
                                   kTakesResults.string(),
                                   "--media",
                                   kTakesSample.string(),
                                   "--play",
                                   "walk",
                                   "--loop",
                                   "--wait-ms",
                                   "500",
                                   "--avatar",
                                   avatar_.string(),
                                   "--vmc",
                                   "127.0.0.1:9",
                                   "--vmc-deaf",  // The former name of --vmc-send-only.
                                   "--no-open",
                                   "--json",
                                   "--progress",
                                   "none",
                                   "--port",
                                   std::to_string(port_),
                                   "--seconds",
                                   std::to_string(seconds)};
    words.insert(words.end(), more.begin(), more.end());
    run_ = std::async(std::launch::async,
                      [words] { return run_program(kTakesProgram, words); });
  }

  /// Opens a page. Tries again until the server answers.
  [[nodiscard]] WebSocketClient open_page() const {
    for (int tries = 0;; ++tries) {
      WebSocketClient page(port_);
      if (page.upgrade().find(" 101 ") != std::string::npos || tries > 200) return page;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  /// The next status for which `holds`; null: none came.
  template <class Holds>
  static json status_when(WebSocketClient& page, Holds holds) {
    while (const auto message = page.receive_message()) {
      if (message->opcode != 1) continue;
      json words = json::parse(message->payload);
      if (words["type"] == "status" && holds(words)) return words;
    }
    return {};
  }

  static void record(const WebSocketClient& page, bool on) {
    page.send_frame(1, json{{"type", "record"}, {"on", on}}.dump());
  }

  /// Frames that can be replayed; -1 when one of them is not as it was.
  static long replayed(const std::string& take) {
    const ProgramRun replay =
        run_program(kTakesProgram, {"replay", take, "--fast", "--json"});
    if (replay.exit_code != 0) return -1;
    const json found = json::parse(replay.out);
    return found["differing"] == 0 ? found["frames"].get<long>() : -1;
  }

  ScratchFolder session_;
  // The avatar's name is not UTF-8. No file of a take may depend on this name.
  std::filesystem::path avatar_ = session_ / "b\xF6rn.glb";
  int port_ = free_port();
  std::future<ProgramRun> run_;
};

TEST_F(LiveTakesOfThePage, BeginInTheMiddleAndAreReplayedToTheSameBytes) {
  start(12.0);
  WebSocketClient page = open_page();
  // Two more browsers, one that is killed and one that hangs, do not affect the run.
  { const WebSocketClient killed = open_page(); }
  const WebSocketClient hanging = open_page();
  const json before = status_when(
      page, [](const json& status) { return status["subject"] == "tracked"; });
  ASSERT_FALSE(before.is_null());
  EXPECT_TRUE(before["recording"].is_null());
  // The initial state of a take includes the drags that are active at its begin.
  page.send_frame(
      1, R"({"type":"drag","id":"left hand","p_in_world":[0.4,1.2,0.3],"phase":"move"})");
  record(page, true);
  const json during = status_when(page, [](const json& status) {
    return !status["recording"].is_null() && status["recording"]["seconds"] > 0.5;
  });
  ASSERT_FALSE(during.is_null());
  EXPECT_EQ(during["recording"]["trouble"], "");
  const std::string first = (session_ / "takes/live-1").string();
  EXPECT_EQ(during["recording"]["file"], first);
  record(page, false);
  ASSERT_FALSE(status_when(page, [](const json& status) {
                 return status["recording"].is_null();
               }).is_null());
  record(page, true);  // Goes on until the run ends.

  const ProgramRun run = run_.get();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json takes = json::parse(run.out)["takes"];
  ASSERT_FALSE(takes.empty()) << run.err;
  EXPECT_EQ(takes[0], first);
  EXPECT_GT(replayed(first), 8);
  // The run may have ended before the second had its first frame: then it is not kept.
  const std::string second = (session_ / "takes/live-2").string();
  const bool is_kept = takes.size() == 2;
  EXPECT_EQ(std::filesystem::exists(second), is_kept) << run.err;
  if (is_kept) {
    EXPECT_EQ(takes[1], second);
    EXPECT_GT(replayed(second), 0);
  } else {
    EXPECT_NE(run.err.find("live-2 is not kept"), std::string::npos) << run.err;
  }
  const auto take = recordings::read_live_take(first + "/live.sqlite");
  ASSERT_TRUE(take);
  EXPECT_TRUE(take->finished);
  EXPECT_TRUE(take->instants.front().results.empty());
  EXPECT_NE(take->instants.front().requests.find("left hand"), std::string::npos);
}

TEST_F(LiveTakesOfThePage, ReportWhyRecordingFailsAndTheRunContinues) {
  std::ofstream(session_ / "takes") << "a file where a folder should be";
  start(8.0);
  WebSocketClient page = open_page();
  record(page, true);
  const json failed = status_when(page, [](const json& status) {
    return !status["recording"].is_null() && status["recording"]["trouble"] != "";
  });
  ASSERT_FALSE(failed.is_null());
  record(page, false);
  const json after =
      status_when(page, [](const json& status) { return status["recording"].is_null(); });
  ASSERT_FALSE(after.is_null());
  EXPECT_GT(after["frame"], failed["frame"]);
  const ProgramRun run = run_.get();
  // A file where a folder should be is bad input, not a full disk.
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("goes on without recording"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
  EXPECT_TRUE(json::parse(run.out)["takes"].empty());
}

}  // namespace
}  // namespace marey::testing
