// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/random_moves.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace marey::testing {
namespace {

using Random = std::mt19937;

float draw(Random& random, double min, double max) {
  return static_cast<float>(std::uniform_real_distribution<double>(min, max)(random));
}

BlendPosture random_posture(Random& random) {
  BlendPosture posture;
  std::normal_distribution<double> normal;
  for (std::size_t r = 0; r < kPostureRotations; ++r) {
    const bool is_used = r < kUsedRotations;
    const glm::dquat q =
        is_used ? glm::normalize(glm::dquat(
                      normal(random), normal(random), normal(random), normal(random)))
                : glm::dquat(1.0, 0.0, 0.0, 0.0);
    posture.w[r] = static_cast<float>(q.w);
    posture.x[r] = static_cast<float>(q.x);
    posture.y[r] = static_cast<float>(q.y);
    posture.z[r] = static_cast<float>(q.z);
  }
  for (std::size_t limb = 0; limb < 4; ++limb) {
    posture.fold_rad[limb] = draw(random, 0.3, 1.0);
    posture.mid_x[limb] = draw(random, -1.0, 1.0);
    posture.mid_y[limb] = draw(random, -1.0, 1.0);
    posture.upper_twist_rad[limb] = draw(random, -3.0, 3.0);
    posture.lower_twist_rad[limb] = draw(random, -3.0, 3.0);
  }
  posture.height_legs = draw(random, 0.5, 1.2);
  posture.abdomen_share = draw(random, 0.0, 0.3);
  posture.torso_share = draw(random, 0.3, 0.6);
  return posture;
}

/// Spans of a foot's part that repeat, with random lengths.
std::vector<ClipSpan> random_spans(Random& random, double duration_s) {
  std::vector<ClipSpan> spans;
  double time_s = static_cast<double>(draw(random, 0.0, 0.3));
  while (true) {
    const double end_s = time_s + static_cast<double>(draw(random, 0.05, 0.7));
    if (end_s > duration_s) return spans;
    spans.push_back({static_cast<float>(time_s), static_cast<float>(end_s)});
    time_s = end_s + static_cast<double>(draw(random, 0.01, 0.5));
  }
}

ConstraintSet random_constraints(Random& random) {
  const glm::dvec3 p(draw(random, -1.0, 1.0), draw(random, 0.0, 2.0), 0.1);
  ConstraintSet set;
  for (const Goal& goal : {Goal(DistanceToPoint{0.1, p}),
                           Goal(AllowedSpace{-p, p}),
                           Goal(Support{p, std::nullopt, true}),
                           Goal(Support{std::nullopt, std::nullopt, false})}) {
    Constraint& constraint = set.constraints.emplace_back();
    constraint.id = "c" + std::to_string(set.constraints.size());
    constraint.point = {"leftFoot", 0.1 * p};
    constraint.goal = goal;
    constraint.importance = static_cast<double>(draw(random, 0.5, 2.0));
    constraint.activation = {0.5, 1.5, 0.1, 0.2};
  }
  return set;
}

std::string random_sum(Random& random) {
  std::string sum;
  for (int k = 0; k < 64; ++k) sum += "0123456789abcdef"[random() % 16];
  return sum;
}

}  // namespace

MotionClip random_clip(const std::string& name, std::size_t frames, std::uint32_t seed) {
  Random random(seed);
  MotionClip clip;
  clip.name = name;
  clip.rate_hz = random() % 2 == 0 ? 30.0F : 59.94F;
  for (std::size_t i = 0; i < frames; ++i) {
    clip.frames.push_back(random_posture(random));
    clip.path.push_back(
        {draw(random, -3.0, 3.0), draw(random, -3.0, 3.0), draw(random, -9.0, 9.0)});
  }
  if (random() % 4 != 0) {
    for (auto& part : clip.contacts) part = random_spans(random, clip.duration_s());
  }
  clip.loops = random() % 2 == 0;
  for (const char* tag : {"calm", "start", "tir\xc3\xa9", "walk"}) {
    if (random() % 2 == 0) clip.tags.emplace_back(tag);
  }
  clip.notes = {{"tag: calm", 0.0, 1.0 / 3.0}, {"release", 0.7, 0.7}};
  if (random() % 2 == 0) clip.constraints = random_constraints(random);
  clip.leg_length_m = draw(random, 0.4, 1.1);
  if (random() % 2 == 0) clip.body = "ann";
  clip.document_sha256 = random_sum(random);
  if (random() % 2 == 0) clip.recipe_sha256 = random_sum(random);
  return clip;
}

MoveSet random_moves(std::size_t clips, std::size_t max_frames, std::uint32_t seed) {
  Random random(seed);
  MoveSet moves;
  moves.layout.abdomen_at[1] = draw(random, 0.1, 0.4);
  moves.layout.neck_at[1] = draw(random, 0.1, 0.9);
  for (std::size_t i = 0; i < clips; ++i) {
    const std::size_t frames = 2 + random() % (max_frames - 1);
    moves.clips.push_back(random_clip("clip." + std::to_string(1000 + i),
                                      frames,
                                      seed + static_cast<std::uint32_t>(977 * random())));
  }
  return moves;
}

}  // namespace marey::testing
