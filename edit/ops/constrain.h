// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Adds a constraint, or detects constraints in the motion, and adapts the motion if
/// `adapt` is set.
///
/// A constraint: `from` and `to` (without them the operation's span) are the interval in
/// which it is fully active; it fades before and after it by its own durations, or if
/// these are 0 by blend_s. Without both its own times hold; all are since the first pose.
/// Its id is new. Exception: the id of a detected constraint ("found leftFoot flat 1")
/// changes that constraint by hand; without a segment only its times. A changed
/// constraint loses the word "found" in its id. It can be changed again under either id
/// with "found".
///
/// Changes by hand name a constraint of the motion, detected or not, and set its times,
/// fades and place. Seconds are those of its activation, so a start is that of its fade;
/// frames and annotations are the ends of the time in which it is fully active. A change
/// of a fade alone keeps that time. A footprint takes along the other supports of its
/// stance. Changed constraints lose the word "found", as above.
///
/// Detection (found_supports(), found_touches()) replaces the constraints of earlier
/// detections of the same kind, not those changed by hand: a new constraint that overlaps
/// a changed one of the same segment and kind in time is left out. With a span, only
/// constraints that are active in it are replaced and added. Edges of contacts changed by
/// hand are kept, because supports come from the state's contacts. A detected constraint
/// that contradicts others is left out, with a finding.
///
/// Adaptation: adapt_state(). Constraints alone change no frame, so only adaptation
/// touches the lineage. Figures: constraints, found (by this detection), changed_by_hand
/// (left out for that reason); adapt_state()'s.
///
/// Errors (bad input): nothing to do; a constraint together with a detection or changes;
/// a change of a constraint that the motion does not have, or of the place of one without
/// a place; groups; objects without detection of touches, without a name, with a
/// duplicate name, not finite, or with min above max; an interval that ends before it
/// starts; a duplicate id; those of resolve_moment(), character_of() and
/// retarget::check_constraints() for all constraints together.
[[nodiscard]] Result<EditState> apply_constrain(const ConstrainOp& op,
                                                const OpContext& context,
                                                const EditState& state,
                                                OpReport& report);

}  // namespace marey::edit
