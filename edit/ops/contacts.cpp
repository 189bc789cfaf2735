// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/state/apply_contact_edits.h"
#include "edit/state/check_op_keys.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/format_text.h"
#include "core/human/contacts.h"
#include "core/pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

constexpr double kDriftToMm = 1e3;
/// Larger drifts than those of feet that slide or roll during a contact.
constexpr double kMaxDrift_mm = 50.0;

Status check_contact_edit(const ContactEdit& edit, const EditState& state) {
  const double end_s = state.duration_s() + 0.5 / state.motion.rate.hz;
  for (const double time_s : {edit.from_s, edit.to_s}) {
    if (time_s >= -0.5 / state.motion.rate.hz && time_s <= end_s) continue;
    return bad_input("edits",
                     "has the time " + format_text("%.3f", time_s) +
                         " s; the motion lasts " +
                         format_text("%.3f", state.duration_s()) + " s",
                     "choose times within the motion");
  }
  const bool is_range =
      edit.kind == ContactEdit::Kind::kSet || edit.kind == ContactEdit::Kind::kClear;
  if (is_range && edit.to_s < edit.from_s) {
    return bad_input("edits",
                     "has a contact that ends at " + format_text("%.3f", edit.to_s) +
                         " s, before it starts at " + format_text("%.3f", edit.from_s) +
                         " s",
                     "exchange the two times");
  }
  return Done{};
}

/// Returns the largest horizontal distance of a joint from its place in the first frame.
double drift_m(const EditState& state, JointIndex joint, const FrameRange& range) {
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  glm::dvec2 start(0.0);
  double largest_m = 0.0;
  for (int frame = range.first; frame <= range.last; ++frame) {
    const Pose& pose = state.motion.poses[static_cast<std::size_t>(frame)];
    world_from_joints(state.motion.skeleton, pose, joints);
    const glm::dvec3& place = joints[index(joint)].translation;
    const glm::dvec2 here(place.x, place.z);
    if (frame == range.first) start = here;
    largest_m = std::max(largest_m, glm::distance(here, start));
  }
  return largest_m;
}

/// Reports a contact that an edit has made or changed, but in which the foot moves: to
/// plant it would pull the leg out of its swing.
void report_moving_foot(const ContactEdit& edit,
                        const EditState& state,
                        OpReport& report) {
  if (edit.kind == ContactEdit::Kind::kClear) return;
  const auto side = static_cast<std::size_t>(edit.side);
  const bool is_heel = edit.part == FootPart::kHeel;
  const FootContacts& foot = state.contacts.feet[side];
  const auto toes = state.map.joint_of[marey::index(retarget::toes_bone(edit.side))];
  const JointIndex joint = is_heel || !toes ? state.map.leg(edit.side).end : *toes;
  const double hz = state.motion.rate.hz;
  // An edit that moves an edge made the contact that has this edge.
  const double from =
      (edit.kind == ContactEdit::Kind::kSet ? edit.from_s : edit.to_s) * hz;
  const double to = edit.to_s * hz;
  for (const FrameRange& range : is_heel ? foot.heel : foot.ball) {
    if (range.last < from - 1.0 || range.first > to + 1.0) continue;
    const double drift_mm = kDriftToMm * drift_m(state, joint, range);
    if (drift_mm <= kMaxDrift_mm) continue;
    report.findings.push_back(
        fair_finding("moving_contact",
                     "edits",
                     format_text("the %s %s moves by %.0f mm in its contact from %.3f to "
                                 "%.3f s",
                                 edit.side == 0 ? "left" : "right",
                                 is_heel ? "heel" : "ball",
                                 drift_mm,
                                 range.first / hz,
                                 range.last / hz),
                     "shorten or clear this contact; plant@1 would hold the foot there")
            .measured(drift_mm, kMaxDrift_mm, "mm"));
    return;
  }
}

}  // namespace

Result<EditState> apply_contacts(const ContactsOp& op,
                                 const OpContext& context,
                                 const EditState& state,
                                 OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  for (const ContactEdit& edit : op.edits) {
    if (const Status ok = check_contact_edit(edit, state); !ok) return ok.error();
  }
  EditState out = state;
  out.contact_edits.insert(out.contact_edits.end(), op.edits.begin(), op.edits.end());
  if (op.detect) {
    detect_contacts_again(out);
  } else {
    apply_contact_edits(out, op.edits);
  }
  for (const ContactEdit& edit : op.edits) report_moving_foot(edit, out, report);
  report.figures.emplace_back("left_stances",
                              static_cast<double>(out.contacts.feet[0].stance.size()));
  report.figures.emplace_back("right_stances",
                              static_cast<double>(out.contacts.feet[1].stance.size()));
  return out;
}

}  // namespace marey::edit
