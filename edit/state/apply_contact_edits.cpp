// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/apply_contact_edits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <vector>

#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {


void mark(std::vector<char>& marks, int first, int last, char value) {
  const int end = static_cast<int>(marks.size()) - 1;
  for (int frame = std::max(first, 0); frame <= std::min(last, end); ++frame) {
    marks[static_cast<std::size_t>(frame)] = value;
  }
}

/// Moves the edge of the run whose start (or end) is nearest.
void move_edge(std::vector<char>& marks, bool is_start, int from, int to, double reach) {
  std::optional<FrameRange> nearest;
  int distance = static_cast<int>(std::floor(reach)) + 1;
  for (const FrameRange& run : retarget::runs_with(marks)) {
    const int away = std::abs((is_start ? run.first : run.last) - from);
    if (away >= distance) continue;
    distance = away;
    nearest = run;
  }
  if (!nearest) return;
  mark(marks, nearest->first, nearest->last, 0);
  if (is_start) {
    mark(marks, to, nearest->last, 1);
  } else {
    mark(marks, nearest->first, to, 1);
  }
}

void apply(const EditState& state, const ContactEdit& edit, std::vector<char>& marks) {
  const double hz = state.motion.rate.hz;
  const int from = static_cast<int>(std::lround(edit.from_s * hz));
  const int to = static_cast<int>(std::lround(edit.to_s * hz));
  switch (edit.kind) {
    case ContactEdit::Kind::kSet:
      return mark(marks, from, to, 1);
    case ContactEdit::Kind::kClear:
      return mark(marks, from, to, 0);
    case ContactEdit::Kind::kMoveStart:
    case ContactEdit::Kind::kMoveEnd:
      return move_edge(marks,
                       edit.kind == ContactEdit::Kind::kMoveStart,
                       from,
                       to,
                       kEdgeReach_s * hz + 0.5);
  }
}

std::vector<FrameRange> within_ball_not_heel(const FootContacts& foot,
                                             const std::vector<char>& heel,
                                             const std::vector<char>& ball) {
  std::vector<char> up = retarget::frame_marks(foot.heel_up, heel.size());
  for (std::size_t frame = 0; frame < up.size(); ++frame) {
    if (ball[frame] == 0 || heel[frame] != 0) up[frame] = 0;
  }
  return retarget::runs_with(up);
}

}  // namespace

void apply_contact_edits(EditState& state, std::span<const ContactEdit> edits) {
  if (edits.empty()) return;
  const std::size_t count = state.motion.poses.size();
  for (std::size_t side = 0; side < 2; ++side) {
    FootContacts& foot = state.contacts.feet[side];
    std::vector<char> heel = retarget::frame_marks(foot.heel, count);
    std::vector<char> ball = retarget::frame_marks(foot.ball, count);
    const bool never_stood = foot.stance.empty();
    bool changed = false;
    for (const ContactEdit& edit : edits) {
      if (edit.side != static_cast<int>(side)) continue;
      apply(state, edit, edit.part == FootPart::kHeel ? heel : ball);
      changed = true;
    }
    if (!changed) continue;
    foot.heel_up = within_ball_not_heel(foot, heel, ball);
    foot.heel = retarget::runs_with(heel);
    foot.ball = retarget::runs_with(ball);
    for (std::size_t frame = 0; frame < count; ++frame) {
      heel[frame] = static_cast<char>(heel[frame] | ball[frame]);
    }
    foot.stance = retarget::runs_with(heel);
    if (never_stood) {
      const FootContacts& other = state.contacts.feet[1 - side];
      const retarget::FootMap& shape = state.map.feet[side];
      const double floor_m =
          other.stance.empty()
              ? 0.0
              : other.ankle_height_m - state.map.feet[1 - side].ankle_height_m;
      foot.ankle_height_m = floor_m + shape.ankle_height_m;
      foot.ball_height_m = floor_m + shape.ball_height_m;
    }
  }
}

void detect_contacts_again(EditState& state) {
  state.contacts = retarget::detect_contacts(state.motion, state.map);
  apply_contact_edits(state, state.contact_edits);
}

}  // namespace marey::edit
