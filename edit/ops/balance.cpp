// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/balance.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "edit/balance/shift_zmp.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/hold_feet.h"
#include "edit/state/op_weights.h"
#include "edit/state/resample_state.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/format_text.h"
#include "retarget/balance/keep_balance.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/support_frame.h"
#include "retarget/feet/adapt_to_ground.h"

namespace marey::edit {
namespace {

/// Targets of the centre of mass are within this share of the half size of the area.
constexpr double kWithin = 0.8;
/// Frames count although their centre of mass is far outside: an edit put it there.
constexpr double kFarOutside_halves = 20.0;
/// Smaller shifts are rounding. [m]
constexpr double kShifted_m = 1e-9;
constexpr double kShown_m = 1e-4;
constexpr double kToMm = 1e3;

/// Returns a point moved into the middle of a support area, where it is outside of that.
glm::dvec2 moved_within(const retarget::SupportFrame& support, const glm::dvec2& p) {
  const glm::dvec2 aside(support.ahead.y, -support.ahead.x);
  const glm::dvec2 off = p - support.centre;
  const glm::dvec2 limit = kWithin * support.half_size_m;
  const glm::dvec2 at = glm::clamp(
      glm::dvec2(glm::dot(off, aside), glm::dot(off, support.ahead)), -limit, limit);
  return support.centre + at.x * aside + at.y * support.ahead;
}

/// Returns the displacement of the root per frame that keeps the balance. [m]
std::vector<glm::dvec3> balancing_shift(const EditState& state,
                                        const std::vector<PointMass>& masses) {
  using retarget::NormalizedPose;
  const Skeleton& skeleton = state.motion.skeleton;
  const double rise_m =
      retarget::standing_rise_m(state.map, state.contacts, state.map, 1.0);
  std::vector<NormalizedPose> poses;
  for (const Pose& pose : state.motion.poses) {
    poses.push_back(retarget::normalize(
        skeleton, state.map, pose, retarget::RootNormalization::kNone));
    poses.back().root.y += rise_m;
  }
  std::vector<NormalizedPose> grounded = poses;
  retarget::adapt_to_ground(
      skeleton, state.map, state.contacts, state.motion.rate, grounded);
  retarget::BalanceOptions options;
  options.max_offset_in_halves = kFarOutside_halves;
  retarget::BalanceReference reference = retarget::balance_reference(
      skeleton, state.map, masses, state.contacts, state.motion.rate, grounded, options);
  for (std::size_t t = 0; t < reference.com_xz_m.size(); ++t) {
    reference.com_xz_m[t] = moved_within(reference.support[t], reference.com_xz_m[t]);
  }
  std::vector<NormalizedPose> balanced = poses;
  retarget::keep_balance(reference,
                         {skeleton, state.map, masses},
                         state.contacts,
                         state.motion.rate,
                         1.0,
                         balanced,
                         options);
  std::vector<glm::dvec3> out;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    glm::dvec3 shift = balanced[t].root - poses[t].root;
    shift.y = 0.0;  // hold_feet() lowers the root.
    out.push_back(shift);
  }
  return out;
}

int outside_frames(const Motion& motion,
                   const EditState& state,
                   const std::vector<PointMass>& masses,
                   int& supported) {
  const retarget::BalanceFigures figures = retarget::balance_measures(
      retarget::track_balance(motion, state.map, masses, state.contacts));
  supported = figures.supported_frames;
  return figures.supported_frames - figures.over_frames;
}

/// Returns the finding of a foot that leaves its place.
Finding left_place(const EditState& state, double missed_m, int frame) {
  return fair_finding("reach",
                      "legs",
                      "a foot leaves its place by " +
                          format_text("%.0f mm", kToMm * missed_m) + " at " +
                          format_text("%.2f s", frame / state.motion.rate.hz),
                      "correct the posture there first")
      .measured(kToMm * missed_m, std::nullopt, "mm");
}

EditState balanced_by_zmp(const OpContext& context,
                          const EditState& state,
                          const std::vector<PointMass>& masses,
                          const OpWeights& weights,
                          OpReport& report) {
  EditState out = state;
  const ShiftZmpReport made = shift_zmp(state, masses, weights, out.motion);
  const auto outside = [](const dynamics::ZmpFigures& figures) {
    return figures.supported_frames - figures.inside_frames;
  };
  report.figures.emplace_back("zmp_loaded_frames", made.after.loaded_frames);
  report.figures.emplace_back("zmp_outside_before_frames", outside(made.before));
  report.figures.emplace_back("zmp_outside_frames", outside(made.after));
  report.figures.emplace_back("max_shift_mm", kToMm * made.max_shift_m);
  report.figures.emplace_back("lowered_mm", kToMm * made.lowered_m);
  report.figures.emplace_back(
      "displaced_mm",
      kToMm * mark_displaced(out, state.motion, weights.frames, context.index));
  if (made.after.worst_frame) {
    report.findings.push_back(
        fair_finding("zmp",
                     "frame " + std::to_string(*made.after.worst_frame),
                     "the zero moment point stays outside of the support area in " +
                         std::to_string(outside(made.after)) + " frames, by up to " +
                         format_text("%.0f mm", kToMm * made.after.worst_outside_m),
                     "check the contacts there, or balance a span without these frames")
            .measured(kToMm * made.after.worst_outside_m, std::nullopt, "mm"));
  }
  if (made.missed_m > kShown_m) {
    report.findings.push_back(left_place(state, made.missed_m, made.missed_frame));
  }
  return out;
}

}  // namespace

Result<EditState> apply_balance(const BalanceOp& op,
                                const OpContext& context,
                                const EditState& state,
                                OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true, .blend = true}); !ok) {
    return ok.error();
  }
  const auto weights = op_weights(state, context.op);
  if (!weights) return weights.error();
  const auto masses = masses_of(context, state);
  if (!masses) return masses.error();
  if (op.mode == EditBalance::kZmp) {
    return balanced_by_zmp(context, state, *masses, *weights, report);
  }
  const std::vector<glm::dvec3> shift = balancing_shift(state, *masses);
  EditState out = state;
  double max_shift_m = 0.0;
  for (int frame = weights->frames.first; frame <= weights->frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const glm::dvec3 way = weights->weight[t] * shift[t];
    max_shift_m = std::max(max_shift_m, glm::length(way));
    out.motion.poses[t].root_in_world += way;
  }
  int supported = 0;
  const int before = outside_frames(state.motion, state, *masses, supported);
  if (max_shift_m < kShifted_m) {
    out.motion = state.motion;
  } else {
    const HoldFeetReport held = hold_feet(
        state, state.motion, weights->frames, keep_both_feet(state), out.motion);
    report.figures.emplace_back("lowered_mm", kToMm * held.lowered_m);
    if (held.missed_m > kShown_m) {
      report.findings.push_back(left_place(state, held.missed_m, held.missed_frame));
    }
  }
  const int after = outside_frames(out.motion, out, *masses, supported);
  report.figures.emplace_back("supported_frames", supported);
  report.figures.emplace_back("outside_before_frames", before);
  report.figures.emplace_back("outside_frames", after);
  report.figures.emplace_back("max_shift_mm", kToMm * max_shift_m);
  report.figures.emplace_back(
      "displaced_mm",
      kToMm * mark_displaced(out, state.motion, weights->frames, context.index));
  return out;
}

}  // namespace marey::edit
