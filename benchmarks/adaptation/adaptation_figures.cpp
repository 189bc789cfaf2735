// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/adaptation_figures.h"

#include <array>
#include <numbers>
#include <string>
#include <tuple>

#include "benchmarks/adaptation/adaptation_actor.h"

namespace marey {
namespace {

using B = HumanBone;
using retarget::AdaptOptions;
using retarget::BalanceMode;
using retarget::Control;

constexpr glm::dvec3 kRightwards{1, 0, 0};

AdaptOptions balanced(BalanceMode balance) {
  AdaptOptions options;
  options.balance = balance;
  return options;
}

}  // namespace

PictureScene draw_control() {
  PictureScene scene("control", {-8.0, 8.0});
  const Character actor = make_actor();
  const Pose reference = standing(actor);
  const glm::dvec3 right_in_world(-1.02, 1.42, 0.35);
  const glm::dvec3 left_in_world(1.02, 1.42, 0.35);
  struct Case {
    const char* label;
    Control control;
    double right_importance;
  };
  int k = 0;
  for (const Case& c : {Case{"priority", Control::kPriority, 2.0},
                        Case{"blend 4 : 1", Control::kBlend, 4.0},
                        Case{"blend 1 : 1", Control::kBlend, 1.0}}) {
    const ConstraintSet asked{{contact(B::kRightHand, right_in_world, c.right_importance),
                               contact(B::kLeftHand, left_in_world),
                               stance(B::kLeftFoot),
                               stance(B::kRightFoot)},
                              {}};
    AdaptOptions options;
    options.control = c.control;
    const glm::dvec3 place = scene.to_the_right(2.4 * k++);
    const Adapted out = adapted(c.label, actor, reference, asked, options);
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_ball(place + right_in_world, kTarget_m, Paint::kTarget);
    scene.add_ball(place + left_in_world, kTarget_m, Paint::kOtherTarget);
    scene.add_label(c.label, place + kLabel);
  }
  return scene;
}

PictureScene draw_root_share() {
  PictureScene scene("root-share", kSide);
  const Character actor = make_actor();
  Pose reference = standing(actor, 24);
  turn(reference, actor, B::kRightLowerLeg, 30, kRightwards);
  turn(reference, actor, B::kRightUpperLeg, -75, kRightwards);
  turn(reference, actor, B::kRightFoot, 25, kRightwards);
  turn(reference, actor, B::kSpine, -10, kRightwards);
  for (const auto& [elbow, shoulder, side] :
       {std::tuple{B::kLeftLowerArm, B::kLeftUpperArm, -1.0},
        std::tuple{B::kRightLowerArm, B::kRightUpperArm, 1.0}}) {
    turn(reference, actor, elbow, side * 70, {0, 1, 0});
    turn(reference, actor, shoulder, -20, kRightwards);
  }
  const glm::dvec3 target_in_world =
      place_of(actor, reference, B::kRightFoot) + glm::dvec3(0.05, 0.50, 0.40);
  for (int k = 0; k < 5; ++k) {
    AdaptOptions options;
    // Iterated to the end, every share but none gets there.
    options.root_for_constraints = 0.25 * k;
    options.max_iterations = 2;
    options.method = retarget::Method::kThesis;
    const ConstraintSet asked{
        {contact(B::kRightFoot, target_in_world), stance(B::kLeftFoot)}, {}};
    const std::string label = std::to_string(25 * k) + " %";
    const glm::dvec3 place = scene.to_the_right(1.5 * k);
    const Adapted out = adapted("root " + label, actor, reference, asked, options);
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_ball(place + target_in_world, kTarget_m, Paint::kTarget);
    scene.add_label(label, place + kLabel);
  }
  return scene;
}

PictureScene draw_flexibility() {
  PictureScene scene("flexibility", kSide);
  int k = 0;
  for (const double min_deg : {0.0, 100.0}) {
    CharacterTraits traits;
    traits.flexibility.min_trunk_thigh_angle_rad = min_deg * std::numbers::pi / 180.0;
    const Character actor = make_actor({}, traits);
    const Pose reference = standing(actor, 4);
    const glm::dvec3 right_in_world(-0.15, 0.22, 0.42);
    const glm::dvec3 left_in_world(0.15, 0.22, 0.42);
    const ConstraintSet asked{{contact(B::kRightHand, right_in_world),
                               contact(B::kLeftHand, left_in_world),
                               stance(B::kLeftFoot),
                               stance(B::kRightFoot)},
                              {}};
    const std::string label = min_deg > 0.0 ? "stiff" : "supple";
    const glm::dvec3 place = scene.to_the_right(1.3 * k++);
    const Adapted out =
        adapted(label, actor, reference, asked, balanced(BalanceMode::kHorizontal));
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_ball(place + right_in_world, kTarget_m, Paint::kTarget);
    scene.add_ball(place + left_in_world, kTarget_m, Paint::kTarget);
    scene.add_label(label, place + kLabel);
  }
  return scene;
}

PictureScene draw_crowd() {
  PictureScene scene("crowd", {-28.0, 8.0});
  const std::array<recordings::MannequinOptions, 6> bodies{{
      {.stature_m = 1.25, .leg = 0.9, .head = 1.3},
      {.stature_m = 1.55, .arm = 1.15},
      {.stature_m = 1.75},
      {.stature_m = 1.75, .leg = 0.75, .trunk = 1.2},
      {.stature_m = 1.85, .leg = 1.2, .trunk = 0.85},
      {.stature_m = 2.3, .head = 0.85, .shoulder_width = 1.2},
  }};
  const glm::dvec3 right_in_world(-0.15, 0.80, 0.40);
  const glm::dvec3 left_in_world(0.36, 1.08, 0.30);
  int k = 0;
  for (const auto& body : bodies) {
    const Character actor = make_actor(body);
    const ConstraintSet asked{{contact(B::kRightHand, right_in_world),
                               contact(B::kLeftHand, left_in_world),
                               stance(B::kLeftFoot),
                               stance(B::kRightFoot)},
                              {}};
    const glm::dvec3 place = scene.to_the_right(1.25 * k++);
    const Adapted out = adapted("crowd " + std::to_string(k),
                                actor,
                                standing(actor),
                                asked,
                                balanced(BalanceMode::kHorizontal));
    scene.add_body(actor.skeleton, out.pose, place);
    scene.add_ball(place + right_in_world, kTarget_m, Paint::kTarget);
    scene.add_ball(place + left_in_world, kTarget_m, Paint::kOtherTarget);
  }
  return scene;
}

}  // namespace marey
