// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Cost of the posture of a character that blends two clips (bar 7 of the engine): two
// samples, blend with weights of groups, root delta. The baseline blends 22 joints by
// glm's slerp in double precision, array of structures. Both run on one core, in turns;
// medians.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#include "engine/blend/blend_postures.h"
#include "engine/clips/sample_clip.h"
#include <glm/gtc/quaternion.hpp>
#include <time.h>

namespace marey::engine {
namespace {

constexpr std::size_t kCharacters = 1000;
constexpr std::size_t kJoints = 22;
constexpr std::size_t kFrames = 240;
constexpr int kRounds = 101;

using JointFrame = std::array<glm::dquat, kJoints>;

struct PlainClip {
  std::vector<JointFrame> frames;
};

glm::dquat swung(std::mt19937& random, const glm::dquat& from, double angle_rad) {
  std::normal_distribution<double> normal;
  const glm::dvec3 axis{normal(random), normal(random), normal(random) + 1e-3};
  return glm::normalize(from * glm::angleAxis(angle_rad, glm::normalize(axis)));
}

PlainClip plain_clip(std::mt19937& random) {
  PlainClip clip;
  JointFrame frame;
  for (glm::dquat& q : frame) q = swung(random, glm::dquat(1, 0, 0, 0), 0.4);
  for (std::size_t i = 0; i < kFrames; ++i) {
    for (glm::dquat& q : frame) q = swung(random, q, 0.02);
    clip.frames.push_back(frame);
  }
  return clip;
}

MotionClip lane_clip(std::mt19937& random) {
  MotionClip clip;
  clip.rate_hz = 60.0F;
  std::array<glm::dquat, kPostureRotations> rotations;
  for (glm::dquat& q : rotations) q = swung(random, glm::dquat(1, 0, 0, 0), 0.4);
  for (std::size_t i = 0; i < kFrames; ++i) {
    BlendPosture posture;
    for (std::size_t r = 0; r < kPostureRotations; ++r) {
      rotations[r] = swung(random, rotations[r], 0.02);
      posture.x[r] = static_cast<float>(rotations[r].x);
      posture.y[r] = static_cast<float>(rotations[r].y);
      posture.z[r] = static_cast<float>(rotations[r].z);
      posture.w[r] = static_cast<float>(rotations[r].w);
    }
    posture.fold_rad.fill(0.9F);
    posture.height_legs = 1.0F;
    clip.frames.push_back(posture);
    clip.path.push_back(
        {0.01F * static_cast<float>(i), 0.0F, 0.001F * static_cast<float>(i)});
  }
  return clip;
}

struct Member {
  double time_s[2]{};
  float weight = 0.0F;
  BlendSides sides;
  BlendPosture posture;
  RootPlace delta;
  JointFrame joints;
};

void sample_plain(const PlainClip& clip, double time_s, JointFrame& out) {
  const double position = time_s * 60.0;
  const auto frame = static_cast<std::size_t>(position);
  const double at = position - static_cast<double>(frame);
  for (std::size_t j = 0; j < kJoints; ++j) {
    out[j] = glm::slerp(clip.frames[frame][j], clip.frames[frame + 1][j], at);
  }
}

using Step = std::function<void(Member&)>;

// Time of this thread on the processor: other programs do not count.
double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double time_us(std::vector<Member>& members, const Step& step) {
  const double start_us = thread_us();
  for (Member& member : members) step(member);
  return (thread_us() - start_us) / static_cast<double>(members.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + kRounds / 2, values.end());
  return values[kRounds / 2];
}

void sample_two(const std::array<MotionClip, 2>& clips,
                const Member& member,
                std::array<BlendPosture, 2>& out) {
  for (std::size_t i = 0; i < 2; ++i) sample_clip(clips[i], member.time_s[i], out[i]);
}

void blend_samples(const std::array<BlendPosture, 2>& samples, Member& member) {
  std::array<PerGroup, 2> weights;
  weights[0].fill(1.0F - member.weight);
  weights[1].fill(member.weight);
  weights[1][3] = 0.0F;
  const std::array<const BlendPosture*, 2> sources{&samples[0], &samples[1]};
  blend_postures(sources, weights, &member.sides, member.posture);
}

void move_root(const std::array<MotionClip, 2>& clips, Member& member) {
  RootPlace sum;
  for (std::size_t i = 0; i < 2; ++i) {
    const double t = member.time_s[i];
    const RootPlace delta =
        relative(path_at(clips[i], t), path_at(clips[i], t + 1.0 / 60.0));
    const double w = static_cast<double>(i == 0 ? 1.0F - member.weight : member.weight);
    sum.x_m += w * delta.x_m;
    sum.z_m += w * delta.z_m;
    sum.heading_rad += w * delta.heading_rad;
  }
  member.delta = sum;
}

int run() {
  std::mt19937 random(1);
  const std::array<MotionClip, 2> clips{lane_clip(random), lane_clip(random)};
  const std::array<PlainClip, 2> plain{plain_clip(random), plain_clip(random)};
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Member> members(kCharacters);
  for (Member& member : members) {
    for (double& time_s : member.time_s) time_s = 3.8 * unit(random);
    member.weight = static_cast<float>(0.05 + 0.9 * unit(random));
  }
  std::array<BlendPosture, 2> samples;
  std::array<JointFrame, 2> frames;
  const std::array<Step, 5> steps{
      [&](Member& m) {
        for (std::size_t i = 0; i < 2; ++i)
          sample_plain(plain[i], m.time_s[i], frames[i]);
        for (std::size_t j = 0; j < kJoints; ++j) {
          m.joints[j] =
              glm::slerp(frames[0][j], frames[1][j], static_cast<double>(m.weight));
        }
      },
      [&](Member& m) {
        sample_two(clips, m, samples);
        blend_samples(samples, m);
        move_root(clips, m);
      },
      [&](Member& m) { sample_two(clips, m, samples); },
      [&](Member& m) { blend_samples(samples, m); },
      [&](Member& m) { move_root(clips, m); }};
  std::array<std::vector<double>, 5> times_us;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t s = 0; s < steps.size(); ++s) {
      times_us[s].push_back(time_us(members, steps[s]));
    }
    ratios.push_back(times_us[0].back() / times_us[1].back());
  }
  double check = 0.0;
  for (const Member& m : members) {
    check += static_cast<double>(m.posture.w[3]) + m.joints[3].w + m.delta.x_m;
  }
  std::printf("us per character, medians of %d rounds of %zu characters (check %.3f)\n",
              kRounds,
              kCharacters,
              check);
  const std::array<const char*, 5> names{"baseline: slerp per joint, double",
                                         "sample 2 + blend + root delta",
                                         "  sample 2",
                                         "  blend",
                                         "  root delta"};
  for (std::size_t s = 0; s < steps.size(); ++s) {
    std::printf("%-36s %7.3f\n", names[s], median(times_us[s]));
  }
  std::printf(
      "%-36s %7.2f   (bar: 3; cost bar: 1.5 us)\n", "baseline / ours", median(ratios));
  return 0;
}

}  // namespace
}  // namespace marey::engine

int main() {
  return marey::engine::run();
}
