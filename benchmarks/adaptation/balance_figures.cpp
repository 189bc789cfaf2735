// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "benchmarks/adaptation/adaptation_actor.h"
#include "benchmarks/adaptation/adaptation_figures.h"

namespace marey {
namespace {

using B = HumanBone;
using retarget::AdaptOptions;
using retarget::BalanceMode;
using retarget::Method;

/// Groups of the body that move for balance.
enum class Who { kNobody, kGroups, kRoot, kAll };

Character with_balancers(Character actor, Who who) {
  for (BodyGroup& group : actor.groups) {
    const bool is_root = group.level == 1;
    if (who == Who::kGroups && is_root) group.balances = false;
    if (who == Who::kRoot && !is_root) group.balances = false;
  }
  return actor;
}

AdaptOptions options_for(Who who) {
  AdaptOptions options;
  options.balance = who == Who::kNobody ? BalanceMode::kOff : BalanceMode::kHorizontal;
  if (who == Who::kGroups) options.root_for_balance = 0.0;
  return options;
}

struct Reach {
  const char* label;
  Who who;
  Method method = Method::kStrict;
};

PictureScene reach_far(const char* name,
                       double apart_m,
                       const glm::dvec3& target_in_world,
                       const std::vector<Reach>& reaches) {
  PictureScene scene(name, kSide);
  int k = 0;
  for (const Reach& reach : reaches) {
    const Character actor = with_balancers(make_actor(), reach.who);
    const Pose reference = standing(actor);
    const ConstraintSet asked{{contact(B::kRightHand, target_in_world),
                               stance(B::kLeftFoot),
                               stance(B::kRightFoot)},
                              {}};
    const glm::dvec3 place = scene.to_the_right(apart_m * k++);
    AdaptOptions options = options_for(reach.who);
    options.method = reach.method;
    const Adapted out = adapted(reach.label, actor, reference, asked, options);
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_ball(place + target_in_world, kTarget_m, Paint::kOtherTarget);
    show_centre_of_mass(
        scene, place + centre_of_mass(actor, reference), Paint::kWantedCentre);
    show_centre_of_mass(scene, place + out.com_in_world, Paint::kCentreOfMass);
    scene.add_label(reach.label, place + kLabel);
  }
  return scene;
}

}  // namespace

PictureScene draw_balance() {
  return reach_far("balance",
                   1.75,
                   {-0.15, 0.90, 0.78},
                   {{"no balance", Who::kNobody},
                    {"balance, strict", Who::kAll},
                    {"balance, thesis", Who::kAll, Method::kThesis}});
}

PictureScene draw_strategies() {
  return reach_far("strategies",
                   1.8,
                   {-0.15, 0.85, 1.00},
                   {{"no balance", Who::kNobody},
                    {"groups alone", Who::kGroups},
                    {"root alone", Who::kRoot},
                    {"both", Who::kAll}});
}

PictureScene draw_loads() {
  PictureScene scene("loads", kSide);
  int k = 0;
  for (const double load_kg : {0.0, 5.0, 10.0}) {
    CharacterTraits traits;
    for (const char* hand : {"leftHand", "rightHand"}) {
      traits.loads.push_back({hand, {hand, glm::dvec3(0.0)}, load_kg});
    }
    const Character actor = make_actor({}, traits);
    const Pose reference = standing(actor, 30);
    const double slope_m = 0.10;
    const glm::dvec3 left_foot_in_world =
        place_of(actor, reference, B::kLeftFoot) + glm::dvec3(0, slope_m, 0.12);
    const glm::dvec3 right_foot_in_world =
        place_of(actor, reference, B::kRightFoot) - glm::dvec3(0, 0, 0.12);
    const glm::dvec3 right_in_world(-0.22, 1.25, 0.55);
    const glm::dvec3 left_in_world(0.22, 1.25, 0.55);
    const ConstraintSet asked{{contact(B::kRightHand, right_in_world),
                               contact(B::kLeftHand, left_in_world),
                               stance(B::kLeftFoot, left_foot_in_world),
                               stance(B::kRightFoot, right_foot_in_world)},
                              {}};
    const glm::dvec3 place = scene.to_the_right(1.6 * k++);
    AdaptOptions options;
    options.balance = BalanceMode::kHorizontal;
    const std::string label = std::to_string(static_cast<int>(load_kg)) + " kg a hand";
    const Adapted out = adapted(label, actor, reference, asked, options);
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_box(place + glm::dvec3(0.02, 0.0, -0.05),
                  place + glm::dvec3(0.3, slope_m, 0.45),
                  Paint::kGround);
    for (const B hand : {B::kLeftHand, B::kRightHand}) {
      const glm::dvec3 p = place + place_of(actor, out.pose, hand);
      scene.add_ball(p,
                     kTarget_m + 0.008 * load_kg,
                     load_kg > 0 ? Paint::kLoad : Paint::kOtherTarget);
    }
    show_centre_of_mass(
        scene, place + centre_of_mass(actor, reference), Paint::kWantedCentre);
    show_centre_of_mass(scene, place + out.com_in_world, Paint::kCentreOfMass);
    scene.add_label(label, place + kLabel);
  }
  return scene;
}

}  // namespace marey
