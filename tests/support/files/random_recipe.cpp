// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/random_recipe.h"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace marey::testing {
namespace {

/// Random values of an operation's keys.
class RecipeDice {
 public:
  explicit RecipeDice(std::uint64_t seed) : engine_(seed) {}

  // Distributions of the standard library differ between machines.
  int below(int count) {
    return static_cast<int>(engine_() % static_cast<std::uint64_t>(count));
  }
  bool chance() { return below(2) == 0; }
  /// Half of the numbers have a short decimal form.
  double between(double low, double high) {
    if (chance()) return low + (high - low) * (below(17) / 16.0);
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  std::optional<double> maybe(double low, double high) {
    return chance() ? std::optional(between(low, high)) : std::nullopt;
  }

  std::string word() {
    static constexpr const char* kWords[] = {"left.strike",
                                             "a \"b\" \\c",
                                             "phase:swing é",
                                             "x[3]",
                                             "y[",
                                             "z]",
                                             "[7]a",
                                             "#1 = {2}",
                                             "'"};
    return kWords[below(static_cast<int>(std::size(kWords)))];
  }
  Moment moment() {
    if (chance()) return AtTime{between(0.0, 60.0)};
    if (chance()) return AtFrame{chance() ? below(900) : between(0.0, 900.0)};
    return AtAnnotation{word(), below(3)};
  }
  std::optional<Moment> maybe_moment() {
    return chance() ? std::optional(moment()) : std::nullopt;
  }
  EditSpan span() {
    switch (below(4)) {
      case 0:
        return {};
      case 1:
        return {moment(), std::nullopt};
      case 2:
        return {std::nullopt, moment()};
      default: {
        const double start = between(0.0, 30.0);
        return {AtTime{start}, AtTime{start + between(0.0, 30.0)}};
      }
    }
  }
  /// Returns instants that ascend.
  std::vector<Moment> instants(int max_count) {
    std::vector<Moment> all;
    double time_s = between(0.0, 1.0);
    const bool frames = chance();
    for (int left = 1 + below(max_count); left > 0; --left) {
      time_s += 0.01 + between(0.0, 2.0);
      if (frames) {
        all.emplace_back(AtFrame{time_s});
      } else {
        all.emplace_back(AtTime{time_s});
      }
    }
    return all;
  }
  glm::dvec3 place() {
    return {between(-3.0, 3.0), between(0.0, 2.0), between(-3.0, 3.0)};
  }
  glm::dvec2 floor_place() { return {between(-5.0, 5.0), between(-5.0, 5.0)}; }
  std::optional<glm::dvec3> maybe_place() {
    return chance() ? std::optional(place()) : std::nullopt;
  }
  double angle() { return between(-4.0, 4.0); }
  glm::dquat rotation() {
    const glm::dvec3 v = place() + glm::dvec3(0.1, 0.2, 0.3);
    return glm::normalize(glm::dquat(between(0.0, 1.0), v.x, v.y, v.z));
  }
  HumanBone bone() { return human_bones()[static_cast<std::size_t>(below(22))]; }

 private:
  std::mt19937_64 engine_;
};

void fill(RecipeDice& /*dice*/, CutOp& /*op*/) {}
void fill(RecipeDice& dice, KeepOp& op) {
  for (int left = 1 + dice.below(3); left > 0; --left) op.spans.push_back(dice.span());
}
void fill(RecipeDice& dice, SplitOp& op) {
  op.at = dice.instants(4);
}
void fill(RecipeDice& dice, SpliceOp& op) {
  op.source = dice.chance() ? "s1" : "s2";
  op.at = dice.maybe_moment();
  op.enter_at = dice.maybe_moment();
  if (dice.chance()) op.overlap_s = dice.between(0.0, 1.0);
  op.align = dice.chance();
}
void fill(RecipeDice& dice, FilterOp& op) {
  op.keep_contacts = dice.chance();
  if (dice.chance()) {
    op.order = 2 + dice.below(2);
    return;
  }
  op.method = FilterMethod::kButterworth;
  op.cutoff = static_cast<CutoffRule>(dice.below(3));
  op.cutoff_hz = dice.between(0.5, 30.0);
}
void fill(RecipeDice& dice, LevelOp& op) {
  op.tilt = dice.chance();
  op.floor_height_m = dice.between(-1.0, 1.0);
}
void fill(RecipeDice& dice, PlaceOp& op) {
  if (dice.chance()) op.position_xz_m = dice.floor_place();
  if (!op.position_xz_m || dice.chance()) op.heading_rad = dice.angle();
  op.at = dice.moment();
}
void fill(RecipeDice& dice, PathOp& op) {
  if (dice.chance()) {
    for (int left = 2 + dice.below(3); left > 0; --left) {
      op.points_xz_m.push_back(dice.floor_place());
    }
    return;
  }
  op.turn_rad = dice.angle();
  op.length = dice.between(0.5, 2.0);
  op.straight = dice.chance();
}
void fill(RecipeDice& /*dice*/, MirrorOp& /*op*/) {}
void fill(RecipeDice& dice, RetimeOp& op) {
  if (dice.chance()) {
    double time_s = 0.0;
    for (const Moment& at : dice.instants(4)) {
      op.knots.push_back({at, time_s});
      time_s += 0.1 + dice.between(0.0, 2.0);
    }
  } else if (dice.chance()) {
    op.speed = dice.between(0.1, 10.0);
  } else {
    op.duration_s = dice.between(0.1, 10.0);
  }
  op.rate_hz = dice.maybe(24.0, 240.0);
}
void fill(RecipeDice& dice, CyclifyOp& op) {
  op.min_period_s = dice.maybe(0.3, 1.0);
  op.max_period_s = dice.maybe(1.0, 3.0);
  const std::vector<Moment> ends = dice.instants(2);
  if (dice.chance()) op.from = ends.front();
  if (ends.size() > 1) op.to = ends.back();
  if (dice.below(4) == 0) op.from = AtAnnotation{dice.word(), dice.below(3)};
  if (dice.below(4) == 0) op.to = AtAnnotation{dice.word(), dice.below(3)};
  op.drift = static_cast<CycleDrift>(dice.below(3));
  op.cycles = 1 + dice.below(9);
  op.force = dice.chance();
}
void fill(RecipeDice& /*dice*/, PlantOp& /*op*/) {}
void fill(RecipeDice& dice, ContactsOp& op) {
  for (int left = dice.below(4); left > 0; --left) {
    ContactEdit edit;
    edit.kind = static_cast<ContactEdit::Kind>(dice.below(4));
    edit.side = dice.below(2);
    edit.part = dice.chance() ? FootPart::kHeel : FootPart::kBall;
    edit.from_s = dice.between(0.0, 5.0);
    edit.to_s = edit.from_s + dice.between(0.0, 2.0);
    op.edits.push_back(edit);
  }
  op.detect = op.edits.empty() || dice.chance();
}

Goal random_goal(RecipeDice& dice) {
  const double distance_m = dice.between(0.0, 1.0);
  switch (dice.below(static_cast<int>(std::variant_size_v<Goal>))) {
    case 0:
      return DistanceToPoint{distance_m, dice.place()};
    case 1:
      return DistanceToBody{distance_m, {dice.word(), dice.place()}};
    case 2:
      return DistanceToConstraint{distance_m, dice.word()};
    case 3:
      return AllowedSpace{dice.place(), dice.place()};
    case 4:
      return ForbiddenSpace{dice.place(), dice.place()};
    case 5:
      return SegmentOrientation{dice.rotation()};
    default: {
      Support support{dice.maybe_place(), std::nullopt, dice.chance()};
      if (dice.chance()) support.world_from_t_pose = dice.rotation();
      return support;
    }
  }
}

void fill_constraint(RecipeDice& dice, ConstrainOp& op) {
  Constraint& constraint = op.constraint.emplace();
  constraint.id = dice.word();
  constraint.point = {dice.word(), dice.maybe_place().value_or(glm::dvec3(0.0))};
  constraint.goal = random_goal(dice);
  if (dice.chance()) constraint.range = 1 + dice.below(8);
  constraint.importance = dice.between(0.5, 5.0);
  constraint.precision_m = dice.between(0.0005, 0.01);
  constraint.activation = {std::nullopt,
                           std::nullopt,
                           dice.maybe(0.0, 0.5).value_or(0.0),
                           dice.maybe(0.0, 0.5).value_or(0.0)};
  if (dice.chance()) {
    constraint.activation.start_s = dice.between(0.0, 2.0);
    if (dice.chance()) constraint.activation.stop_s = dice.between(2.0, 4.0);
  } else {
    if (dice.chance()) op.from = AtAnnotation{dice.word(), dice.below(3)};
    op.to = dice.maybe_moment();
  }
}

ConstraintChange random_change(RecipeDice& dice, int number) {
  ConstraintChange out{"found " + dice.word() + " " + std::to_string(number)};
  if (dice.chance()) {
    out.start = AtTime{dice.between(0.0, 2.0)};
    if (dice.chance()) out.stop = AtTime{dice.between(2.0, 4.0)};
  } else {
    out.stop = dice.maybe_moment();
  }
  out.start_duration_s = dice.maybe(0.0, 0.5);
  out.stop_duration_s = dice.maybe(0.0, 0.5);
  out.p_in_world = dice.place();
  return out;
}

void fill(RecipeDice& dice, ConstrainOp& op) {
  op.adapt = dice.chance();
  if (dice.chance()) {
    fill_constraint(dice, op);
    return;
  }
  for (int i = 0; dice.chance() && i < 3; ++i) {
    op.changes.push_back(random_change(dice, i));
  }
  op.detect = dice.chance() ? DetectConstraints::kTouches : DetectConstraints::kSupports;
  if (op.detect != DetectConstraints::kTouches) return;
  for (int i = 0; i <= dice.below(3); ++i) {
    const glm::dvec3 corner = dice.place();
    const glm::dvec3 size(dice.between(0.0, 1.0), 0.7, dice.between(0.0, 1.0));
    op.objects.push_back({"o" + std::to_string(i), corner, corner + size});
  }
}

void fill(RecipeDice& dice, PoseOp& op) {
  op.at = dice.moment();
  op.bone = dice.bone();
  if (dice.chance()) op.rotation = dice.rotation();
  if (!op.rotation || dice.chance()) op.moved_m = dice.place();
  op.width_s = dice.between(0.05, 2.0);
}
void fill(RecipeDice& dice, OffsetOp& op) {
  op.bone = dice.bone();
  if (dice.chance()) op.rotation = dice.rotation();
  if (!op.rotation || dice.chance()) op.moved_m = dice.place();
}
void fill(RecipeDice& dice, ScaleTimeOp& op) {
  op.speed = dice.between(0.1, 10.0);
}
void fill(RecipeDice& dice, ExaggerateOp& op) {
  op.gain = dice.between(-2.0, 3.0);
  op.low_hz = dice.between(0.0, 2.0);
  if (dice.chance()) op.high_hz = op.low_hz + dice.between(0.1, 8.0);
}
void fill(RecipeDice& dice, JumpOp& op) {
  op.jump = 1 + dice.below(4);
  (dice.chance() ? op.apex_m : op.apex_by_m) = dice.maybe(0.1, 2.0);
  op.airtime_s = dice.maybe(0.1, 1.0);
  if (dice.chance()) {
    op.landing_in_world = dice.place();
  } else {
    op.length_m = dice.maybe(0.0, 3.0);
    op.box_m = dice.maybe(-0.5, 0.8);
  }
  op.push_s = dice.maybe(0.1, 1.0);
  op.push_start = dice.maybe_moment();
  op.strength_g = dice.maybe(1.5, 6.0);
  op.gravity_m_s2 = dice.maybe(0.5, 30.0).value_or(op.gravity_m_s2);
  op.ballistic = dice.chance();
  op.keep_momentum = dice.chance();
  op.law = dice.chance() ? EditPushLaw::kThesis : EditPushLaw::kForce;
  if (op.law != EditPushLaw::kThesis || dice.chance()) return;
  op.lowest = EditLowestPoint{dice.between(0.1, 0.9), dice.between(0.3, 1.0)};
}
void fill(RecipeDice& dice, BalanceOp& op) {
  op.mode = dice.chance() ? EditBalance::kZmp : EditBalance::kHorizontal;
}
void fill(RecipeDice& dice, TagOp& op) {
  op.text = dice.word();
}
void fill(RecipeDice& dice, EventOp& op) {
  op.text = dice.word();
  op.at = dice.moment();
}
void fill(RecipeDice& dice, CurveOp& op) {
  op.name = dice.word();
  for (const Moment& at : dice.instants(5)) {
    op.keys.push_back({at, dice.between(-1.0, 1.0)});
  }
}
void fill(RecipeDice& dice, RetargetOp& op) {
  op.avatar = "bodies/" + dice.word() + ".glb";
  op.keep_world = dice.chance();
}

}  // namespace

EditOp random_edit_op(std::uint64_t seed, std::size_t kind) {
  RecipeDice dice(seed);
  const std::vector<std::string_view> names = edit_op_names();
  EditOp op;
  op.parameters = *edit_op(names[kind % names.size()]);
  std::visit([&](auto& parameters) { fill(dice, parameters); }, op.parameters);
  op.off = dice.below(4) == 0;
  op.span = dice.span();
  op.blend_s = dice.maybe(0.0, 1.0).value_or(0.0);
  for (const EditGroup group : kEditGroups) {
    if (dice.below(5) == 0) op.groups.push_back(group);
  }
  if (dice.chance()) op.why = "two lines\nof " + dice.word();
  return op;
}

EditRecipe random_edit_recipe(std::uint64_t seed, std::size_t max_ops) {
  RecipeDice dice(seed);
  EditRecipe recipe;
  if (dice.chance()) recipe.name = "walk é " + std::to_string(dice.below(100));
  const std::string sum = std::string(60, 'a') + "01ef";
  recipe.sources.push_back({"", "out/walk/motion.npz", dice.chance() ? sum : "", 0});
  recipe.sources.push_back({"s1", "../" + dice.word(), dice.chance() ? sum : "", 0});
  recipe.sources.push_back({"s2", "a.bvh", "", 0});
  recipe.limits = {dice.maybe(0.0, 9.0),
                   dice.maybe(0.0, 99.0),
                   dice.maybe(0.0, 9.0),
                   dice.maybe(1.0, 2.0)};
  const int count = dice.below(static_cast<int>(max_ops) + 1);
  for (int k = 0; k < count; ++k) {
    const auto kind = static_cast<std::size_t>(dice.below(1000));
    recipe.ops.push_back(
        random_edit_op(seed * 1000 + static_cast<std::uint64_t>(k), kind));
  }
  return recipe;
}

}  // namespace marey::testing
