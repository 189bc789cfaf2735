// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/splice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/find_splice.h"
#include "edit/find/peak_acceleration.h"
#include "edit/splice/choose_join.h"
#include "edit/splice/choose_splice.h"
#include "edit/splice/join_motions.h"
#include "edit/splice/splice_source.h"
#include "edit/state/check_op_keys.h"

#include "core/base/format_text.h"

namespace marey::edit {
namespace {

// Overlaps of root and legs that are tried if none is given, and decays of displacements
// without an overlap. [s]
constexpr double kMinOverlap_s = 0.3;
constexpr std::array<double, 4> kOverlaps_s{kMinOverlap_s, 0.45, 0.6, 0.9};
// Longer ones of trunk, head and arms. A hand crosses 0.8 m within 0.9 s with 6 m/s^2.
// [s]
constexpr std::array<double, 4> kUpperOverlaps_s{0.45, 0.6, 0.9, 1.2};
// A larger difference of postures is reported. [leg lengths]
constexpr double kFitGap_legs = 0.15;
// A larger peak of a joint's acceleration against both motions' is avoided and reported.
constexpr double kMaxAccelerationRatio = 1.1;
constexpr std::size_t kNamedCandidates = 3;

Status check_splice(const SpliceOp& op, const EditOp& common, const EditState& state) {
  if (state.motion.poses.empty()) {
    return bad_input("motion", "has no frames", "use another motion");
  }
  if (op.overlap_s && (!(*op.overlap_s >= 0.0) || !std::isfinite(*op.overlap_s))) {
    return bad_input("overlap_s",
                     format_text("is %g", *op.overlap_s),
                     "give 0 or a positive number of seconds");
  }
  if (!(common.blend_s >= 0.0) || !std::isfinite(common.blend_s)) {
    return bad_input("blend_s",
                     format_text("is %g", common.blend_s),
                     "give 0 or a positive number of seconds");
  }
  if (common.blend_s > 0.0 && op.overlap_s.value_or(kMinOverlap_s) > 0.0) {
    return bad_input("blend_s",
                     "has no meaning for splice with an overlap",
                     "remove it, or set overlap_s = 0");
  }
  return check_op_keys(common, {.span = true, .blend = true});
}

bool stands(const EditState& state) {
  return !state.contacts.feet[0].stance.empty() || !state.contacts.feet[1].stance.empty();
}

void report_gap(const SpliceOp& op,
                const SpliceCandidate& pair,
                const EditState& first,
                OpReport& report) {
  const double limit_m = kFitGap_legs * first.map.leg_length_m;
  if (pair.match.rms_m <= limit_m) return;
  const char* next = op.at || op.enter_at
                         ? "leave out at and enter_at for the best frames"
                         : "use a motion that begins as this one ends";
  if (!op.align) next = "set align = true, or move the source first";
  report.findings.push_back(
      fair_finding(op.align ? "gap" : "place",
                   "splice",
                   format_text("the postures differ by %.0f mm at the join",
                               1e3 * pair.match.rms_m),
                   next)
          .measured(1e3 * pair.match.rms_m, 1e3 * limit_m, "mm"));
}

void report_supports(const EditState& first,
                     const EditState& second,
                     const SpliceCandidate& pair,
                     OpReport& report) {
  const SupportClass leave = support_class(first.contacts, pair.leave);
  const SupportClass enter = support_class(second.contacts, pair.enter);
  if (supports_oppose(leave, enter)) {
    report.findings.push_back(
        fair_finding("supports",
                     "splice",
                     "the motions stand on opposite feet at the join",
                     "leave out at or enter_at for frames on the same foot"));
  }
  if (leave == SupportClass::kNone && enter == SupportClass::kNone && stands(first) &&
      stands(second)) {
    report.findings.push_back(
        fair_finding("flight",
                     "splice",
                     "no foot bears at the join: the path of the centre of mass in the "
                     "air is a mixture of two jumps",
                     "join where a foot stands, or check the flight in the result"));
  }
}

void report_overlap(const SpliceOverlap& overlap,
                    const JoinPlan& plan,
                    double hz,
                    OpReport& report) {
  report.figures.emplace_back("overlap_s", overlap.body_frames() / hz);
  report.figures.emplace_back("upper_overlap_s", overlap.last() / hz);
  report.figures.emplace_back("aligned_edges", overlap.matched_edges);
  report.figures.emplace_back("warp_ms", 1e3 * overlap.max_warp_s);
  report.figures.emplace_back("opposed_s", overlap.opposed_s);
  if (overlap.body_frames() >= plan.overlap_frames) return;
  report.findings.push_back(
      {Severity::kNote,
       "overlap",
       "splice",
       format_text("the motions have frames for an overlap of %.3f s, not %.3f s",
                   overlap.body_frames() / hz,
                   plan.overlap_frames / hz),
       "choose frames further from the end of the motion and the start of the source"});
}

void name_candidates(const std::vector<SpliceCandidate>& candidates,
                     const SpliceCandidate& chosen,
                     OpReport& report) {
  std::string text;
  std::size_t count = 0;
  for (const SpliceCandidate& pair : candidates) {
    if (pair.leave == chosen.leave && pair.enter == chosen.enter) continue;
    if (count++ == kNamedCandidates) break;
    text += format_text("%s %d, %d, %.0f mm",
                        text.empty() ? "" : ";",
                        pair.leave,
                        pair.enter,
                        1e3 * pair.match.distance_m);
  }
  if (text.empty()) return;
  report.findings.push_back({Severity::kNote,
                             "candidates",
                             "splice",
                             "other pairs that fit (leave, enter, difference):" + text,
                             ""});
}

// Compares the accelerations round the join with those of both motions.
void report_acceleration(const SpliceOp& op,
                         const JoinedMotion& joined,
                         double clips_m_per_s2,
                         OpReport& report) {
  if (!(clips_m_per_s2 > 0.0)) return;
  const auto peak = peak_acceleration(
      joined.state.motion, {joined.changed.first - 1, joined.changed.last + 1});
  const double ratio = peak.m_per_s2 / clips_m_per_s2;
  report.figures.emplace_back("acceleration_ratio", ratio);
  if (ratio <= kMaxAccelerationRatio) return;
  const bool is_free = !op.at && !op.enter_at;
  const char* next = "use a motion that begins as this one ends";
  if (op.overlap_s == 0.0) {
    next = "leave out overlap_s, or give a longer blend_s";
  } else if (op.overlap_s) {
    next = "leave out overlap_s, or give a longer one";
  } else if (!is_free) {
    next = "leave out at and enter_at for the best frames";
  }
  report.findings.push_back(
      fair_finding(
          "acceleration",
          "splice",
          format_text("the %s accelerates %.2f times as much as any joint of both "
                      "motions, in frame %d of the result",
                      std::string(name(peak.bone)).c_str(),
                      ratio,
                      peak.frame),
          next)
          .measured(ratio, kMaxAccelerationRatio, "times"));
}

// Overlaps that may be tried, in seconds; the given one alone.
JoinChoices join_choices(const SpliceOp& op,
                         const EditOp& common,
                         double hz,
                         std::vector<SpliceCandidate> pairs) {
  const auto frames = [&](double time_s) {
    return static_cast<int>(std::lround(time_s * hz));
  };
  JoinChoices out;
  out.pairs = std::move(pairs);
  out.align = op.align;
  if (common.blend_s > 0.0) {
    out.blends = {frames(common.blend_s)};
  } else {
    for (const double time_s : kOverlaps_s) out.blends.push_back(frames(time_s));
  }
  if (op.overlap_s) {
    out.overlaps = {frames(*op.overlap_s)};
    return out;
  }
  for (const double time_s : kOverlaps_s) out.overlaps.push_back(frames(time_s));
  for (const double time_s : kUpperOverlaps_s)
    out.upper_overlaps.push_back(frames(time_s));
  return out;
}

}  // namespace

Result<EditState> apply_splice(const SpliceOp& op,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& report) {
  if (const Status ok = check_splice(op, context.op, state); !ok) return ok.error();
  auto second = fit_splice_source(state, op.source, context.inputs, report);
  if (!second) return second.error();
  const EditState& original = context.inputs.sources.at(op.source);
  auto pairs = choose_splice(
      op, context.op, state, original, *second, op.overlap_s.value_or(kMinOverlap_s));
  if (!pairs) return pairs.error();
  const double hz = state.motion.rate.hz;
  const double clips_m_per_s2 = std::max(peak_acceleration(state.motion).m_per_s2,
                                         peak_acceleration(second->motion).m_per_s2);
  JoinChoices choices = join_choices(op, context.op, hz, *std::move(pairs));
  choices.max_m_per_s2 = kMaxAccelerationRatio * clips_m_per_s2;
  const JoinPlan plan = choose_join(state, *second, choices);
  name_candidates(choices.pairs, plan.pair, report);
  report.figures.emplace_back("leave_frame", plan.pair.leave);
  report.figures.emplace_back("enter_frame", plan.pair.enter);
  report.figures.emplace_back("gap_mm", 1e3 * plan.pair.match.rms_m);
  report.figures.emplace_back("velocity_gap_m_per_s",
                              plan.pair.match.rms_velocity_m_per_s);
  JoinedMotion joined = join_motions(state, *second, plan, context.index);
  report.figures.emplace_back("unchanged", joined.is_seamless ? 1.0 : 0.0);
  if (!joined.is_seamless) {
    report_gap(op, plan.pair, state, report);
    report_supports(state, *second, plan.pair, report);
    report_overlap(joined.overlap, plan, hz, report);
    report_acceleration(op, joined, clips_m_per_s2, report);
  }
  std::move(joined.report.figures.begin(),
            joined.report.figures.end(),
            std::back_inserter(report.figures));
  std::move(joined.report.findings.begin(),
            joined.report.findings.end(),
            std::back_inserter(report.findings));
  return std::move(joined.state);
}

}  // namespace marey::edit
