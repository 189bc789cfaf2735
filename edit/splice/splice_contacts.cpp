// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_contacts.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/frame_range.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

using retarget::Contacts;
using retarget::FootContacts;
using FrameMarks = std::vector<char>;

constexpr double kMinContact_s = 0.06;
constexpr double kMaxGap_s = 0.05;

std::vector<FrameRange> runs_with(const FrameMarks& marks, char value) {
  std::vector<FrameRange> out;
  for (std::size_t t = 0; t < marks.size(); ++t) {
    if (marks[t] != value) continue;
    const int frame = static_cast<int>(t);
    if (!out.empty() && out.back().last == frame - 1) {
      out.back().last = frame;
    } else {
      out.push_back({frame, frame});
    }
  }
  return out;
}

FrameMarks joined_marks(const std::vector<FrameRange>& first,
                        const Contacts& a,
                        const std::vector<FrameRange>& second,
                        const Contacts& b,
                        const JoinedFrames& frames) {
  FrameMarks out = retarget::frame_marks(first, static_cast<std::size_t>(a.frame_count));
  const FrameMarks tail =
      retarget::frame_marks(second, static_cast<std::size_t>(b.frame_count));
  out.resize(static_cast<std::size_t>(frames.join) + 1);
  out.insert(out.end(), tail.begin() + frames.join - frames.start + 1, tail.end());
  return out;
}

// Gives runs that the join touches and that are shorter than this the other value.
void remove_short(const JoinedFrames& frames,
                  char value,
                  double max_s,
                  FrameMarks& marks) {
  for (const FrameRange& run : runs_with(marks, value)) {
    const bool touches_join = run.first <= frames.join + 1 && run.last >= frames.join;
    const bool is_within =
        run.first > frames.start && run.last < frames.start + frames.length;
    if (!touches_join || !is_within) continue;
    if ((run.last - run.first + 1) / frames.hz >= max_s) continue;
    std::fill(marks.begin() + run.first,
              marks.begin() + run.last + 1,
              static_cast<char>(1 - value));
  }
}

FootContacts join_foot(const FootContacts& first,
                       const Contacts& a,
                       const FootContacts& second,
                       const Contacts& b,
                       const JoinedFrames& frames) {
  const auto joined = [&](std::vector<FrameRange> FootContacts::*runs) {
    return joined_marks(first.*runs, a, second.*runs, b, frames);
  };
  FrameMarks heel = joined(&FootContacts::heel);
  FrameMarks ball = joined(&FootContacts::ball);
  FrameMarks heel_up = joined(&FootContacts::heel_up);
  for (FrameMarks* marks : {&heel, &ball}) {
    remove_short(frames, 0, kMaxGap_s, *marks);
    remove_short(frames, 1, kMinContact_s, *marks);
  }
  FrameMarks stance = heel;
  for (std::size_t t = 0; t < heel.size(); ++t) {
    stance[t] = static_cast<char>(heel[t] | ball[t]);
    if (ball[t] == 0 || heel[t] != 0) heel_up[t] = 0;
  }
  FootContacts out = first.stance.empty() ? second : first;
  out.heel = runs_with(heel, 1);
  out.ball = runs_with(ball, 1);
  out.stance = runs_with(stance, 1);
  out.heel_up = runs_with(heel_up, 1);
  return out;
}

}  // namespace

Contacts join_contacts(const Contacts& first,
                       const Contacts& second,
                       const JoinedFrames& frames) {
  Contacts out;
  out.frame_count = frames.start + second.frame_count;
  for (std::size_t side = 0; side < 2; ++side) {
    out.feet[side] =
        join_foot(first.feet[side], first, second.feet[side], second, frames);
  }
  return out;
}

}  // namespace marey::edit
