// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "core/edit/edit_recipe.h"
#include "recordings/edit/edit_limits.h"

namespace marey::recordings::recipe {

// The keys of every operation, once for reading, writing and listing them. A visitor
// receives each key with the member that it sets; "needed" keys have no default, others
// are left out when they have the default of core/edit/edit_ops.h.

template <class T>
struct KeysOf {};

inline constexpr std::array<std::string_view, 2> kFilterMethods{"gcv", "butterworth"};
inline constexpr std::array<std::string_view, 3> kCutoffRules{"given", "yu", "winter"};
inline constexpr std::array<std::string_view, 3> kCycleDrifts{"straight", "keep", "none"};
inline constexpr std::array<std::string_view, 2> kDetected{"supports", "touches"};
inline constexpr std::array<std::string_view, 2> kPushLaws{"force", "thesis"};
inline constexpr std::array<std::string_view, 2> kBalances{"horizontal", "zmp"};
inline constexpr std::array<std::string_view, 4> kContactEdits{
    "set", "clear", "move_start", "move_end"};
inline constexpr std::array<std::string_view, 2> kFeet{"left", "right"};
inline constexpr std::array<std::string_view, 2> kFootParts{"heel", "ball"};

template <class V>
void visit_keys(V& keys, KeysOf<EditSpan> /*of*/) {
  keys.moment("from", &EditSpan::from);
  keys.moment("to", &EditSpan::to);
}

template <class V>
void visit_keys(V& keys, KeysOf<EditLimits> /*of*/) {
  keys.number("slide_mm", &EditLimits::slide_mm, kFigure);
  keys.number("displaced_mm", &EditLimits::displaced_mm, kFigure);
  keys.number("constraint_mm", &EditLimits::constraint_mm, kFigure);
  keys.number("acceleration_ratio", &EditLimits::acceleration_ratio, kFigure);
}

template <class V>
void visit_keys(V& /*keys*/, KeysOf<CutOp> /*of*/) {}

template <class V>
void visit_keys(V& keys, KeysOf<KeepOp> /*of*/) {
  keys.list("spans", &KeepOp::spans);
}

template <class V>
void visit_keys(V& keys, KeysOf<SplitOp> /*of*/) {
  keys.moments("instants", &SplitOp::at);
}

template <class V>
void visit_keys(V& keys, KeysOf<SpliceOp> /*of*/) {
  keys.needed_text("source", &SpliceOp::source, kMaxNameBytes);
  keys.moment("at", &SpliceOp::at);
  keys.moment("enter_at", &SpliceOp::enter_at);
  keys.number("overlap_s", &SpliceOp::overlap_s, kFade);
  keys.boolean("align", &SpliceOp::align);
}

template <class V>
void visit_keys(V& keys, KeysOf<FilterOp> /*of*/) {
  keys.choice("method", &FilterOp::method, kFilterMethods);
  keys.integer("order", &FilterOp::order, kOrder);
  keys.choice("cutoff", &FilterOp::cutoff, kCutoffRules);
  keys.number("cutoff_hz", &FilterOp::cutoff_hz, kFrequency);
  keys.boolean("keep_contacts", &FilterOp::keep_contacts);
}

template <class V>
void visit_keys(V& keys, KeysOf<LevelOp> /*of*/) {
  keys.boolean("tilt", &LevelOp::tilt);
  keys.number("floor_height_m", &LevelOp::floor_height_m, kPlace);
}

template <class V>
void visit_keys(V& keys, KeysOf<PlaceOp> /*of*/) {
  keys.place("position_xz_m", &PlaceOp::position_xz_m);
  keys.degrees("heading_deg", &PlaceOp::heading_rad, kTurn);
  keys.moment("at", &PlaceOp::at);
}

template <class V>
void visit_keys(V& keys, KeysOf<PathOp> /*of*/) {
  keys.places("points_xz_m", &PathOp::points_xz_m);
  keys.degrees("turn_deg", &PathOp::turn_rad, kTurn);
  keys.number("length", &PathOp::length, kFactor);
  keys.boolean("straight", &PathOp::straight);
}

template <class V>
void visit_keys(V& /*keys*/, KeysOf<MirrorOp> /*of*/) {}

template <class V>
void visit_keys(V& keys, KeysOf<RetimeKnot> /*of*/) {
  keys.needed_moment("at", &RetimeKnot::at);
  keys.needed_number("time_s", &RetimeKnot::time_s, kTime);
}

template <class V>
void visit_keys(V& keys, KeysOf<RetimeOp> /*of*/) {
  keys.list("knots", &RetimeOp::knots);
  keys.number("speed", &RetimeOp::speed, kSpeed);
  keys.number("duration_s", &RetimeOp::duration_s, kDuration);
  keys.number("rate_hz", &RetimeOp::rate_hz, kRate);
}

template <class V>
void visit_keys(V& keys, KeysOf<CyclifyOp> /*of*/) {
  keys.number("min_period_s", &CyclifyOp::min_period_s, kDuration);
  keys.number("max_period_s", &CyclifyOp::max_period_s, kDuration);
  keys.moment("cycle_from", &CyclifyOp::from);
  keys.moment("cycle_to", &CyclifyOp::to);
  keys.choice("drift", &CyclifyOp::drift, kCycleDrifts);
  keys.integer("cycles", &CyclifyOp::cycles, kCycles);
  keys.boolean("force", &CyclifyOp::force);
}

template <class V>
void visit_keys(V& /*keys*/, KeysOf<PlantOp> /*of*/) {}

template <class V>
void visit_keys(V& keys, KeysOf<ContactEdit> /*of*/) {
  keys.needed_choice("do", &ContactEdit::kind, kContactEdits);
  keys.needed_choice("foot", &ContactEdit::side, kFeet);
  keys.needed_choice("part", &ContactEdit::part, kFootParts);
  keys.needed_number("from_s", &ContactEdit::from_s, kTime);
  keys.needed_number("to_s", &ContactEdit::to_s, kTime);
}

template <class V>
void visit_keys(V& keys, KeysOf<ContactsOp> /*of*/) {
  keys.boolean("detect", &ContactsOp::detect);
  keys.list("edits", &ContactsOp::edits);
}

template <class V>
void visit_keys(V& keys, KeysOf<EditObject> /*of*/) {
  keys.needed_text("name", &EditObject::name, kMaxNameBytes);
  keys.needed_place("min_m", &EditObject::min_in_world);
  keys.needed_place("max_m", &EditObject::max_in_world);
}

template <class V>
void visit_keys(V& keys, KeysOf<ConstraintChange> /*of*/) {
  keys.needed_text("name", &ConstraintChange::name, kMaxNameBytes);
  keys.moment("start", &ConstraintChange::start);
  keys.moment("stop", &ConstraintChange::stop);
  keys.number("start_duration_s", &ConstraintChange::start_duration_s, kTime);
  keys.number("stop_duration_s", &ConstraintChange::stop_duration_s, kTime);
  keys.place("position_m", &ConstraintChange::p_in_world);
}

template <class V>
void visit_keys(V& keys, KeysOf<ConstrainOp> /*of*/) {
  keys.choice("detect", &ConstrainOp::detect, kDetected);
  keys.list("objects", &ConstrainOp::objects);
  keys.list("changes", &ConstrainOp::changes);
  keys.boolean("adapt", &ConstrainOp::adapt);
  keys.constraint();
}

template <class V>
void visit_keys(V& keys, KeysOf<PoseOp> /*of*/) {
  keys.needed_moment("at", &PoseOp::at);
  keys.needed_bone("bone", &PoseOp::bone);
  keys.rotation("rotation", &PoseOp::rotation);
  keys.place("moved_m", &PoseOp::moved_m);
  keys.number("width_s", &PoseOp::width_s, kDuration);
}

template <class V>
void visit_keys(V& keys, KeysOf<OffsetOp> /*of*/) {
  keys.needed_bone("bone", &OffsetOp::bone);
  keys.rotation("rotation", &OffsetOp::rotation);
  keys.place("moved_m", &OffsetOp::moved_m);
}

template <class V>
void visit_keys(V& keys, KeysOf<ScaleTimeOp> /*of*/) {
  keys.needed_number("speed", &ScaleTimeOp::speed, kSpeed);
}

template <class V>
void visit_keys(V& keys, KeysOf<ExaggerateOp> /*of*/) {
  keys.number("gain", &ExaggerateOp::gain, kGain);
  keys.number("low_hz", &ExaggerateOp::low_hz, kBand);
  keys.number("high_hz", &ExaggerateOp::high_hz, kBand);
}

template <class V>
void visit_keys(V& keys, KeysOf<EditLowestPoint> /*of*/) {
  keys.needed_number("at", &EditLowestPoint::at, kShareOfPush);
  keys.needed_number("height_m", &EditLowestPoint::height_m, kPlace);
}

template <class V>
void visit_keys(V& keys, KeysOf<JumpOp> /*of*/) {
  keys.integer("jump", &JumpOp::jump, kJumpNumber);
  keys.number("apex_m", &JumpOp::apex_m, kJumpApex);
  keys.number("apex_by_m", &JumpOp::apex_by_m, kJumpRaise);
  keys.number("airtime_s", &JumpOp::airtime_s, kJumpAirtime);
  keys.number("length_m", &JumpOp::length_m, kJumpLength);
  keys.place("land_m", &JumpOp::landing_in_world);
  keys.number("box_m", &JumpOp::box_m, kJumpBox);
  keys.number("push_s", &JumpOp::push_s, kJumpPush);
  keys.moment("push_start", &JumpOp::push_start);
  keys.choice("law", &JumpOp::law, kPushLaws);
  keys.part("lowest", &JumpOp::lowest);
  keys.number("strength_g", &JumpOp::strength_g, kStrength);
  keys.number("gravity_m_s2", &JumpOp::gravity_m_s2, kGravity);
  keys.boolean("ballistic", &JumpOp::ballistic);
  keys.boolean("keep_momentum", &JumpOp::keep_momentum);
}

template <class V>
void visit_keys(V& keys, KeysOf<BalanceOp> /*of*/) {
  keys.choice("mode", &BalanceOp::mode, kBalances);
}

template <class V>
void visit_keys(V& keys, KeysOf<TagOp> /*of*/) {
  keys.needed_text("text", &TagOp::text, kMaxNameBytes);
}

template <class V>
void visit_keys(V& keys, KeysOf<EventOp> /*of*/) {
  keys.needed_text("text", &EventOp::text, kMaxNameBytes);
  keys.needed_moment("at", &EventOp::at);
}

template <class V>
void visit_keys(V& keys, KeysOf<CurveKey> /*of*/) {
  keys.needed_moment("at", &CurveKey::at);
  keys.needed_number("value", &CurveKey::value, kValue);
}

template <class V>
void visit_keys(V& keys, KeysOf<CurveOp> /*of*/) {
  keys.needed_text("name", &CurveOp::name, kMaxNameBytes);
  keys.list("keys", &CurveOp::keys);
}

template <class V>
void visit_keys(V& keys, KeysOf<RetargetOp> /*of*/) {
  keys.needed_text("avatar", &RetargetOp::avatar, kMaxPathBytes);
  keys.boolean("keep_world", &RetargetOp::keep_world);
}

}  // namespace marey::recordings::recipe
