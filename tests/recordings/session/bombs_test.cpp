// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Files made to exhaust stack, memory or time. Each reader runs in a process of its own
// that may use 1 GiB and 20 seconds of processor time.
#include "tests/support/files/bombs.h"

#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/nesting.h"
#include "recordings/base/sqlite.h"
#include "recordings/body/bone_map_file.h"
#include "recordings/body/character_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/markers/marker_file.h"
#include "recordings/markers/marker_map.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/mot.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/motion/npz.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/detections_file.h"
#include "recordings/session/plan_file.h"
#include "recordings/session/session.h"
#include "recordings/session/subject_file.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/take_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::Bomb;
using testing::nested;
using testing::ScratchFolder;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSlow = true;
#else
constexpr bool kIsSlow = false;
#endif

/// A reader of one kind of file; returns success or its error.
struct Reader {
  std::string name;
  std::function<Status(const fs::path&)> read;
};

template <class Read>
Reader reader(const char* name, const Read& read) {
  return {name, [read](const fs::path& file) -> Status {
            const auto found = read(file);
            if (!found) return found.error();
            return Done{};
          }};
}

enum class Answer { kRead, kDeclined, kWrongError };

void limit(int resource, rlim_t max) {
  const rlimit both{max, max};
  (void)setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

/// Runs the reader in a process of its own; nullopt: it crashed, or exceeded a limit.
std::optional<Answer> answer_of(const Reader& reader, const fs::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, kIsSlow ? 200 : 20);
    // Sanitizers reserve terabytes of address space.
    if (!kIsSlow) limit(RLIMIT_AS, rlim_t{1} << 30);
    limit(RLIMIT_STACK, rlim_t{8} << 20);
    const Status status = reader.read(file);
    if (status) _exit(static_cast<int>(Answer::kRead));
    const bool is_expected =
        status.error().code == Errc::kBadInput && !status.error().cause.empty() &&
        !status.error().next.empty() && status.error().message().size() < 2000 &&
        status.error().message().find('\n') == std::string::npos;
    _exit(static_cast<int>(is_expected ? Answer::kDeclined : Answer::kWrongError));
  }
  int ended = 0;
  if (child < 0 || waitpid(child, &ended, 0) != child || !WIFEXITED(ended)) {
    return std::nullopt;
  }
  return static_cast<Answer>(WEXITSTATUS(ended));
}

void expect_survived(const std::vector<Bomb>& bombs, const std::vector<Reader>& readers) {
  const ScratchFolder folder;
  for (const Bomb& bomb : bombs) {
    const fs::path file = folder / bomb.name;
    ASSERT_TRUE(write_file(file, bomb.bytes));
    for (const Reader& one : readers) {
      const auto answer = answer_of(one, file);
      ASSERT_TRUE(answer) << one.name << " of " << bomb.name;
      EXPECT_NE(*answer, Answer::kWrongError) << one.name << " of " << bomb.name;
      if (!bomb.may_be_read) {
        EXPECT_EQ(*answer, Answer::kDeclined) << one.name << " of " << bomb.name;
      }
    }
    fs::remove(file);
  }
}

std::vector<Bomb> of_kind(const std::vector<Bomb>& bombs, const std::string& ending) {
  std::vector<Bomb> some;
  for (const Bomb& bomb : bombs) {
    if (bomb.name.ends_with(ending)) some.push_back(bomb);
  }
  return some;
}

TEST(Bombs, AreDeclinedInGltf) {
  expect_survived(
      testing::gltf_bombs(),
      {reader("character", [](const fs::path& file) { return read_character(file); })});
}

TEST(Bombs, AreDeclinedInBvh) {
  expect_survived(of_kind(testing::skeleton_bombs(), ".bvh"),
                  {reader("bvh", [](const fs::path& file) { return read_bvh(file); })});
}

TEST(Bombs, AreDeclinedInAsf) {
  expect_survived(of_kind(testing::skeleton_bombs(), ".asf"),
                  {reader("asf", [](const fs::path& file) { return read_asf(file); })});
}

// A body of 1000 levels is read, written as BVH and read again: a chain is legal.
TEST(Bombs, AChainOfAThousandBonesIsWrittenAndReadAgain) {
  Motion motion;
  for (int i = 0; i < 1000; ++i) {
    Joint joint;
    joint.name = "b" + std::to_string(i);
    if (i > 0) joint.parent = JointIndex{i - 1};
    motion.skeleton.joints.push_back(joint);
  }
  motion.rate = {100.0};
  const auto read = parse_bvh(bvh_text(motion), "chain.bvh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->motion.skeleton.joints.size(), 1000U);
}

TEST(Bombs, AreDeclinedInTomlByEveryReader) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.7));
  const auto copied = [](const fs::path& file) {
    // A lambda, because read_session() has a default argument.
    return read_session(file);
  };
  expect_survived(testing::toml_bombs(),
                  {reader("session", copied),
                   reader("calibration", read_calibration),
                   reader("subject", read_subject),
                   reader("plan", read_plan),
                   reader("character", read_character_spec),
                   reader("floor", read_floor),
                   reader("marker map", read_marker_map),
                   reader("bone map", [&](const fs::path& file) {
                     return read_bone_map(file, skeleton);
                   })});
}

TEST(Bombs, AreDeclinedInYamlAndXml) {
  std::vector<Bomb> calibrations = of_kind(testing::tree_bombs(), ".yaml");
  for (Bomb& bomb : of_kind(testing::tree_bombs(), ".xml")) calibrations.push_back(bomb);
  expect_survived(calibrations, {reader("calibration", read_calibration)});
  expect_survived(of_kind(testing::tree_bombs(), ".constraints"),
                  {reader("constraints", read_constraints)});
}

TEST(Bombs, AreDeclinedInTables) {
  const std::vector<Bomb> bombs = testing::table_bombs();
  std::vector<Bomb> markers = of_kind(bombs, ".c3d");
  for (Bomb& bomb : of_kind(bombs, ".trc")) markers.push_back(bomb);
  expect_survived(
      markers,
      {reader("markers", [](const fs::path& file) { return read_markers(file); })});
  expect_survived(of_kind(bombs, ".mot"), {reader("mot", read_mot)});
  expect_survived(of_kind(bombs, ".csv"),
                  {reader("joints", read_joints_csv),
                   reader("segments", read_segments_csv),
                   reader("detections", [](const fs::path& file) {
                     return read_detections(file, "key");
                   })});
}

TEST(Bombs, AreDeclinedInNpz) {
  expect_survived(testing::npz_bombs(), {reader("npz", read_npz)});
}

/// Creates a database with a take's application id and the tables of `statements`.
void make_database(const fs::path& file, int application, const std::string& statements) {
  const Database database =
      open_database(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  ASSERT_TRUE(database);
  ASSERT_TRUE(execute(database.get(),
                      "PRAGMA application_id=" + std::to_string(application) +
                          "; PRAGMA user_version=1;" + statements))
      << sqlite3_errmsg(database.get());
}

TEST(Bombs, AreDeclinedInTakes) {
  constexpr int kTake = 0x6d617265;
  constexpr int kLive = 0x6d61726c;
  const std::string endless =
      " AS WITH RECURSIVE n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n) SELECT ";
  const std::string head =
      "CREATE TABLE take(trial, started, finished); INSERT INTO take VALUES('a','b',1);"
      "CREATE TABLE camera(camera,name,file,width_px,height_px,rate_hz,device,settings);"
      "INSERT INTO camera VALUES(0,'a','b',1,1,30.0,'','');";
  const std::string live =
      "CREATE TABLE live(session, started, rate_hz, settings, finished);"
      "INSERT INTO live VALUES('a','b',30.0,'',1); CREATE TABLE camera(camera, name);";
  const ScratchFolder folder;
  int count = 0;
  const auto declined = [&](int application, const std::string& statements) {
    const fs::path file = folder / (std::to_string(count++) + ".sqlite");
    make_database(file, application, statements);
    const Reader one = application == kTake ? reader("take", read_take)
                                            : reader("live take", read_live_take);
    const auto answer = answer_of(one, file);
    ASSERT_TRUE(answer) << statements;
    EXPECT_EQ(*answer, Answer::kDeclined) << statements;
  };
  declined(
      kTake,
      head + "CREATE VIEW frame" + endless +
          "0 camera, i number, i time_ns, 0 sequence, 0 dropped_before, "
          "0 time_is_arrival, 0 damaged FROM n;CREATE TABLE event(camera,time_ns,text)");
  declined(kTake,
           head +
               "CREATE TABLE frame(camera, number, time_ns, sequence, dropped_before, "
               "time_is_arrival, damaged); CREATE VIEW event" +
               endless + "0 camera, i time_ns, '' text FROM n");
  declined(kLive,
           live + "CREATE VIEW instant" + endless +
               "i number, i time_ns, x'00000000' views, '' requests, x'' results FROM n");
  declined(kLive,
           live +
               "CREATE TABLE instant(number INTEGER PRIMARY KEY, time_ns, views, "
               "requests, results AS (zeroblob(900000000)));"
               "INSERT INTO instant(time_ns, views, requests) VALUES"
               "(1, x'00000000', ''), (2, x'00000000', ''), (3, x'00000000', '')");
}

TEST(Nesting, CountsJsonBracketsOutsideOfText) {
  EXPECT_FALSE(json_nests_too_deep(nested("[", "1", "]", kMaxNesting)));
  EXPECT_TRUE(json_nests_too_deep(nested("[", "1", "]", kMaxNesting + 1)));
  EXPECT_FALSE(json_nests_too_deep("[\"" + std::string(200, '[') + "\"]"));
  EXPECT_TRUE(json_nests_too_deep("\"\\\"\"" + std::string(200, '[')));
  EXPECT_FALSE(json_nests_too_deep("\"\\\"" + std::string(200, '[')));
  std::string flat;
  for (int i = 0; i < 1000; ++i) flat += "[],";
  EXPECT_FALSE(json_nests_too_deep(flat));
}

TEST(Nesting, CountsTheKeysOfEachJsonObject) {
  const auto object = [](std::size_t keys) {
    std::string text = "{";
    for (std::size_t i = 0; i < keys; ++i) text += "\":{\":1,";
    return text + "\"last\":1}";
  };
  EXPECT_FALSE(json_has_too_many_keys(object(kMaxKeys - 1)));
  EXPECT_TRUE(json_has_too_many_keys(object(kMaxKeys)));
  std::string many;
  for (int i = 0; i < 3; ++i) many += object(kMaxKeys - 1) + ",";
  EXPECT_FALSE(json_has_too_many_keys("[" + many + "1]"));
  EXPECT_TRUE(json_has_too_many_keys("{\"a\":" + object(kMaxKeys)));
}

TEST(Nesting, CountsTomlKeysHeadersAndBrackets) {
  const auto dots = [](std::size_t count) {
    std::string key;
    for (std::size_t i = 0; i < count; ++i) key += "a.";
    return key + "a";
  };
  EXPECT_FALSE(toml_nests_too_deep(dots(50) + " = 1\n" + dots(50) + " = 1\n"));
  EXPECT_TRUE(toml_nests_too_deep(dots(150) + " = 1\n"));
  EXPECT_TRUE(toml_nests_too_deep("[" + dots(60) + "]\n" + dots(60) + " = 1\n"));
  EXPECT_FALSE(toml_nests_too_deep("[" + dots(60) + "]\n[" + dots(60) + "]\na = 1.5\n"));
  EXPECT_TRUE(toml_nests_too_deep("a = {" + dots(60) + " = [{" + dots(60) + " = 1}]}"));
  EXPECT_FALSE(toml_nests_too_deep("a = \"\"\"\n" + dots(500) + "\"\"\"\"\nb = 1\n"));
  EXPECT_FALSE(toml_nests_too_deep("# " + dots(500) + "\na = '" + dots(500) + "'\n"));
  EXPECT_TRUE(toml_nests_too_deep("a = '''x'''''\n" + dots(500) + " = 1\n"));
  EXPECT_FALSE(toml_nests_too_deep("a = [" + nested("[1.5, 2.5],", "", "", 500) + "]\n"));
}

}  // namespace
}  // namespace marey::recordings
