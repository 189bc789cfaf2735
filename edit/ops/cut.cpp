// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cut.h"

#include <cmath>
#include <cstddef>

#include "edit/state/check_op_keys.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"

#include "core/base/format_text.h"

namespace marey::edit {
namespace {

/// An instant this near to a frame is the frame's. [frames]
constexpr double kCutOnFrame = 1e-6;

EditState part_of(const EditState& state, const ResolvedSpan& span) {
  const std::vector<double> at_frame = frames_of_part(span, state.frame_count());
  EditState out = resample_state(state, at_frame, state.motion.rate.hz);
  if (at_frame.size() == state.motion.poses.size() && at_frame.front() == 0.0) {
    out.motion.first_frame = state.motion.first_frame;
  }
  return out;
}

EditState touched_part(const EditState& state,
                       const ResolvedSpan& span,
                       const OpContext& context,
                       OpReport& report) {
  EditState out = part_of(state, span);
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  report.figures.emplace_back("frames", out.frame_count());
  return out;
}

std::vector<EditState> touched_parts(const EditState& state,
                                     const std::vector<ResolvedSpan>& spans,
                                     const OpContext& context,
                                     OpReport& report) {
  std::vector<EditState> out;
  for (const ResolvedSpan& span : spans) {
    out.push_back(touched_part(state, span, context, report));
  }
  return out;
}

}  // namespace

std::vector<double> frames_of_part(const ResolvedSpan& span, int frame_count) {
  const double nearest = std::round(span.first);
  const double first =
      std::abs(span.first - nearest) <= kCutOnFrame ? nearest : span.first;
  std::vector<double> at_frame;
  for (double at = first; at <= span.last + kCutOnFrame; at += 1.0) {
    if (at > frame_count - 1) break;
    at_frame.push_back(at);
  }
  if (at_frame.empty()) at_frame.push_back(first);
  return at_frame;
}

Result<std::vector<ResolvedSpan>> spans_of_keep(const KeepOp& op,
                                                const Timeline& timeline) {
  if (op.spans.empty()) {
    return bad_input("spans", "is empty", "state at least one span, or use cut");
  }
  std::vector<ResolvedSpan> out;
  for (const EditSpan& wanted : op.spans) {
    const auto span = resolve_span(timeline, wanted);
    if (!span) return span.error();
    out.push_back(*span);
  }
  return out;
}

Result<std::vector<ResolvedSpan>> spans_of_split(const SplitOp& op,
                                                 const Timeline& timeline) {
  if (op.at.empty()) {
    return bad_input("at", "is empty", "state at least one instant to divide at");
  }
  std::vector<int> firsts{0};
  for (const Moment& moment : op.at) {
    const auto frame = resolve_moment(timeline, moment);
    if (!frame) return frame.error();
    const int first = static_cast<int>(std::ceil(*frame - kCutOnFrame));
    if (first <= firsts.back()) {
      return bad_input("at",
                       "has an instant at frame " + std::to_string(first) +
                           ", which leaves the part from frame " +
                           std::to_string(firsts.back()) + " without a frame",
                       "state instants in ascending order, after the first frame");
    }
    firsts.push_back(first);
  }
  std::vector<ResolvedSpan> out;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    const int last = i + 1 < firsts.size() ? firsts[i + 1] - 1 : timeline.frame_count - 1;
    out.push_back({static_cast<double>(firsts[i]), static_cast<double>(last)});
  }
  return out;
}

Result<EditState> apply_cut(const CutOp& /*op*/,
                            const OpContext& context,
                            const EditState& state,
                            OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true}); !ok) return ok.error();
  const auto span = resolve_span(state, context.op.span);
  if (!span) return span.error();
  return touched_part(state, *span, context, report);
}

Result<std::vector<EditState>> apply_keep(const KeepOp& op,
                                          const OpContext& context,
                                          const EditState& state,
                                          OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  const auto spans = spans_of_keep(op, timeline_of(state));
  if (!spans) return spans.error();
  return touched_parts(state, *spans, context, report);
}

Result<std::vector<EditState>> apply_split(const SplitOp& op,
                                           const OpContext& context,
                                           const EditState& state,
                                           OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  const auto spans = spans_of_split(op, timeline_of(state));
  if (!spans) return spans.error();
  return touched_parts(state, *spans, context, report);
}

}  // namespace marey::edit
