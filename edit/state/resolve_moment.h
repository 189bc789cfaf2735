// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/timeline.h"

#include "core/base/result.h"
#include "core/edit/annotation.h"
#include "core/edit/moment.h"

namespace marey::edit {

/// Returns the events that contacts show, ascending by time: "left.strike" at the first
/// frame of a stance, "left.toe_off" at its last, and the same for "right". A stance at
/// the start or the end of the motion has no event there.
[[nodiscard]] std::vector<Annotation> contact_events(const EditState& state);

/// Selects the start or the end of an annotation with a duration.
enum class AnnotationEnd { kStart, kEnd };

/// Returns the frame of an instant, with its fraction; within the motion.
/// Annotations come before events of the same text.
/// Errors (bad input): a time or frame beyond the motion by more than half a frame; an
/// annotation that does not exist (the nearest text is suggested), or not so often.
[[nodiscard]] Result<double> resolve_moment(const Timeline& timeline,
                                            const Moment& moment,
                                            AnnotationEnd end = AnnotationEnd::kStart);
[[nodiscard]] Result<double> resolve_moment(const EditState& state,
                                            const Moment& moment,
                                            AnnotationEnd end = AnnotationEnd::kStart);

/// A part of a motion in frames with fractions; first <= last.
struct ResolvedSpan {
  double first = 0.0;
  double last = 0.0;
};
/// Returns the frames of a span. Errors: resolve_moment()'s; a span that ends before it
/// starts.
[[nodiscard]] Result<ResolvedSpan> resolve_span(const Timeline& timeline,
                                                const EditSpan& span);
[[nodiscard]] Result<ResolvedSpan> resolve_span(const EditState& state,
                                                const EditSpan& span);

}  // namespace marey::edit
