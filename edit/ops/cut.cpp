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
  const double nearest = std::round(span.first);
  const double first =
      std::abs(span.first - nearest) <= kCutOnFrame ? nearest : span.first;
  std::vector<double> at_frame;
  for (double at = first; at <= span.last + kCutOnFrame; at += 1.0) {
    if (at > state.frame_count() - 1) break;
    at_frame.push_back(at);
  }
  if (at_frame.empty()) at_frame.push_back(first);
  EditState out = resample_state(state, at_frame, state.motion.rate.hz);
  if (at_frame.size() == state.motion.poses.size() && first == 0.0) {
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

}  // namespace

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
  if (op.spans.empty()) {
    return bad_input("spans", "is empty", "state at least one span, or use cut");
  }
  std::vector<EditState> out;
  for (const EditSpan& wanted : op.spans) {
    const auto span = resolve_span(state, wanted);
    if (!span) return span.error();
    out.push_back(touched_part(state, *span, context, report));
  }
  return out;
}

Result<std::vector<EditState>> apply_split(const SplitOp& op,
                                           const OpContext& context,
                                           const EditState& state,
                                           OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  if (op.at.empty()) {
    return bad_input("at", "is empty", "state at least one instant to divide at");
  }
  std::vector<int> firsts{0};
  for (const Moment& moment : op.at) {
    const auto frame = resolve_moment(state, moment);
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
  std::vector<EditState> out;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    const int last = i + 1 < firsts.size() ? firsts[i + 1] - 1 : state.frame_count() - 1;
    out.push_back(
        touched_part(state,
                     {static_cast<double>(firsts[i]), static_cast<double>(last)},
                     context,
                     report));
  }
  return out;
}

}  // namespace marey::edit
