// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"
#include "edit/state/timeline.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

// Annotations change no pose: the lineage of frames stays. Errors of all: an empty text;
// groups or blend_s are given.

/// Adds a text over the span. Errors: resolve_span()'s.
[[nodiscard]] Result<EditState> apply_tag(const TagOp& op,
                                          const OpContext& context,
                                          EditState state,
                                          OpReport& report);

/// Adds a text at an instant. Errors: resolve_moment()'s; a span is given.
[[nodiscard]] Result<EditState> apply_event(const EventOp& op,
                                            const OpContext& context,
                                            EditState state,
                                            OpReport& report);

/// Adds a number per frame: linear between keys, constant before the first and after the
/// last. A curve of the same name is replaced. Errors: no keys; keys that do not ascend
/// or are not finite; resolve_moment()'s; a span is given.
[[nodiscard]] Result<EditState> apply_curve(const CurveOp& op,
                                            const OpContext& context,
                                            EditState state,
                                            OpReport& report);

/// The same on the annotations alone. `common` has the span and the keys of all
/// operations. After an error the annotations are as before.
[[nodiscard]] Status add_tag(const TagOp& op,
                             const EditOp& common,
                             const Timeline& timeline,
                             Annotations& annotations);
[[nodiscard]] Status add_event(const EventOp& op,
                               const EditOp& common,
                               const Timeline& timeline,
                               Annotations& annotations);
[[nodiscard]] Status add_curve(const CurveOp& op,
                               const EditOp& common,
                               const Timeline& timeline,
                               Annotations& annotations);

}  // namespace marey::edit
