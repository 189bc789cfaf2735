// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/frame_range.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

using FrameMarks = std::vector<char>;

constexpr double kMinContact_s = 0.06;
constexpr double kMaxGap_s = 0.05;
// Time in which a heel is lowered before the join, or raised after it. [s]
constexpr double kRoll_s = 0.15;

// Marks of both motions on the frames of the joined one.
struct BothMarks {
  FrameMarks first;   // 0 where the first motion has no frame.
  FrameMarks second;  // 0 where the second motion has no frame.
};

BothMarks both_marks(const std::vector<FrameRange>& first,
                     const Contacts& a,
                     const std::vector<FrameRange>& second,
                     const Contacts& b,
                     const JoinedFrames& frames) {
  const auto count = static_cast<std::size_t>(frames.start + b.frame_count);
  BothMarks out;
  out.first = retarget::frame_marks(first, static_cast<std::size_t>(a.frame_count));
  out.first.resize(count, 0);
  const FrameMarks tail =
      retarget::frame_marks(second, static_cast<std::size_t>(b.frame_count));
  out.second.assign(static_cast<std::size_t>(frames.start), 0);
  out.second.insert(out.second.end(), tail.begin(), tail.end());
  return out;
}

FrameMarks joined_marks(const BothMarks& both, const JoinedFrames& frames) {
  FrameMarks out = both.second;
  std::copy(both.first.begin(), both.first.begin() + frames.join + 1, out.begin());
  return out;
}

// Closes a gap that the join made, if it is short.
void close_gap(const JoinedFrames& frames, FrameMarks& marks) {
  for (const FrameRange& run : retarget::runs_with(marks, 0)) {
    const bool touches_join = run.first <= frames.join + 1 && run.last >= frames.join;
    const bool is_within =
        run.first > frames.overlap_first() && run.last < frames.overlap_last();
    if (!touches_join || !is_within) continue;
    if ((run.last - run.first + 1) / frames.hz >= kMaxGap_s) continue;
    std::fill(marks.begin() + run.first, marks.begin() + run.last + 1, char{1});
  }
}

// Gives a contact that the join cut short its minimum length, as far as its own motion
// has it; drops it otherwise.
void mend_short(const BothMarks& both, const JoinedFrames& frames, FrameMarks& marks) {
  const int least = static_cast<int>(std::ceil(kMinContact_s * frames.hz));
  const int start = frames.overlap_first();
  const int end = frames.overlap_last();
  for (const FrameRange& run : retarget::runs_with(marks, 1)) {
    const bool is_first = run.last == frames.join;
    const bool is_second = run.first == frames.join + 1;
    if ((!is_first && !is_second) || run.last - run.first + 1 >= least) continue;
    if (run.first <= start || run.last >= end) continue;
    const FrameMarks& own = is_first ? both.first : both.second;
    const int step = is_first ? 1 : -1;
    int edge = is_first ? run.last : run.first;
    int count = run.last - run.first + 1;
    while (count < least && edge + step > start && edge + step < end &&
           own[static_cast<std::size_t>(edge + step)] != 0) {
      edge += step;
      ++count;
    }
    const int from = std::min(edge, run.first);
    const int to = std::max(edge, run.last);
    const char value = count >= least ? char{1} : char{0};
    std::fill(marks.begin() + from, marks.begin() + to + 1, value);
  }
}

// Frames in which a raised heel does not move. Near the join it moves, unless it is up in
// both motions: otherwise it would go from one height to another one within a frame.
FrameMarks joined_heels_up(const BothMarks& both, const JoinedFrames& frames) {
  FrameMarks out = joined_marks(both, frames);
  const int roll = static_cast<int>(std::lround(kRoll_s * frames.hz));
  const int last = static_cast<int>(out.size()) - 1;
  const int from = std::max(0, std::min(frames.overlap_first(), frames.join - roll));
  const int to = std::min(last, std::max(frames.overlap_last(), frames.join + roll));
  const auto is_up = [&](const FrameMarks& marks, int frame) {
    return marks[static_cast<std::size_t>(std::clamp(frame, 0, last))] != 0;
  };
  if (is_up(both.first, frames.join) && is_up(both.second, frames.join + 1)) return out;
  std::fill(out.begin() + from, out.begin() + to + 1, char{0});
  return out;
}

FootContacts join_foot(const FootContacts& first,
                       const Contacts& a,
                       const FootContacts& second,
                       const Contacts& b,
                       const JoinedFrames& frames) {
  const auto both_of = [&](std::vector<FrameRange> FootContacts::*runs) {
    return both_marks(first.*runs, a, second.*runs, b, frames);
  };
  const auto joined = [&](std::vector<FrameRange> FootContacts::*runs) {
    const BothMarks both = both_of(runs);
    FrameMarks marks = joined_marks(both, frames);
    close_gap(frames, marks);
    mend_short(both, frames, marks);
    return marks;
  };
  const FrameMarks heel = joined(&FootContacts::heel);
  const FrameMarks ball = joined(&FootContacts::ball);
  FrameMarks heel_up = joined_heels_up(both_of(&FootContacts::heel_up), frames);
  FrameMarks stance = heel;
  for (std::size_t t = 0; t < heel.size(); ++t) {
    stance[t] = static_cast<char>(heel[t] | ball[t]);
    if (ball[t] == 0 || heel[t] != 0) heel_up[t] = 0;
  }
  FootContacts out = first.stance.empty() ? second : first;
  out.heel = retarget::runs_with(heel, 1);
  out.ball = retarget::runs_with(ball, 1);
  out.stance = retarget::runs_with(stance, 1);
  out.heel_up = retarget::runs_with(heel_up, 1);
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
