// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// `marey live` and `marey replay` on the sample session, its walk played as four cameras,
// with the cameras and the subject of the sample's own results.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "live/udp/udp_listener.h"
#include "live/vmc/osc_parse.h"
#include "live/web/web_server.h"
#include "recordings/takes/live_take.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

const std::filesystem::path kSample = marey::testing::sample_session();
const std::filesystem::path kResults = marey::testing::sample_results() / "once";
const std::filesystem::path kProgram = marey::testing::program();

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Returns the arguments of a run that plays the walk. Its wait for pictures is long,
/// because other tests load the machine. The tests hold for a run that drops pictures.
Words played() {
  return {"live",
          kSample.string(),
          "--results",
          kResults.string(),
          "--play",
          "walk",
          "--wait-ms",
          "500",
          "--json",
          "--progress",
          "none",
          "--no-page",
          "--vmc-send-only"};
}

/// Runs `script` in a shell; $0 is the program, $@ are the words.
ProgramRun run_in_shell(const std::string& script, const Words& words) {
  return run_program("/bin/bash", with({"-c", script, kProgram.string()}, words));
}

/// Runs the program, and sends it `signal` as soon as `is_enough` holds. `is_enough`
/// receives the number of packets sent, because the time for them depends on the machine,
/// and standard error. `limits` precede the program in the shell.
ProgramRun run_until(
    const std::string& limits,
    const std::string& signal,
    const Words& words,
    const std::function<bool(int sent, const std::string& said)>& is_enough) {
  const ScratchFolder folder;
  const std::string stop = (folder / "stop").string();
  const std::string said = (folder / "said").string();
  auto listener = live::UdpListener::open({"127.0.0.1", 0});
  EXPECT_TRUE(listener);
  const Words more{"--vmc", "127.0.0.1:" + std::to_string(listener->port())};
  auto run = std::async(std::launch::async, [&] {
    return run_in_shell(limits + "\"$0\" \"$@\" 2> " + said + " & until [ -e " + stop +
                            " ] || ! kill -0 $!; do sleep 0.02; done; kill -" + signal +
                            " $!; wait $!; code=$?; cat " + said + " >&2; exit $code",
                        with(words, more));
  });
  int sent = 0;
  while (run.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) {
    while (listener->receive()) ++sent;
    if (is_enough(sent, read_text(said))) std::ofstream(stop) << "now";
  }
  return run.get();
}

class LiveRecording : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    const std::string glb = (*folder_ / "body.glb").string();
    const ProgramRun made = run_program(kProgram, {"mannequin", "--out", glb});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    auto listener = live::UdpListener::open({"127.0.0.1", 0});
    ASSERT_TRUE(listener);
    run_ =
        new ProgramRun(run_program(kProgram,
                                   with(played(),
                                        {"--avatar",
                                         glb,
                                         "--vmc",
                                         "127.0.0.1:" + std::to_string(listener->port()),
                                         "--vrchat",
                                         "127.0.0.1:" + std::to_string(listener->port()),
                                         "--record",
                                         take().string()})));
    received_ = 0;
    while (const auto packet = listener->receive()) ++received_;
  }
  static void TearDownTestSuite() {
    delete run_;
    delete folder_;
  }
  static std::filesystem::path take() { return *folder_ / "take"; }

  static inline ScratchFolder* folder_ = nullptr;
  static inline ProgramRun* run_ = nullptr;
  static inline int received_ = 0;
};

TEST_F(LiveRecording, FollowsTheWalkToItsEnd) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const auto figures = nlohmann::json::parse(run_->out);
  EXPECT_GT(figures["frames"], 20);
  EXPECT_GT(figures["tracked"], 15);
  EXPECT_EQ(figures["cameras"].size(), 4U);
  EXPECT_EQ(figures["outputs"][0]["failed"], 0);
  EXPECT_EQ(figures["outputs"][0]["sent"], figures["frames"]);
  EXPECT_EQ(figures["outputs"][1]["name"].get<std::string>().rfind("VRChat", 0), 0U);
  EXPECT_GE(figures["outputs"][1]["sent"], figures["tracked"]);
  // The test reads the socket only after the run. A socket holds some hundred packets.
  EXPECT_GT(received_, 20);
}

TEST_F(LiveRecording, IsReplayedToTheSameBytes) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const auto live = recordings::read_live_take(take() / recordings::kLiveTakeFile);
  ASSERT_TRUE(live) << live.error().message();
  EXPECT_TRUE(live->finished);
  for (const Words& how : {Words{"--fast"}, Words{"--speed", "4"}}) {
    const ProgramRun replay =
        run_program(kProgram, with({"replay", take().string(), "--json"}, how));
    ASSERT_EQ(replay.exit_code, 0) << replay.err;
    const auto found = nlohmann::json::parse(replay.out);
    EXPECT_EQ(found["frames"], live->instants.size());
    EXPECT_EQ(found["differing"], 0);
  }
}

TEST_F(LiveRecording, IsReplayedToTheSameBytesOnOneCore) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const ProgramRun replay = run_program(
      "/usr/bin/taskset",
      {"-c", "0", kProgram.string(), "replay", take().string(), "--fast", "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(nlohmann::json::parse(replay.out)["differing"], 0);
}

// So that the two above can fail.
TEST_F(LiveRecording, FailsReplayAfterAChange) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const ScratchFolder folder;
  std::filesystem::copy(
      take(), folder / "take", std::filesystem::copy_options::recursive);
  const auto original = recordings::read_live_take(take() / recordings::kLiveTakeFile);
  std::filesystem::remove(folder / "take" / recordings::kLiveTakeFile);
  {
    auto writer = recordings::LiveTakeWriter::create(
        folder / "take" / recordings::kLiveTakeFile, original->head);
    ASSERT_TRUE(writer);
    for (recordings::LiveTakeInstant one : original->instants) {
      if (!one.seen.views.empty() && !one.seen.views[0].tags.empty()) {
        one.seen.views[0].tags[0].corners_px[0].x += 0.25;
      }
      EXPECT_TRUE(writer->add(one));
    }
    ASSERT_TRUE(writer->finish());
  }
  const ProgramRun replay =
      run_program(kProgram, {"replay", (folder / "take").string(), "--fast"});
  EXPECT_EQ(replay.exit_code, 4);
  EXPECT_NE(replay.err.find("differ from the recording"), std::string::npos)
      << replay.err;
}

// A second marey, with the same avatar, receives the packets of the walk.
TEST_F(LiveRecording, IsReceivedAsAMotion) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const auto free = live::UdpListener::open({"127.0.0.1", 0});
  ASSERT_TRUE(free);
  const std::string at = "127.0.0.1:" + std::to_string(free->port() + 1);
  const std::string body = (*folder_ / "body.glb").string();
  const std::string motion = (*folder_ / "received.bvh").string();
  const ProgramRun run = run_in_shell(
      "\"$0\" listen \"$2\" --at $1 --out \"$3\" --json --seconds 6 & sleep 1; "
      "\"$0\" replay \"$4\" --vmc $1; wait $!",
      {at, body, motion, take().string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto received = nlohmann::json::parse(run.out);
  EXPECT_GT(received["kept"], 20) << run.err;
  EXPECT_EQ(received["malformed"], 0);
  EXPECT_TRUE(std::filesystem::exists(motion)) << run.err;
}

TEST_F(LiveRecording, IsNeverWrittenOver) {
  ASSERT_EQ(run_->exit_code, 0) << run_->err;
  const ProgramRun again =
      run_program(kProgram, with(played(), {"--record", take().string()}));
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_NE(again.err.find("not empty"), std::string::npos) << again.err;
}

TEST(LiveRecordingInTrouble, LosesAtMostASecondWhenItsProcessIsKilled) {
  const ScratchFolder folder;
  const std::string take = (folder / "take").string();
  // Two seconds at least, of which one may be lost.
  const ProgramRun killed =
      run_until("",
                "KILL",
                with(played(), {"--loop", "--record", take}),
                [](int sent, const std::string&) { return sent > 60; });
  EXPECT_EQ(killed.exit_code, 128 + 9) << killed.err;
  const auto kept = recordings::read_live_take(folder / "take/live.sqlite");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_FALSE(kept->finished);
  EXPECT_GT(kept->instants.size(), 10U);
  const ProgramRun replay = run_program(kProgram, {"replay", take, "--fast"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_NE(replay.err.find("was cut off"), std::string::npos) << replay.err;
}

// Files may not grow beyond 200 kB, as on a disk with so much room.
TEST(LiveRecordingInTrouble, GoesOnWithoutItWhenTheDiskIsFull) {
  const ScratchFolder folder;
  const std::string take = (folder / "take").string();
  int until_full = 0;
  const ProgramRun run =
      run_until("trap '' XFSZ; ulimit -f 200; ",
                "TERM",
                with(played(), {"--loop", "--record", take}),
                [&](int sent, const std::string& said) {
                  const bool is_full = said.find("goes on without") != std::string::npos;
                  if (!is_full) until_full = sent;
                  return is_full && sent > until_full + 10;
                });
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("goes on without recording"), std::string::npos) << run.err;
  const auto figures = nlohmann::json::parse(run.out);
  EXPECT_TRUE(figures.contains("recording_trouble"));
  const auto kept = recordings::read_live_take(folder / "take/live.sqlite");
  ASSERT_TRUE(kept) << kept.error().message();
  // Frames that the run had after the disk was full.
  EXPECT_GT(figures["frames"], kept->instants.size() + 5);
  EXPECT_GT(kept->instants.size(), 5U);
}

/// Expects the exit code, `because` and a next step on standard error, and no output.
void expect_refused(const Words& words, int exit_code, const std::string& because) {
  const ProgramRun run = run_program(kProgram, words);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_NE(run.err.find(because), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
  EXPECT_TRUE(run.out.empty()) << run.out;
}

// A run with too short a stand measures no subject, and writes no subject.toml.
TEST(LiveCalibration, NeedsASubjectToStandAndNoSubjectBefore) {
  const ScratchFolder folder;
  std::filesystem::copy(kResults / "calibration.toml", folder / "calibration.toml");
  const ProgramRun run = run_program(kProgram,
                                     {"live",
                                      kSample.string(),
                                      "--results",
                                      folder.path().string(),
                                      "--play",
                                      "static",
                                      "--calibrate",
                                      "--stand-s",
                                      "60",
                                      "--wait-ms",
                                      "500",
                                      "--json",
                                      "--no-page"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("standing still for long enough"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("no subject was measured"), std::string::npos) << run.err;
  EXPECT_GT(nlohmann::json::parse(run.out)["frames"], 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "subject.toml"));
}

TEST(LiveRefuses, ToMeasureWhileATakeIsRecorded) {
  const ScratchFolder folder;
  const ProgramRun run = run_program(
      kProgram, with(played(), {"--calibrate", "--record", (folder / "take").string()}));
  EXPECT_EQ(run.exit_code, 2) << run.err;
}

TEST(LiveRefuses, SessionsWithoutCalibrationOrSubject) {
  const ScratchFolder folder;
  const Words live{"live", kSample.string(), "--play", "walk", "--results"};
  expect_refused(with(live, {folder.path().string()}), 3, "there is no calibration");
  std::filesystem::copy(kResults / "calibration.toml", folder / "calibration.toml");
  expect_refused(with(live, {folder.path().string()}), 3, "there is no subject");
}

TEST(LiveRefuses, CamerasThatWereNotCalibrated) {
  const ScratchFolder folder;
  std::filesystem::copy(kResults / "subject.toml", folder / "subject.toml");
  std::ifstream in(kResults / "calibration.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = 0; (at = text.find("cam2", at)) != std::string::npos;) {
    text.replace(at, 4, "door");
  }
  std::ofstream(folder / "calibration.toml") << text;
  expect_refused(
      {"live", kSample.string(), "--play", "walk", "--results", folder.path().string()},
      3,
      "\"cam2\" is not in the calibration");
}

TEST(LiveRefuses, MissingOrInvalidInputs) {
  expect_refused(with(played(), {"--camera", "cam7"}), 3, "there is no camera");
  expect_refused(with(played(), {"--camera", "cam1"}), 3, "at least two");
  expect_refused({"live", kSample.string(), "--play", "dance"}, 3, "there is no trial");
  expect_refused({"live", kSample.string()}, 3, "at least two cameras with a device");
  expect_refused(with(played(), {"--vmc", "nobody=127.0.0.1"}), 3, "no avatar");
  expect_refused(with(played(), {"--vmc", "127.0.0.1:99999"}), 3, "99999");
  expect_refused({"replay", "/nowhere/at/all"}, 3, "the file does not exist");
}

TEST(LiveRefuses, AvatarsThatAreNotHumanoid) {
  const ScratchFolder folder;
  std::ofstream(folder / "box.bvh") << "HIERARCHY\nROOT box\n{\n  OFFSET 0 0 0\n"
                                       "  CHANNELS 3 Zrotation Xrotation Yrotation\n"
                                       "  End Site\n  {\n    OFFSET 0 1 0\n  }\n}\n"
                                       "MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n";
  expect_refused(
      with(played(), {"--avatar", (folder / "box.bvh").string()}), 3, "box.bvh");
}

TEST(LiveRefuses, ABusyPortThatWasAskedFor) {
  auto taken = live::UdpListener::open({"127.0.0.1", 0});
  ASSERT_TRUE(taken);
  Words words = played();
  words.pop_back();  // Deaf.
  expect_refused(
      with(words, {"--vmc", "127.0.0.1", "--vmc-listen", std::to_string(taken->port())}),
      5,
      std::to_string(taken->port()));
}

// The page is opened before the take: a refusal leaves no folder behind.
TEST(LiveRefuses, ABusyPageWithoutBeginningATake) {
  const ScratchFolder folder;
  live::WebServerOptions free;
  free.port = 0;
  auto server = live::WebServer::start(free);
  ASSERT_TRUE(server);
  Words words = played();
  std::erase(words, "--no-page");
  const auto take = folder / "take";
  expect_refused(with(words,
                      {"--no-open",
                       "--port",
                       std::to_string(server->port()),
                       "--record",
                       take.string()}),
                 5,
                 "in use");
  EXPECT_FALSE(std::filesystem::exists(take));
}

}  // namespace
}  // namespace marey::testing
