// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Does a body follow a displaced centre of mass with its feet in place, without
// roughness? This program displaces the centre of mass of captured motions by smooth
// courses, on five bodies of 0.6 to 2.5 m, and compares follow_com() with the Adapter
// (method strict, balance in three dimensions, feet as supports) in the same run.
// docs/accuracy/dynamics.md describes how to run it and explains the columns.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "benchmarks/dynamics/com_subjects.h"
#include "benchmarks/parts/result_table.h"
#include "core/human/centre_of_mass.h"
#include "retarget/adapt/adapter.h"
#include "retarget/com/follow_com.h"
#include "retarget/contacts/measure_contacts.h"
#include "tests/support/program/thread_time.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using retarget::FootGoal;

constexpr int kTimedRuns = 3;

/// Figures of one result. Distances by forward kinematics of the result.
struct Figures {
  double com_mm = 0.0;         ///< Frames with flat feet within reach.
  double foot_mm = 0.0;        ///< The same frames: ankles of held feet.
  double raised_com_mm = 0.0;  ///< Frames with raised heels.
  double ball_mm = 0.0;        ///< The same frames: toe joints of held feet.
  double rise_cm = 0.0;
  double peak_jerk = 0.0;  ///< Relative to the motion's before.
  double mean_jerk = 0.0;
  double us_per_frame = 0.0;
};

double peak_jerk(const Motion& motion) {
  const double hz3 = std::pow(motion.rate.hz, 3.0);
  std::array<std::vector<RigidTransform>, 4> last;
  double worst = 0.0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    last[t % 4] = world_from_joints(motion.skeleton, motion.poses[t]);
    if (t < 3) continue;
    for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
      const auto at = [&](std::size_t back) {
        return last[(t - back) % 4][j].translation;
      };
      worst =
          std::max(worst, hz3 * glm::length(at(0) - 3.0 * at(1) + 3.0 * at(2) - at(3)));
    }
  }
  return worst;
}
template <class Work>
double us_per_frame(std::size_t frames, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kTimedRuns; ++run) {
    const double begin_s = testing::thread_time_s();
    work();
    best = std::min(best, testing::thread_time_s() - begin_s);
  }
  return 1e6 * best / static_cast<double>(frames);
}

/// The peer: feet as supports whose targets and activation follow the goals.
Result<double> adapt_to_plan(const Subject& subject,
                             const std::vector<glm::dvec3>& wanted,
                             const std::vector<glm::dvec3>& displaced,
                             Motion& out) {
  ConstraintSet supports;
  for (const char* foot : {"leftFoot", "rightFoot"}) {
    Constraint& constraint = supports.constraints.emplace_back();
    constraint.id = foot;
    constraint.point.segment = foot;
    constraint.goal = Support{glm::dvec3(0.0), glm::dquat(1, 0, 0, 0)};
    constraint.activation.start_s = 1e9;
    // Fully active in the first frame in which the foot is held.
    const double fade_s =
        (2.0 * half_fade(subject.motion.rate) - 1.0) / subject.motion.rate.hz;
    constraint.activation.start_duration_s = fade_s;
    constraint.activation.stop_duration_s = fade_s;
  }
  retarget::AdaptOptions options;
  options.balance = retarget::BalanceMode::k3d;
  Result<retarget::Adapter> made =
      retarget::Adapter::make(subject.character, supports, options);
  if (!made) return made.error();
  // A support begins when its foot begins to be held, and ends with the last full hold.
  std::array<std::vector<char>, 2> on;
  for (std::size_t side = 0; side < 2; ++side) {
    on[side].assign(wanted.size(), 0);
    for (std::size_t t = wanted.size(); t-- > 0;) {
      const double hold = subject.feet[side][t].hold;
      const bool next = t + 1 < wanted.size() && on[side][t + 1] != 0;
      on[side][t] = hold >= 1.0 || (hold > 0.0 && next) ? 1 : 0;
    }
  }
  const auto adapt = [&] {
    retarget::Adapter adapter =
        *retarget::Adapter::make(subject.character, supports, options);
    std::array handles{*adapter.constraint("leftFoot"), *adapter.constraint("rightFoot")};
    for (std::size_t t = 0; t < wanted.size(); ++t) {
      const double time_s = static_cast<double>(t) / subject.motion.rate.hz;
      for (std::size_t side = 0; side < 2; ++side) {
        const FootGoal& goal = subject.feet[side][t];
        const bool was_on = t > 0 && on[side][t - 1] != 0;
        if (on[side][t] != 0 && !was_on) handles[side].start(t > 0 ? time_s : -10.0);
        if (on[side][t] == 0 && was_on) handles[side].stop(time_s);
        handles[side].set_target(goal.place.ankle_in_world +
                                 (1.0 - goal.hold) * displaced[t]);
        handles[side].set_orientation(goal.place.foot);
      }
      adapter.set_balance_target(wanted[t]);
      static_cast<void>(adapter.adapt(subject.motion.poses[t], time_s, out.poses[t]));
    }
  };
  return us_per_frame(wanted.size(), adapt);
}

/// Frames in which follow_com() raised no heel and found both legs long enough, and
/// frames in which heels were raised.
struct FrameKinds {
  std::vector<char> flat;
  std::vector<char> raised;
  int short_frames = 0;
};

/// Compares a result with the plan.
Figures figures_of(const Subject& subject,
                   const std::vector<glm::dvec3>& wanted,
                   const FrameKinds& kinds,
                   const Motion& made) {
  Figures out;
  const auto& toes = subject.map.joint_of;
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    const auto joints = world_from_joints(made.skeleton, made.poses[t]);
    const auto before = world_from_joints(made.skeleton, subject.motion.poses[t]);
    const double com_mm =
        1e3 * glm::distance(centre_of_mass(subject.character.masses, joints), wanted[t]);
    if (kinds.flat[t]) out.com_mm = std::max(out.com_mm, com_mm);
    if (kinds.raised[t]) out.raised_com_mm = std::max(out.raised_com_mm, com_mm);
    for (std::size_t side = 0; side < 2; ++side) {
      if (subject.feet[side][t].hold < 1.0) continue;
      const auto off_mm = [&](JointIndex joint) {
        return 1e3 * glm::distance(joints[index(joint)].translation,
                                   before[index(joint)].translation);
      };
      const JointIndex ankle = subject.map.leg(static_cast<int>(side)).end;
      const auto ball =
          toes[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      if (kinds.flat[t]) out.foot_mm = std::max(out.foot_mm, off_mm(ankle));
      if (!kinds.raised[t]) continue;
      out.rise_cm = std::max(out.rise_cm, 0.1 * off_mm(ankle));
      if (ball) out.ball_mm = std::max(out.ball_mm, off_mm(*ball));
    }
  }
  out.peak_jerk = peak_jerk(made) / peak_jerk(subject.motion);
  out.mean_jerk = retarget::mean_jerk(made) / retarget::mean_jerk(subject.motion);
  return out;
}

FrameKinds kinds_of(const Subject& subject,
                    const std::vector<glm::dvec3>& wanted,
                    const Motion& made) {
  constexpr double kShort_m = 1e-6;
  constexpr double kRaised_m = 1e-9;
  FrameKinds out;
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    const auto joints = world_from_joints(made.skeleton, made.poses[t]);
    const bool is_short = glm::distance(centre_of_mass(subject.character.masses, joints),
                                        wanted[t]) > kShort_m;
    bool is_raised = false;
    for (std::size_t side = 0; side < 2; ++side) {
      if (subject.feet[side][t].hold < 1.0) continue;
      const JointIndex ankle = subject.map.leg(static_cast<int>(side)).end;
      is_raised = is_raised ||
                  glm::distance(joints[index(ankle)].translation,
                                subject.feet[side][t].place.ankle_in_world) > kRaised_m;
    }
    out.flat.push_back(!is_short && !is_raised);
    out.raised.push_back(!is_short && is_raised);
    out.short_frames += is_short ? 1 : 0;
  }
  return out;
}

Status add_row(const std::string& clip,
               const Stature& stature,
               const Subject& subject,
               const Course& course,
               ResultTable& table) {
  const std::vector<glm::dvec3> displaced = displaced_m(subject, course);
  std::vector<glm::dvec3> wanted = subject.com;
  for (std::size_t t = 0; t < wanted.size(); ++t) wanted[t] += displaced[t];
  Motion made = subject.motion;
  const retarget::ComFollower follower{
      made.skeleton, subject.map, subject.character.masses, made.rate};
  const retarget::ComPlan plan{
      subject.motion.poses, wanted, {subject.feet[0], subject.feet[1]}};
  retarget::FollowComReport report;
  const double follow_us = us_per_frame(
      wanted.size(), [&] { report = retarget::follow_com(follower, plan, made.poses); });
  const FrameKinds kinds = kinds_of(subject, wanted, made);
  const Figures ours = figures_of(subject, wanted, kinds, made);
  Motion adapted = subject.motion;
  const auto adapter_us = adapt_to_plan(subject, wanted, displaced, adapted);
  if (!adapter_us) return adapter_us.error();
  const Figures peer = figures_of(subject, wanted, kinds, adapted);
  table.rows.push_back({clip,
                        stature.name,
                        course.name,
                        static_cast<double>(wanted.size()),
                        static_cast<double>(kinds.short_frames),
                        1e3 * report.short_leg_m,
                        ours.com_mm,
                        peer.com_mm,
                        ours.foot_mm,
                        peer.foot_mm,
                        ours.raised_com_mm,
                        ours.ball_mm,
                        ours.rise_cm,
                        ours.peak_jerk,
                        peer.peak_jerk,
                        ours.mean_jerk,
                        peer.mean_jerk,
                        follow_us,
                        *adapter_us});
  return Done{};
}

ResultTable empty_table() {
  return {"com_following",
          "A displaced centre of mass with the feet in place: follow_com and the Adapter",
          {{"clip"},
           {"body"},
           {"course"},
           {"frames", 0},
           {"short", 0},
           {"by mm", 1},
           {"COM mm", 7},
           {"peer COM", 3},
           {"foot mm", 7},
           {"peer foot", 3},
           {"raised COM mm", 7},
           {"ball mm", 7},
           {"heel cm", 1},
           {"peak jerk", 2},
           {"peer peak", 2},
           {"mean jerk", 2},
           {"peer mean", 2},
           {"us/frame", 2},
           {"peer us", 1}},
          {},
          {"peer: the Adapter; jerk relative to the motion before"}};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.cause.c_str());
  return 3;
}

int run(const fs::path& data, const fs::path& json) {
  const auto motions = read_motions(data);
  if (!motions) return fail(motions.error());
  ResultTable table = empty_table();
  for (const NamedMotion& named : *motions) {
    for (const Stature& stature : statures()) {
      const auto subject = subject_of(named.name, named.motion, stature);
      if (!subject) return fail(subject.error());
      for (const Course& course : courses()) {
        const Status ok = add_row(named.name, stature, *subject, course, table);
        if (!ok) return fail(ok.error());
      }
    }
  }
  print_table(table);
  if (json.empty()) return 0;
  return write_tables(json, {table}) ? 0 : 5;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: measure_com_following DATA_FOLDER [FIGURES.json]\n");
    return 2;
  }
  return marey::run(argv[1], argc > 2 ? argv[2] : "");
}
