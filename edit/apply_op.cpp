// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/apply_op.h"

#include <utility>
#include <variant>

#include "edit/jump/apply_jump.h"
#include "edit/ops/annotate.h"
#include "edit/ops/balance.h"
#include "edit/ops/constrain.h"
#include "edit/ops/contacts.h"
#include "edit/ops/cut.h"
#include "edit/ops/cyclify.h"
#include "edit/ops/exaggerate.h"
#include "edit/ops/filter.h"
#include "edit/ops/level.h"
#include "edit/ops/mirror.h"
#include "edit/ops/offset.h"
#include "edit/ops/path.h"
#include "edit/ops/place.h"
#include "edit/ops/plant.h"
#include "edit/ops/pose.h"
#include "edit/ops/retarget_op.h"
#include "edit/ops/retime.h"
#include "edit/ops/splice.h"
#include "edit/state/op_error.h"

namespace marey::edit {
namespace {

using States = Result<std::vector<EditState>>;

States one(Result<EditState> made) {
  if (!made) return made.error();
  std::vector<EditState> out;
  out.push_back(std::move(*made));
  return out;
}

/// Calls the function of each operation.
struct OpApplier {
  const OpContext& context;
  const EditState& state;
  OpReport& report;
  EditState* own = nullptr;  ///< `state`, if it may be used up.

  [[nodiscard]] EditState taken() const {
    if (own == nullptr) return state;
    return std::move(*own);
  }

  States operator()(const CutOp& op) const {
    return one(apply_cut(op, context, state, report));
  }
  States operator()(const KeepOp& op) const {
    return apply_keep(op, context, state, report);
  }
  States operator()(const SplitOp& op) const {
    return apply_split(op, context, state, report);
  }
  States operator()(const SpliceOp& op) const {
    return one(apply_splice(op, context, state, report));
  }
  States operator()(const FilterOp& op) const {
    return one(apply_filter(op, context, state, report));
  }
  States operator()(const LevelOp& op) const {
    return one(apply_level(op, context, state, report));
  }
  States operator()(const PlaceOp& op) const {
    return one(apply_place(op, context, state, report));
  }
  States operator()(const PathOp& op) const {
    return one(apply_path(op, context, state, report));
  }
  States operator()(const MirrorOp& op) const {
    return one(apply_mirror(op, context, state, report));
  }
  States operator()(const RetimeOp& op) const {
    return one(apply_retime(op, context, state, report));
  }
  States operator()(const ScaleTimeOp& op) const {
    RetimeOp retime;
    retime.speed = op.speed;
    return one(apply_retime(retime, context, state, report));
  }
  States operator()(const CyclifyOp& op) const {
    return one(apply_cyclify(op, context, state, report));
  }
  States operator()(const PlantOp& op) const {
    return one(apply_plant(op, context, state, report));
  }
  States operator()(const ContactsOp& op) const {
    return one(apply_contacts(op, context, state, report));
  }
  States operator()(const ConstrainOp& op) const {
    return one(apply_constrain(op, context, state, report));
  }
  States operator()(const PoseOp& op) const {
    return one(apply_pose(op, context, state, report));
  }
  States operator()(const OffsetOp& op) const {
    return one(apply_offset(op, context, state, report));
  }
  States operator()(const ExaggerateOp& op) const {
    return one(apply_exaggerate(op, context, state, report));
  }
  States operator()(const JumpOp& op) const {
    return one(apply_jump(op, context, state, report));
  }
  States operator()(const BalanceOp& op) const {
    return one(apply_balance(op, context, state, report));
  }
  States operator()(const TagOp& op) const {
    return one(apply_tag(op, context, taken(), report));
  }
  States operator()(const EventOp& op) const {
    return one(apply_event(op, context, taken(), report));
  }
  States operator()(const CurveOp& op) const {
    return one(apply_curve(op, context, taken(), report));
  }
  States operator()(const RetargetOp& op) const {
    return one(apply_retarget(op, context, state, report));
  }
};

States apply_as(const OpContext& context,
                const EditState& state,
                EditState* own,
                OpReport& report) {
  report.index = context.index;
  report.name = versioned_name(context.op);
  if (const Status ok = check_version(context.op); !ok) return ok.error();
  auto made = std::visit(OpApplier{context, state, report, own}, context.op.parameters);
  if (made) return made;
  return in_operation(made.error(), context.op);
}

}  // namespace

Result<std::vector<EditState>> apply_op(const OpContext& context,
                                        const EditState& state,
                                        OpReport& report) {
  return apply_as(context, state, nullptr, report);
}

Result<std::vector<EditState>> apply_op(const OpContext& context,
                                        EditState&& state,
                                        OpReport& report) {
  EditState own = std::move(state);
  return apply_as(context, own, &own, report);
}

}  // namespace marey::edit
