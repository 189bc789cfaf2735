// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/offset.h"

#include "edit/state/check_op_keys.h"
#include "edit/state/displace_bone.h"
#include "edit/state/op_weights.h"

namespace marey::edit {

Result<EditState> apply_offset(const OffsetOp& op,
                               const OpContext& context,
                               const EditState& state,
                               OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true, .blend = true}); !ok) {
    return ok.error();
  }
  const auto weights = op_weights(state, context.op);
  if (!weights) return weights.error();
  if (weights->frames.last < weights->frames.first) {
    return bad_input("span", "contains no frame", "make it longer");
  }
  EditState out = state;
  const Status ok =
      displace_bone({op.bone, op.rotation, op.moved_m}, *weights, out, report);
  if (!ok) return ok.error();
  return out;
}

}  // namespace marey::edit
