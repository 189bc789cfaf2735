// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/apply_marker_op.h"

#include <string_view>
#include <utility>
#include <variant>

#include "edit/markers/filter_markers.h"
#include "edit/markers/mirror_markers.h"
#include "edit/markers/place_markers.h"
#include "edit/markers/resample_markers.h"
#include "edit/ops/annotate.h"
#include "edit/ops/cut.h"
#include "edit/ops/retime.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/op_error.h"
#include "edit/state/resolve_moment.h"

namespace marey::edit {
namespace {

using MarkerStates = Result<std::vector<MarkerState>>;

MarkerStates one_state(Result<MarkerState> made) {
  if (!made) return made.error();
  std::vector<MarkerState> out;
  out.push_back(std::move(*made));
  return out;
}

/// Calls the function of each operation.
struct MarkerOpApplier {
  const MarkerOpContext& context;
  const MarkerState& state;
  OpReport& report;

  MarkerStates operator()(const CutOp& /*op*/) const {
    const Status usable = check_op_keys(context.op, {.span = true});
    if (!usable) return usable.error();
    const auto span = resolve_span(timeline_of(state), context.op.span);
    if (!span) return span.error();
    return parts_of({*span});
  }
  MarkerStates operator()(const KeepOp& op) const {
    if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
    const auto spans = spans_of_keep(op, timeline_of(state));
    if (!spans) return spans.error();
    return parts_of(*spans);
  }
  MarkerStates operator()(const SplitOp& op) const {
    if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
    const auto spans = spans_of_split(op, timeline_of(state));
    if (!spans) return spans.error();
    return parts_of(*spans);
  }
  MarkerStates operator()(const FilterOp& op) const {
    return one_state(filter_markers(op, context, state, report));
  }
  MarkerStates operator()(const PlaceOp& op) const {
    return one_state(place_markers(op, context, state, report));
  }
  MarkerStates operator()(const MirrorOp& op) const {
    return one_state(mirror_markers(op, context, state, report));
  }
  MarkerStates operator()(const RetimeOp& op) const {
    if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
    const auto frames = retimed_frames(op, timeline_of(state));
    if (!frames) return frames.error();
    MarkerState out = resample_markers(state, frames->at_frame, frames->rate_hz);
    touch(out.lineage, {0, out.frame_count() - 1}, context.index);
    report.figures.emplace_back("duration_s", out.duration_s());
    return one_state(std::move(out));
  }
  MarkerStates operator()(const ScaleTimeOp& op) const {
    RetimeOp retime;
    retime.speed = op.speed;
    return (*this)(retime);
  }
  MarkerStates operator()(const TagOp& op) const { return annotated(op, add_tag); }
  MarkerStates operator()(const EventOp& op) const { return annotated(op, add_event); }
  MarkerStates operator()(const CurveOp& op) const { return annotated(op, add_curve); }
  MarkerStates operator()(const SpliceOp& /*op*/) const {
    return refused("it joins postures by the supports of the feet");
  }
  MarkerStates operator()(const LevelOp& /*op*/) const {
    return refused("it finds the floor under the soles of standing feet");
  }
  MarkerStates operator()(const PathOp& /*op*/) const {
    return refused("it moves the footprints of a body");
  }
  MarkerStates operator()(const CyclifyOp& /*op*/) const {
    return refused("it closes a cycle of postures and footprints");
  }
  MarkerStates operator()(const PlantOp& /*op*/) const {
    return refused("it makes feet stand still");
  }
  MarkerStates operator()(const ContactsOp& /*op*/) const {
    return refused("it detects the contacts of feet");
  }
  MarkerStates operator()(const ConstrainOp& /*op*/) const {
    return refused("it constrains the segments of a body");
  }
  MarkerStates operator()(const PoseOp& /*op*/) const {
    return refused("it sets a part of a body");
  }
  MarkerStates operator()(const OffsetOp& /*op*/) const {
    return refused("it displaces a bone");
  }
  MarkerStates operator()(const ExaggerateOp& /*op*/) const {
    return refused("it amplifies the rotations of joints");
  }
  MarkerStates operator()(const JumpOp& /*op*/) const {
    return refused("it moves the centre of mass of a body");
  }
  MarkerStates operator()(const BalanceOp& /*op*/) const {
    return refused("it moves the centre of mass of a body");
  }
  MarkerStates operator()(const RetargetOp& /*op*/) const {
    return refused("it puts the motion of a body on another one");
  }

 private:
  [[nodiscard]] MarkerStates refused(std::string_view reason) const {
    return bad_input(std::string(name(context.op.parameters)),
                     "cannot be applied to labelled markers: " + std::string(reason),
                     "solve the markers first (marey fit), and use the operation on the "
                     "motion.npz that it writes");
  }

  [[nodiscard]] MarkerStates parts_of(const std::vector<ResolvedSpan>& spans) const {
    std::vector<MarkerState> out;
    for (const ResolvedSpan& span : spans) {
      out.push_back(resample_markers(
          state, frames_of_part(span, state.frame_count()), state.tracks.rate.hz));
      touch(out.back().lineage, {0, out.back().frame_count() - 1}, context.index);
      report.figures.emplace_back("frames", out.back().frame_count());
    }
    return out;
  }

  template <class Op, class Add>
  [[nodiscard]] MarkerStates annotated(const Op& op, const Add& add) const {
    MarkerState out = state;
    const Status ok = add(op, context.op, timeline_of(state), out.annotations);
    if (!ok) return ok.error();
    return one_state(std::move(out));
  }
};

}  // namespace

Result<std::vector<MarkerState>> apply_marker_op(const MarkerOpContext& context,
                                                 const MarkerState& state,
                                                 OpReport& report) {
  report.index = context.index;
  report.name = versioned_name(context.op);
  if (const Status ok = check_version(context.op); !ok) return ok.error();
  auto made = std::visit(MarkerOpApplier{context, state, report}, context.op.parameters);
  if (made) return made;
  return in_operation(made.error(), context.op);
}

}  // namespace marey::edit
