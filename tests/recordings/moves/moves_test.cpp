// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/moves/clip_figures.h"
#include "recordings/moves/read_moves.h"
#include "recordings/moves/write_moves.h"
#include "tests/support/files/random_moves.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::random_clip;
using testing::random_moves;

/// Angle between two rotations of a posture. [rad]
double angle_between(const BlendPosture& a, const BlendPosture& b, std::size_t r) {
  const glm::dquat qa(a.w[r], a.x[r], a.y[r], a.z[r]);
  const glm::dquat qb(b.w[r], b.x[r], b.y[r], b.z[r]);
  const glm::dquat turn = glm::conjugate(glm::normalize(qa)) * glm::normalize(qb);
  return 2.0 * std::asin(std::min(1.0, std::hypot(turn.x, turn.y, turn.z)));
}

void expect_same_frame(const BlendPosture& a, const BlendPosture& b) {
  constexpr double kMaxAngle_rad = 1e-6;
  for (std::size_t r = 0; r < kPostureRotations; ++r) {
    EXPECT_LE(angle_between(a, b, r), kMaxAngle_rad);
    const double cosine =
        static_cast<double>(a.x[r]) * b.x[r] + static_cast<double>(a.y[r]) * b.y[r] +
        static_cast<double>(a.z[r]) * b.z[r] + static_cast<double>(a.w[r]) * b.w[r];
    EXPECT_NEAR(cosine, 1.0, 1e-6) << "the sign of the quaternion";
  }
  BlendPosture others = b;
  others.x = a.x;
  others.y = a.y;
  others.z = a.z;
  others.w = a.w;
  EXPECT_EQ(others, a);
}

void expect_same_clip(const MotionClip& a, const MotionClip& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.rate_hz, b.rate_hz);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    expect_same_frame(a.frames[i], b.frames[i]);
  }
  EXPECT_EQ(a.path, b.path);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.loops, b.loops);
  EXPECT_EQ(a.tags, b.tags);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(*constraints_text(a.constraints), *constraints_text(b.constraints));
  for (const Constraint& constraint : a.constraints.constraints) {
    if (const auto* support = std::get_if<Support>(&constraint.goal)) {
      const Constraint* const other = b.constraints.find(constraint.id);
      ASSERT_NE(other, nullptr);
      EXPECT_EQ(support->turns, std::get<Support>(other->goal).turns);
    }
  }
  EXPECT_EQ(a.leg_length_m, b.leg_length_m);
  EXPECT_EQ(a.body, b.body);
  EXPECT_EQ(a.document_sha256, b.document_sha256);
  EXPECT_EQ(a.recipe_sha256, b.recipe_sha256);
}

// Bounds: rotations to 1e-6 rad, everything else exact.
TEST(Moves, ReadBackAsWritten) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const MoveSet moves = random_moves(1 + seed % 4, 12, seed);
    const auto bytes = moves_bytes(moves, "moves.marey");
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto read = parse_moves(*bytes, "moves.marey");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->layout, moves.layout);
    ASSERT_EQ(read->clips.size(), moves.clips.size());
    for (std::size_t i = 0; i < moves.clips.size(); ++i) {
      expect_same_clip(moves.clips[i], read->clips[i]);
    }
  }
}

TEST(Moves, AreTheSameFileEachTime) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const auto once = moves_bytes(random_moves(3, 40, seed), "moves.marey");
    const auto again = moves_bytes(random_moves(3, 40, seed), "other.marey");
    ASSERT_TRUE(once && again);
    EXPECT_EQ(*once, *again);
  }
}

TEST(Moves, TakeAtMostEightTenthsOfAMegabyteAMinute) {
  constexpr std::size_t kFramesOfAMinute = 60 * 30 + 1;
  constexpr std::size_t kMaxBytes = 800'000;
  MoveSet moves;
  moves.clips.push_back(random_clip("minute", kFramesOfAMinute, 5));
  moves.clips[0].rate_hz = 30.0F;
  ASSERT_FALSE(moves.clips[0].contacts[0].empty());
  const auto bytes = moves_bytes(moves, "moves.marey");
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_LE(bytes->size(), kMaxBytes);
  RecordProperty("bytes", static_cast<int>(bytes->size()));
}

// Components that are all equal, one alone, and lengths that are off by rounding.
TEST(Moves, KeepRotationsAtTheBordersOfTheirForm) {
  MotionClip clip = random_clip("edge", 2, 1);
  const float half = 0.5F;
  const auto root = static_cast<float>(std::sqrt(0.5));
  const std::array<std::array<float, 4>, 8> quaternions{{{half, half, half, half},
                                                         {-half, half, -half, half},
                                                         {root, root, 0, 0},
                                                         {0, 0, -root, root},
                                                         {0, 0, 0, -1},
                                                         {-1, 0, 0, 0},
                                                         {0, 0.6004F, 0.8004F, 0},
                                                         {1e-20F, 0, 0, 1}}};
  for (std::size_t r = 0; r < kUsedRotations; ++r) {
    const auto& q = quaternions[r % quaternions.size()];
    BlendPosture& frame = clip.frames[0];
    frame.w[r] = q[0];
    frame.x[r] = q[1];
    frame.y[r] = q[2];
    frame.z[r] = q[3];
  }
  const auto bytes = moves_bytes({{}, {clip}}, "moves.marey");
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto read = parse_moves(*bytes, "moves.marey");
  ASSERT_TRUE(read) << read.error().message();
  for (std::size_t r = 0; r < kUsedRotations; ++r) {
    EXPECT_LE(angle_between(clip.frames[0], read->clips[0].frames[0], r), 1e-6) << r;
  }
}

TEST(Moves, WithoutAClipCanBeRead) {
  const auto bytes = moves_bytes({}, "moves.marey");
  ASSERT_TRUE(bytes);
  const auto read = parse_moves(*bytes, "moves.marey");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_TRUE(read->clips.empty());
}

TEST(Moves, AreWrittenToAFileThatSqliteFindsSound) {
  const testing::ScratchFolder folder;
  const auto file = folder / "moves.marey";
  ASSERT_TRUE(write_moves(file, random_moves(5, 30, 3)));
  const auto read = read_moves(file);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->clips.size(), 5U);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr),
            SQLITE_OK);
  std::string answer;
  const auto keep = [](void* out, int, char** values, char**) {
    *static_cast<std::string*>(out) += values[0];
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, "PRAGMA integrity_check", keep, &answer, nullptr),
            SQLITE_OK);
  EXPECT_EQ(answer, "ok");
  sqlite3_close(database);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Moves, HaveTheSpeedOfTheirPath) {
  MotionClip clip = random_clip("walk", 31, 1);
  clip.rate_hz = 30.0F;
  clip.leg_length_m = 0.8F;
  for (std::size_t i = 0; i < clip.path.size(); ++i) {
    clip.path[i] = {0.03F * static_cast<float>(i), 0.04F * static_cast<float>(i), 0.0F};
  }
  EXPECT_NEAR(mean_speed_m_s(clip), 0.05 * 30 * 0.8, 1e-6);
}

TEST(Moves, HaveTheSupportsOfTheirContacts) {
  MotionClip clip = random_clip("walk", 61, 1);
  clip.rate_hz = 30.0F;
  clip.contacts = {};
  EXPECT_EQ(supports_of(clip), "X");
  clip.contacts[0] = {{0.0F, 1.0F}};
  EXPECT_EQ(supports_of(clip), "NL");
  clip.contacts[3] = {{0.5F, 2.0F}};
  EXPECT_EQ(supports_of(clip), "LRD");
  clip.contacts[1] = {{0.9F, 1.98F}};
  EXPECT_EQ(supports_of(clip), "LD") << "the right foot alone for less than 40 ms";
}

struct BadClip {
  const char* cause;
  void (*change)(MotionClip&);
};

TEST(Moves, RefuseClipsThatCannotBe) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::array changes{
      BadClip{"name", [](MotionClip& c) { c.name.clear(); }},
      BadClip{"name", [](MotionClip& c) { c.name = "a\nb"; }},
      BadClip{"rate", [](MotionClip& c) { c.rate_hz = 0.0F; }},
      BadClip{"rate", [](MotionClip& c) { c.rate_hz = kNan; }},
      BadClip{"legs", [](MotionClip& c) { c.leg_length_m = -1.0F; }},
      BadClip{"fewer than two", [](MotionClip& c) { c.frames.resize(1); }},
      BadClip{"places", [](MotionClip& c) { c.path.pop_back(); }},
      BadClip{"place", [](MotionClip& c) { c.path[1].x_legs = kInf; }},
      BadClip{"finite", [](MotionClip& c) { c.frames[1].height_legs = kNan; }},
      BadClip{"finite", [](MotionClip& c) { c.frames[1].mid_y[3] = kInf; }},
      BadClip{"unit length", [](MotionClip& c) { c.frames[1].x[7] = kNan; }},
      BadClip{"unit length", [](MotionClip& c) { c.frames[0].w[25] = 1.5F; }},
      BadClip{"contacts",
              [](MotionClip& c) {
                c.contacts[1] = {{0.2F, 0.1F}};
              }},
      BadClip{"contacts",
              [](MotionClip& c) {
                c.contacts[1] = {{0.0F, 99.0F}};
              }},
      BadClip{"contacts",
              [](MotionClip& c) {
                c.contacts[1] = {{kNan, 0.1F}};
              }},
      BadClip{"tags",
              [](MotionClip& c) {
                c.tags = {"b", "a"};
              }},
      BadClip{"tag", [](MotionClip& c) { c.tags = {""}; }},
      BadClip{"note", [](MotionClip& c) { c.notes[0].end_s = -1.0; }},
      BadClip{"notes", [](MotionClip& c) { std::swap(c.notes[0], c.notes[1]); }},
      BadClip{"document", [](MotionClip& c) { c.document_sha256 = "12"; }},
      BadClip{"recipe", [](MotionClip& c) { c.recipe_sha256 = "12"; }},
  };
  for (const BadClip& bad : changes) {
    MoveSet moves = {{}, {random_clip("walk", 20, 1)}};
    bad.change(moves.clips[0]);
    const auto bytes = moves_bytes(moves, "moves.marey");
    ASSERT_FALSE(bytes) << bad.cause;
    EXPECT_EQ(bytes.error().code, Errc::kBadInput);
    EXPECT_NE(bytes.error().cause.find(bad.cause), std::string::npos)
        << bytes.error().message();
    EXPECT_EQ(bytes.error().where.rfind("moves.marey: clip ", 0), 0U);
    EXPECT_FALSE(bytes.error().next.empty());
  }
}

TEST(Moves, RefuseTwoClipsOfOneName) {
  const MotionClip walk = random_clip("walk", 3, 1);
  const auto bytes = moves_bytes({{}, {walk, walk}}, "moves.marey");
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().cause.find("two clips"), std::string::npos);
}

TEST(Moves, RefuseAConstraintThatCannotBeWritten) {
  MotionClip clip = random_clip("walk", 3, 1);
  clip.constraints.constraints.resize(1);
  clip.constraints.constraints[0].id = "a\x01";
  const auto bytes = moves_bytes({{}, {clip}}, "moves.marey");
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace marey::recordings
