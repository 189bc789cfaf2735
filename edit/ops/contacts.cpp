// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/contacts.h"

#include <algorithm>
#include <cmath>

#include "edit/state/apply_contact_edits.h"
#include "edit/state/check_op_keys.h"

#include "core/base/format_text.h"

namespace marey::edit {
namespace {

Status check_contact_edit(const ContactEdit& edit, const EditState& state) {
  const double end_s = state.duration_s() + 0.5 / state.motion.rate.hz;
  for (const double time_s : {edit.from_s, edit.to_s}) {
    if (time_s >= -0.5 / state.motion.rate.hz && time_s <= end_s) continue;
    return bad_input("edits",
                     "has the time " + format_text("%.3f", time_s) +
                         " s; the motion lasts " +
                         format_text("%.3f", state.duration_s()) + " s",
                     "choose times within the motion");
  }
  const bool is_range =
      edit.kind == ContactEdit::Kind::kSet || edit.kind == ContactEdit::Kind::kClear;
  if (is_range && edit.to_s < edit.from_s) {
    return bad_input("edits",
                     "has a contact that ends at " + format_text("%.3f", edit.to_s) +
                         " s, before it starts at " + format_text("%.3f", edit.from_s) +
                         " s",
                     "exchange the two times");
  }
  return Done{};
}

}  // namespace

Result<EditState> apply_contacts(const ContactsOp& op,
                                 const OpContext& context,
                                 const EditState& state,
                                 OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  for (const ContactEdit& edit : op.edits) {
    if (const Status ok = check_contact_edit(edit, state); !ok) return ok.error();
  }
  EditState out = state;
  out.contact_edits.insert(out.contact_edits.end(), op.edits.begin(), op.edits.end());
  if (op.detect) {
    detect_contacts_again(out);
  } else {
    apply_contact_edits(out, op.edits);
  }
  report.figures.emplace_back("left_stances",
                              static_cast<double>(out.contacts.feet[0].stance.size()));
  report.figures.emplace_back("right_stances",
                              static_cast<double>(out.contacts.feet[1].stance.size()));
  return out;
}

}  // namespace marey::edit
