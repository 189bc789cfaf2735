// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/level.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "edit/find/fit_floor.h"
#include "edit/state/apply_contact_edits.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/resolve_moment.h"
#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/base/format_text.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::edit {
namespace {

/// Detects contacts by speed; heights may differ by the tilt of a floor.
Contacts contacts_by_speed(const EditState& state) {
  retarget::DetectContactsOptions options;
  constexpr double kAnyHeightInLegs = 0.4;
  options.start_height_legs = kAnyHeightInLegs;
  options.keep_height_legs = kAnyHeightInLegs;
  return retarget::detect_contacts(state.motion, state.map, options);
}

/// Returns the rotation about a point that takes `normal` to +Y, then moves the point to
/// the floor's height.
RigidTransform levelling(const FloorFit& floor, double floor_height_m) {
  RigidTransform out;
  out.rotation = rotation_between(floor.normal, glm::dvec3(0.0, 1.0, 0.0));
  glm::dvec3 target = floor.support_in_world;
  target.y = floor_height_m;
  out.translation = target - out.rotation * floor.support_in_world;
  return out;
}

/// Effect of levelling on the motion.
struct Levelled {
  FloorFit floor;               ///< As found last.
  RigidTransform new_from_old;  ///< All rounds.
  glm::dvec3 support_in_old{0.0};
  int stances = 0;
};

Error no_stance() {
  return bad_input("",
                   "no foot rests in this motion: the floor is not observable",
                   "use place for the height, or give a span in which a foot stands");
}

Result<Levelled> level_by_soles(const LevelOp& op,
                                const FrameRange& frames,
                                EditState& state) {
  // Shares of a leg length: a straight walk is narrower across.
  constexpr double kMinSpreadInLegs = 0.25;
  constexpr int kMaxRounds = 6;
  constexpr double kLevel_rad = 0.005 / kDegreesPerRadian;
  const double min_spread_m =
      op.tilt ? kMinSpreadInLegs * state.map.leg_length_m : HUGE_VAL;
  Levelled out;
  for (int round = 0; round < kMaxRounds; ++round) {
    const bool first = round == 0 && op.tilt;
    const auto soles =
        resting_soles(state, first ? contacts_by_speed(state) : state.contacts, frames);
    const auto floor = fit_floor(soles, min_spread_m);
    if (!floor && round == 0) return no_stance();
    if (!floor) break;
    const RigidTransform step = levelling(*floor, op.floor_height_m);
    if (round == 0) out.support_in_old = floor->support_in_world;
    move_state(step, state);
    out.new_from_old = step * out.new_from_old;
    out.floor = *floor;
    out.stances = static_cast<int>(soles.size());
    if (!op.tilt) break;
    detect_contacts_again(state);
    const double turned_rad = glm::length(rotation_vector(step.rotation));
    if (round > 0 && turned_rad < kLevel_rad) break;
  }
  return out;
}

void report_rank(const Levelled& levelled, OpReport& report) {
  if (levelled.floor.rank == FloorRank::kPlane) return;
  const bool line = levelled.floor.rank == FloorRank::kLine;
  report.findings.push_back(fair_finding(
      "tilt_unobserved",
      "footprints",
      line ? std::to_string(levelled.stances) +
                 " stances lie on one line: only the height and the tilt along that line "
                 "were levelled"
           : std::to_string(levelled.stances) +
                 " stances are at one place: only the height was levelled",
      "record a calibration of the floor, or a walk that turns"));
}

void report_level(const Levelled& levelled, const LevelOp& op, OpReport& report) {
  const double tilt_deg =
      glm::length(rotation_vector(levelled.new_from_old.rotation)) * kDegreesPerRadian;
  const FloorFit& floor = levelled.floor;
  report.figures.emplace_back("tilt_deg", tilt_deg);
  if (floor.rank == FloorRank::kPlane) {
    report.figures.emplace_back("tilt_sigma_deg",
                                floor.tilt_sigma_rad * kDegreesPerRadian);
  }
  report.figures.emplace_back("residual_mm", 1e3 * floor.residual_m);
  report.figures.emplace_back("largest_residual_mm", 1e3 * floor.largest_residual_m);
  const glm::dvec3 now = levelled.new_from_old * levelled.support_in_old;
  report.figures.emplace_back("raised_mm", 1e3 * (now.y - levelled.support_in_old.y));
  report.figures.emplace_back("stances", levelled.stances);
  if (op.tilt) report_rank(levelled, report);
  constexpr double kLargeTilt_deg = 15.0;
  if (tilt_deg > kLargeTilt_deg) {
    report.findings.push_back(
        fair_finding("tilt",
                     "floor",
                     "the floor was tilted by " + format_text("%.1f degrees", tilt_deg),
                     "check which axis of the file points up")
            .measured(tilt_deg, kLargeTilt_deg, "deg"));
  }
  constexpr double kLargeResidual_mm = 30.0;
  const double residual_mm = 1e3 * floor.largest_residual_m;
  if (residual_mm <= kLargeResidual_mm) return;
  report.findings.push_back(
      fair_finding(
          "residual",
          "frame " + std::to_string(floor.worst_frame),
          "a footprint is " + format_text("%.0f mm", residual_mm) + " off the plane",
          "give a span in which the feet stand on the floor")
          .measured(residual_mm, kLargeResidual_mm, "mm"));
}

}  // namespace

Result<EditState> apply_level(const LevelOp& op,
                              const OpContext& context,
                              const EditState& state,
                              OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true}); !ok) return ok.error();
  const auto span = resolve_span(state, context.op.span);
  if (!span) return span.error();
  const FrameRange frames{static_cast<int>(std::floor(span->first)),
                          static_cast<int>(std::ceil(span->last))};
  EditState out = state;
  const auto levelled = level_by_soles(op, frames, out);
  if (!levelled) return levelled.error();
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  report_level(*levelled, op, report);
  return out;
}

}  // namespace marey::edit
