// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/choose_splice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "edit/state/resolve_moment.h"

#include "core/base/format_text.h"
#include "core/base/in_quotes.h"

namespace marey::edit {
namespace {

// Longest part of a motion that is searched. [s]
constexpr double kMaxWindow_s = 4.0;
constexpr int kMaxCandidates = 6;

int nearest_frame(double frame, const EditState& state) {
  return std::clamp(static_cast<int>(std::lround(frame)), 0, state.frame_count() - 1);
}

// Frames of half an overlap, if both sides of the frame have room for it.
int splice_margin(double overlap_s, const EditState& state) {
  const int half = static_cast<int>(std::ceil(0.5 * overlap_s * state.motion.rate.hz));
  return state.frame_count() - 1 >= 2 * half ? half : 0;
}

FrameRange default_leave(double overlap_s, const EditState& state) {
  const int margin = splice_margin(overlap_s, state);
  const int last = state.frame_count() - 1 - margin;
  const int longest = static_cast<int>(kMaxWindow_s * state.motion.rate.hz);
  const int middle = std::max((state.frame_count() - 1) / 2, margin);
  return {std::clamp(last - longest, std::min(middle, last), last), last};
}

FrameRange default_enter(double overlap_s, const EditState& state) {
  const int first = splice_margin(overlap_s, state);
  const int last = state.frame_count() - 1 - first;
  const int longest = static_cast<int>(kMaxWindow_s * state.motion.rate.hz);
  const int middle = std::clamp((state.frame_count() - 1) / 2, first, last);
  return {first, std::min(first + longest, middle)};
}

Result<FrameRange> leave_window(const SpliceOp& op,
                                const EditOp& common,
                                const EditState& first,
                                double overlap_s) {
  if (op.at) {
    if (!common.span.is_whole()) {
      return bad_input(
          "the span", "has no meaning for splice together with at", "remove one of them");
    }
    const auto frame = resolve_moment(first, *op.at);
    if (!frame) return frame.error();
    const int at = nearest_frame(*frame, first);
    return FrameRange{at, at};
  }
  if (common.span.is_whole()) return default_leave(overlap_s, first);
  const auto span = resolve_span(first, common.span);
  if (!span) return span.error();
  constexpr double kRounding = 1e-9;
  const FrameRange window{static_cast<int>(std::ceil(span->first - kRounding)),
                          static_cast<int>(std::floor(span->last + kRounding))};
  if (window.last < window.first) {
    return bad_input("the span",
                     format_text("from frame %.3f to %.3f contains no frame to leave at",
                                 span->first,
                                 span->last),
                     "widen the span, or give at");
  }
  return window;
}

Result<FrameRange> enter_window(const SpliceOp& op,
                                const EditState& original,
                                const EditState& second,
                                double overlap_s) {
  if (!op.enter_at) return default_enter(overlap_s, second);
  const auto frame = resolve_moment(original, *op.enter_at);
  if (!frame) {
    Error error = frame.error();
    error.where = "enter_at, source " + in_quotes(op.source);
    return error;
  }
  const int at =
      nearest_frame(*frame * second.motion.rate.hz / original.motion.rate.hz, second);
  return FrameRange{at, at};
}

}  // namespace

Result<std::vector<SpliceCandidate>> choose_splice(const SpliceOp& op,
                                                   const EditOp& common,
                                                   const EditState& first,
                                                   const EditState& original,
                                                   const EditState& second,
                                                   double overlap_s) {
  const auto leave = leave_window(op, common, first, overlap_s);
  if (!leave) return leave.error();
  const auto enter = enter_window(op, original, second, overlap_s);
  if (!enter) return enter.error();
  FindSpliceOptions options;
  options.align = op.align;
  options.allow_opposed = op.at.has_value() && op.enter_at.has_value();
  options.max_candidates = kMaxCandidates;
  auto candidates = find_splices(first, second, {*leave, *enter}, options);
  if (candidates.empty()) {
    return bad_input(
        "splice",
        format_text("frames %d to %d of the motion and %d to %d of the source stand on "
                    "opposite feet everywhere",
                    leave->first,
                    leave->last,
                    enter->first,
                    enter->last),
        "widen the span, or give both at and enter_at");
  }
  return candidates;
}

}  // namespace marey::edit
