// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Jumps that were changed, on five bodies, judged by independent code. DATA is the folder
// of the shared recordings: measure_jump_edits DATA [CLIP]
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "edit/apply_op.h"
#include "edit/jump/planned_jump.h"
#include "edit/state/plant_feet.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "benchmarks/retarget/scaled_bodies.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/truth/jump_judge.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey {
namespace {

constexpr std::array kJumpBodies{BodyScale{"0.6 m", 0.34, 0.34, 0.34},
                                 BodyScale{"child", 0.7, 0.72, 0.7},
                                 BodyScale{"same", 1.0, 1.0, 1.0},
                                 BodyScale{"long legs", 1.15, 0.95, 1.0},
                                 BodyScale{"2.5 m", 1.42, 1.42, 1.42}};
constexpr std::array kRises{0.25, 0.5, 0.75, 1.25, 1.5, 2.0};

/// Worst figures over cases. Lengths in millimetres, times in milliseconds.
struct JumpFigures {
  double apex_mm = 0.0;
  double airtime_ms = 0.0;
  double landing_mm = 0.0;
  double least_push_g = 1e9;
  double off_fall_mm = 0.0;
  double off_plan_mm = 0.0;
  double slide_mm = 0.0;  ///< Added displacement of standing feet.
  double foot_mm = 0.0;   ///< Distance of held feet from their places, as reported.
  double jerk_ratio = 0.0;
  double momentum = 0.0;
  double turn_deg = 0.0;
  double short_leg_mm = 0.0;
  double plan_us = 0.0;
  int cases = 0;
  int refused = 0;
};

double figure_of(const edit::OpReport& report, const char* name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0.0;
}

struct JumpCase {
  JumpOp wish;
  double rise = 1.0;
};

/// Places of a joint in all frames, by forward kinematics.
std::vector<glm::dvec3> joint_places(const Motion& motion, JointIndex joint) {
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<glm::dvec3> out;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    out.push_back(world[index(joint)].translation);
  }
  return out;
}

/// Largest distance of a standing joint from its captured place at the same instant,
/// displaced with the landing. Toe joints count while the ball bears; ankles while the
/// heel bears and must not rise. [mm]
double added_slide_mm(const edit::EditState& captured,
                      const dynamics::JumpPlan& plan,
                      const Motion& motion) {
  const double hz = motion.rate.hz;
  double worst_m = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootContacts& foot = captured.contacts.feet[side];
    const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
    const auto toe_joint = captured.map.joint_of[index(toes)];
    for (const bool is_heel : {true, false}) {
      if (!is_heel && !toe_joint) continue;
      const JointIndex joint =
          is_heel ? captured.map.leg(static_cast<int>(side)).end : *toe_joint;
      const auto before = joint_places(captured.motion, joint);
      const auto after = joint_places(motion, joint);
      for (std::size_t k = 0; k < after.size(); ++k) {
        const double t_s = static_cast<double>(k) / hz;
        const bool landed = t_s >= plan.touchdown()->time_s;
        const bool may_rise =
            t_s > plan.lowest_s() && t_s < plan.touchdown()->time_s + 0.15;
        if (is_heel && may_rise) continue;
        const double at = plan.source_s(t_s) * hz;
        const auto bears = [&](const FrameRange& run) {
          return at >= run.first - 1e-6 && at <= run.last + 1e-6;
        };
        const auto& runs = is_heel ? foot.heel : foot.ball;
        if (std::none_of(runs.begin(), runs.end(), bears)) continue;
        const auto low = std::min(static_cast<std::size_t>(at + 1e-6), before.size() - 1);
        const auto high = std::min(low + 1, before.size() - 1);
        const double share = std::clamp(at - static_cast<double>(low), 0.0, 1.0);
        const glm::dvec3 expected = (1.0 - share) * before[low] + share * before[high] +
                                    (landed ? plan.landing_moved_m() : glm::dvec3(0.0));
        worst_m = std::max(worst_m, glm::distance(after[k], expected));
      }
    }
  }
  return 1e3 * worst_m;
}

class JumpJudge {
 public:
  JumpJudge(const edit::EditState& state, const edit::FoundJumps& found)
      : state_(state), found_(found), jump_(found.jumps[found.chosen]) {
    jerk_before_ = testing::largest_jerk_m_s3(state.motion, frames_of(jump_, 0.0));
  }

  void judge(const JumpCase& wanted, JumpFigures& out) {
    ++out.cases;
    const EditOp op{wanted.wish};
    edit::OpReport report;
    const edit::OpContext context{op, 0, inputs_};
    const auto made = edit::apply_op(context, state_, report);
    if (!made) {
      ++out.refused;
      last_refusal_ = made.error().message();
      return;
    }
    const edit::EditState& result = made->front();
    const auto reference = edit::jump_reference(found_);
    const auto plan = edit::plan_of_op(wanted.wish, **reference, state_.motion.rate);
    if (!plan || !plan->touchdown()) return;
    judge_flight(wanted, *plan, result, out);
    judge_landing(*plan, result, out);
    for (double t = plan->start_s() + 1e-6; t < plan->rest()->time_s; t += 1e-3) {
      out.least_push_g = std::min(out.least_push_g, plan->push_g(t));
    }
    out.slide_mm = std::max(out.slide_mm, added_slide_mm(state_, *plan, result.motion));
    out.foot_mm = std::max(out.foot_mm, figure_of(report, "slide_mm"));
    out.off_plan_mm = std::max(out.off_plan_mm, figure_of(report, "com_error_mm"));
    out.short_leg_mm = std::max(out.short_leg_mm, figure_of(report, "short_leg_mm"));
    out.turn_deg = std::max(out.turn_deg, figure_of(report, "turn_deg"));
    dynamics::Jump moved = jump_;
    moved.start.time_s = plan->start_s();
    moved.rest = plan->rest();
    const double jerk = testing::largest_jerk_m_s3(result.motion, frames_of(moved, 0.0));
    // A motion that was scaled to a body is played at the rate of its fall.
    const double natural = std::pow(jump_.gravity_m_s2 / 9.81, 1.5);
    const bool is_scaled = std::abs(jump_.gravity_m_s2 / 9.81 - 1.0) > 0.34;
    const double ratio = jerk / jerk_before_ * (is_scaled ? natural : 1.0);
    if (wanted.rise >= 0.5 && wanted.rise <= 1.5) {
      out.jerk_ratio = std::max(out.jerk_ratio, ratio);
    }
  }

  [[nodiscard]] const std::string& last_refusal() const { return last_refusal_; }

 private:
  [[nodiscard]] FrameRange frames_of(const dynamics::Jump& jump, double around_s) const {
    const double hz = state_.motion.rate.hz;
    const double end_s = jump.rest ? jump.rest->time_s : state_.duration_s();
    return {std::max(0, static_cast<int>((jump.start.time_s - around_s) * hz)),
            static_cast<int>((end_s + around_s) * hz)};
  }

  void judge_flight(const JumpCase& wanted,
                    const dynamics::JumpPlan& plan,
                    const edit::EditState& result,
                    JumpFigures& out) const {
    const double hz = result.motion.rate.hz;
    const FrameRange inside{
        static_cast<int>(std::ceil(plan.takeoff().time_s * hz - 1e-6)),
        static_cast<int>(std::floor(plan.touchdown()->time_s * hz + 1e-6))};
    if (inside.last - inside.first < 3) return;
    const auto flight = testing::judge_flight(result.motion, found_.masses, inside);
    out.off_fall_mm = std::max(out.off_fall_mm, 1e3 * flight.off_parabola_m);
    const double takeoff_m = jump_.takeoff.p_in_world.y;
    const double touchdown_m =
        jump_.touchdown->p_in_world.y + wanted.wish.box_m.value_or(0.0) -
        (wanted.wish.box_m
             ? jump_.landing_feet_in_world->y - jump_.takeoff_feet_in_world.y
             : 0.0);
    if (wanted.wish.apex_by_m) {
      out.apex_mm = std::max(
          out.apex_mm,
          1e3 * std::abs(flight.apex_m - (jump_.apex_m + *wanted.wish.apex_by_m)));
    }
    if (wanted.wish.airtime_s) {
      out.airtime_ms = std::max(out.airtime_ms,
                                1e3 * std::abs(flight.airtime_s(takeoff_m, touchdown_m) -
                                               *wanted.wish.airtime_s));
    }
    const std::size_t first = static_cast<std::size_t>(inside.first);
    const std::size_t count = static_cast<std::size_t>(inside.last - inside.first + 1);
    auto momentum =
        testing::judged_momentum(result.motion.skeleton,
                                 found_.masses,
                                 hz,
                                 std::span(result.motion.poses).subspan(first, count),
                                 testing::Differences::kThreePoint);
    out.momentum = std::max(out.momentum, testing::largest_sd(momentum));
  }

  /// Ankles of the last pose against the captured ones, displaced as wished.
  void judge_landing(const dynamics::JumpPlan& plan,
                     const edit::EditState& result,
                     JumpFigures& out) const {
    for (int side = 0; side < 2; ++side) {
      const auto before = edit::foot_places(state_, side);
      const auto after = edit::foot_places(result, side);
      const glm::dvec3 moved = after.back().ankle_in_world - before.back().ankle_in_world;
      out.landing_mm =
          std::max(out.landing_mm, 1e3 * glm::length(moved - plan.landing_moved_m()));
    }
  }

  const edit::EditState& state_;
  const edit::FoundJumps& found_;
  const dynamics::Jump& jump_;
  edit::EditInputs inputs_;
  std::string last_refusal_;
  double jerk_before_ = 0.0;
};

std::vector<JumpCase> wishes_of(const dynamics::Jump& jump) {
  std::vector<JumpCase> out;
  const double rise_m = jump.rise_m();
  for (const double rise : kRises) {
    JumpCase one;
    one.rise = rise;
    one.wish.apex_by_m = (rise - 1.0) * rise_m;
    out.push_back(one);
  }
  // On a scaled body the natural airtime is that of its own fall.
  const double airtime_s = (jump.touchdown->time_s - jump.takeoff.time_s) *
                           std::sqrt(jump.gravity_m_s2 / 9.81);
  for (const double factor : {0.8, 1.2}) {
    JumpCase one;
    one.wish.airtime_s = factor * airtime_s;
    out.push_back(one);
  }
  JumpCase far;
  const glm::dvec3 way = *jump.landing_feet_in_world - jump.takeoff_feet_in_world;
  far.wish.length_m = std::hypot(way.x, way.z) + 0.2 * rise_m;
  out.push_back(far);
  JumpCase box;
  box.wish.box_m =
      jump.landing_feet_in_world->y - jump.takeoff_feet_in_world.y + 0.3 * rise_m;
  box.wish.apex_by_m = 0.3 * rise_m;
  out.push_back(box);
  return out;
}

/// Returns the least time of plan_jump() for a wish, of 50 calls. [us]
double plan_us(const JumpOp& wish, const edit::FoundJumps& found, FrameRate rate) {
  const auto reference = edit::jump_reference(found);
  if (!reference) return 0.0;
  double least_us = 0.0;
  for (int k = 0; k < 50; ++k) {
    const auto from = std::chrono::steady_clock::now();
    const auto plan = edit::plan_of_op(wish, **reference, rate);
    const std::chrono::duration<double, std::micro> took =
        std::chrono::steady_clock::now() - from;
    if (plan && (k == 0 || took.count() < least_us)) least_us = took.count();
  }
  return least_us;
}

void print_row(const std::string& name, const JumpFigures& f) {
  std::printf(
      "%-34s %3d %3d %7.3f %7.3f %7.3f %8.1e %7.3f %7.3f %7.4f %7.3f %6.2f %7.4f %5.2f "
      "%6.1f "
      "%6.1f\n",
      name.c_str(),
      f.cases,
      f.refused,
      f.apex_mm,
      f.airtime_ms,
      f.landing_mm,
      f.least_push_g,
      f.off_fall_mm,
      f.off_plan_mm,
      f.slide_mm,
      f.foot_mm,
      f.jerk_ratio,
      f.momentum,
      f.turn_deg,
      f.short_leg_mm,
      f.plan_us);
}

void judge_clip(const JumpClip& clip, const BodyScale& body, bool verbose) {
  const Skeleton skeleton = scaled(clip.motion.skeleton, body);
  const auto moved = retarget::retarget_motion(clip.motion, skeleton);
  if (!moved) {
    std::printf(
        "%s %s: %s\n", clip.name.c_str(), body.name, moved.error().message().c_str());
    return;
  }
  const std::string name = clip.name + ", " + body.name;
  auto state = edit::make_edit_state(moved->motion);
  if (!state) {
    std::printf("%s: %s\n", name.c_str(), state.error().message().c_str());
    return;
  }
  state->contacts = moved->report.contacts;
  edit::plant_feet(*state);
  JumpOp any;
  const EditOp op{any};
  const edit::EditInputs inputs;
  const edit::OpContext context{op, 0, inputs};
  auto found = edit::find_state_jumps(any, context, *state);
  if (!found) {
    std::printf("%-34s %s\n", name.c_str(), found.error().message().c_str());
    return;
  }
  // The highest complete jump.
  std::size_t best = found->jumps.size();
  for (std::size_t i = 0; i < found->jumps.size(); ++i) {
    const dynamics::Jump& jump = found->jumps[i];
    if (!jump.touchdown || !jump.rest || !jump.landing_feet_in_world) continue;
    if (best == found->jumps.size() || jump.rise_m() > found->jumps[best].rise_m()) {
      best = i;
    }
  }
  if (best == found->jumps.size()) {
    std::printf("%-34s no complete jump among %zu\n", name.c_str(), found->jumps.size());
    return;
  }
  found->chosen = best;
  JumpJudge judge(*state, *found);
  JumpFigures figures;
  std::string refusals;
  for (JumpCase wanted : wishes_of(found->jumps[best])) {
    wanted.wish.jump = static_cast<int>(best) + 1;
    const int refused = figures.refused;
    figures.plan_us =
        std::max(figures.plan_us, plan_us(wanted.wish, *found, state->motion.rate));
    JumpFigures one;
    judge.judge(wanted, one);
    judge.judge(wanted, figures);
    if (verbose) {
      char label[80];
      std::snprintf(label,
                    sizeof label,
                    "  apex_by %.3f air %.3f len %.3f box %.3f",
                    wanted.wish.apex_by_m.value_or(0.0),
                    wanted.wish.airtime_s.value_or(0.0),
                    wanted.wish.length_m.value_or(0.0),
                    wanted.wish.box_m.value_or(0.0));
      print_row(label, one);
    }
    if (figures.refused > refused && verbose)
      refusals += "  " + judge.last_refusal() + "\n";
  }
  print_row(name, figures);
  std::fputs(refusals.c_str(), stdout);
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("measure_jump_edits DATA [CLIP]\n", stderr);
    return 2;
  }
  std::printf("%-34s %3s %3s %7s %7s %7s %8s %7s %7s %7s %7s %6s %7s %5s %6s %6s\n",
              "clip, body",
              "n",
              "no",
              "apexmm",
              "air ms",
              "land mm",
              "push g",
              "fall mm",
              "plan mm",
              "slidemm",
              "foot mm",
              "jerk x",
              "L sd",
              "turn",
              "leg mm",
              "us");
  for (const marey::JumpClip& clip : marey::jump_clips(argv[1])) {
    if (argc > 2 && clip.name.find(argv[2]) == std::string::npos) continue;
    if (argc <= 2 && clip.kind == "walk") continue;
    for (const marey::BodyScale& body : marey::kJumpBodies) {
      marey::judge_clip(clip, body, argc > 2);
    }
  }
  return 0;
}
