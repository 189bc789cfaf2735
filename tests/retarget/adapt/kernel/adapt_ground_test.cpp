// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/kernel/adapt_ground.h"

#include <array>
#include <cmath>

#include "tests/retarget/adapt/kernel/thesis_scene.h"

namespace marey::retarget {
namespace {

constexpr double kFloat_m = 2e-6;  // As in thesis_adapter_test.cpp.

ConstraintSet both_feet(const Character& character,
                        const Pose& pose,
                        const glm::dvec3& left_by,
                        const glm::dvec3& right_by) {
  ConstraintSet set{{support_of("leftFoot"), support_of("rightFoot")}, {}};
  for (std::size_t c = 0; c < 2; ++c) {
    Support support;
    support.footprint_in_world =
        place_in_world(character, pose, c ? "rightFoot" : "leftFoot") +
        (c ? right_by : left_by);
    set.constraints[c].goal = support;
  }
  return set;
}

AdaptOptions by(Method method) {
  AdaptOptions options;
  options.method = method;
  return options;
}

constexpr std::array<Method, 2> kMethods{Method::kStrict, Method::kThesis};

TEST(GroundReference, KeepsTheReferenceOnFlatGroundToTheBit) {
  for (const double flexibility_rad : {0.0, 1.5}) {
    const Character character = thesis_human(flexibility_rad);
    const Pose pose = standing_pose(character);
    ThesisLane lane(character, both_feet(character, pose, {}, {}), pose);
    const auto rotation = lane.lanes.reference_rotation;
    const auto place = lane.lanes.reference_place;
    ground_reference(lane.plan, lane.settings, false, true, lane.lanes);
    for (const int j : lane.plan.live) {
      const auto i = static_cast<std::size_t>(j);
      const Quat<double>& q = lane.lanes.reference_rotation[i];
      EXPECT_EQ(q.w, rotation[i].w);
      EXPECT_EQ(q.x, rotation[i].x);
      EXPECT_EQ(q.y, rotation[i].y);
      EXPECT_EQ(q.z, rotation[i].z);
      EXPECT_EQ(length(lane.lanes.reference_place[i] - place[i]), 0.0);
      EXPECT_EQ(length(lane.lanes.place[i] - place[i]), 0.0);
    }
  }
}

// Thesis 4.2.4.2: the root moves by the mean displacement of the footprints.
TEST(GroundReference, TakesTheRootHalfWayUpAStep) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character, 0.6);
  for (const Method method : kMethods) {
    for (const glm::dvec3& by_m : {glm::dvec3(0, 0.06, 0),
                                   glm::dvec3(0.05, 0.06, 0.08),
                                   glm::dvec3(0, -0.06, 0)}) {
      const ConstraintSet set = both_feet(character, reference, by_m, {});
      Adapter adapter = make_adapter(character, set, by(method));
      Pose out;
      static_cast<void>(adapter.adapt(reference, 0.0, out));
      const glm::dvec3 moved_m = out.root_in_world - reference.root_in_world;
      EXPECT_LT(glm::distance(moved_m, 0.5 * by_m), kFloat_m);
      for (std::size_t c = 0; c < 2; ++c) {
        const auto& support = std::get<Support>(set.constraints[c].goal);
        EXPECT_LT(
            glm::distance(place_in_world(character, out, c ? "rightFoot" : "leftFoot"),
                          *support.footprint_in_world),
            kFloat_m);
      }
    }
  }
}

// Thesis 4.2.4.1: never higher than the straight leg allows; feet exact.
TEST(GroundReference, LowersTheRootAsFarAsTheLowerFootNeeds) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character, 0.2);
  for (const Method method : kMethods) {
    const ConstraintSet set = both_feet(character, reference, {0, -0.3, 0}, {});
    Adapter adapter = make_adapter(character, set, by(method));
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));
    const auto at = [&](const char* s) { return place_in_world(character, out, s); };
    const double leg_m = glm::distance(at("leftUpperLeg"), at("leftLowerLeg")) +
                         glm::distance(at("leftLowerLeg"), at("leftFoot"));
    EXPECT_NEAR(glm::distance(at("leftUpperLeg"), at("leftFoot")), leg_m, 1e-5);
    EXPECT_LT(out.root_in_world.y, reference.root_in_world.y - 0.15);
    // Along the vertical only.
    EXPECT_NEAR(out.root_in_world.x, reference.root_in_world.x, kFloat_m);
    EXPECT_NEAR(out.root_in_world.z, reference.root_in_world.z, kFloat_m);
    const auto& support = std::get<Support>(set.constraints[0].goal);
    EXPECT_LT(glm::distance(at("leftFoot"), *support.footprint_in_world), kFloat_m);
  }
}

// The default target of the centre of mass is that of the grounded reference.
TEST(GroundReference, TakesTheWantedCentreOfMassAlong) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character, 0.6);
  const glm::dvec3 by_m(0.1, 0.0, 0.05);
  for (const Method method : kMethods) {
    AdaptOptions options = by(method);
    options.balance = BalanceMode::kHorizontal;
    const ConstraintSet set = both_feet(character, reference, by_m, by_m);
    Adapter adapter = make_adapter(character, set, options);
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));
    const glm::dvec3 moved_m =
        centre_of_mass_of(character, out) - centre_of_mass_of(character, reference);
    EXPECT_NEAR(moved_m.x, by_m.x, 1.1e-4);
    EXPECT_NEAR(moved_m.z, by_m.z, 1.1e-4);
  }
}

// A step that fades in is anticipated: the root rises with the support's activation.
TEST(GroundReference, AnticipatesAStepAsItsSupportBegins) {
  const Character character = thesis_human();
  const Pose reference = standing_pose(character, 0.6);
  for (const Method method : kMethods) {
    ConstraintSet set = both_feet(character, reference, {0, 0.06, 0}, {});
    set.constraints[0].activation = {0.0, std::nullopt, 1.0, 0.0};
    Adapter adapter = make_adapter(character, set, by(method));
    double before_m = reference.root_in_world.y - 1e-6;
    for (int k = 0; k <= 20; ++k) {
      Pose out;
      static_cast<void>(adapter.adapt(reference, 0.05 * k, out));
      EXPECT_GE(out.root_in_world.y, before_m - 1e-6);
      // The quintic is at most 1.875 times as fast as even progress.
      EXPECT_LT(out.root_in_world.y - before_m, 0.03 * 0.05 * 1.9 + 1e-5);
      before_m = out.root_in_world.y;
    }
    EXPECT_NEAR(before_m - reference.root_in_world.y, 0.03, kFloat_m);
  }
}

struct Reaching {
  Character character;
  Pose reference;
  Pose out;
  [[nodiscard]] double knee_rad() const {
    const auto at = [&](const char* s) { return place_in_world(character, out, s); };
    const glm::dvec3 thigh = glm::normalize(at("leftLowerLeg") - at("leftUpperLeg"));
    const glm::dvec3 shank = glm::normalize(at("leftFoot") - at("leftLowerLeg"));
    return std::acos(std::min(1.0, glm::dot(thigh, shank)));
  }
  [[nodiscard]] double trunk_thigh_rad() const {
    const auto at = [&](const char* s) { return place_in_world(character, out, s); };
    const glm::dvec3 trunk = glm::normalize(at("chest") - at("spine"));
    const glm::dvec3 thigh = glm::normalize(at("leftLowerLeg") - at("leftUpperLeg"));
    return std::acos(glm::dot(trunk, thigh));
  }
};

// Both hands towards the floor before the feet, knees straight in the reference.
Reaching reach_down(Method method, double flexibility_rad, double height_m) {
  Reaching out{thesis_human(flexibility_rad), {}, {}};
  out.reference = standing_pose(out.character, 0.02);
  ConstraintSet set = both_feet(out.character, out.reference, {}, {});
  set.constraints.push_back(contact_of("leftHand", {0.15, height_m, 0.35}));
  set.constraints.push_back(contact_of("rightHand", {-0.15, height_m, 0.35}));
  AdaptOptions options = by(method);
  options.root_for_constraints = 0.0;
  Adapter adapter = make_adapter(out.character, set, options);
  static_cast<void>(adapter.adapt(out.reference, 0.0, out.out));
  return out;
}

// Figure 4.13: the stiffer the subject, the more the knees bend to reach the floor. The
// model is that of the header: a knee bent by f lets the trunk come f nearer to the
// thigh.
TEST(Hamstrings, BendTheKneesOfAStiffSubject) {
  for (const Method method : kMethods) {
    const Reaching supple = reach_down(method, 0.0, 0.25);
    EXPECT_LT(supple.knee_rad(), 0.1);
    double before_rad = supple.knee_rad();
    for (const double limit_rad : {1.6, 1.9}) {
      ASSERT_LT(supple.trunk_thigh_rad(), limit_rad) << "the scene asks for too little";
      const Reaching stiff = reach_down(method, limit_rad, 0.25);
      EXPECT_GT(stiff.knee_rad(), before_rad + 0.05);
      EXPECT_LT(stiff.out.root_in_world.y, supple.out.root_in_world.y - 0.005);
      // Up to the effect of the legs' different pull and of different thigh and shank
      // lengths.
      EXPECT_GT(stiff.trunk_thigh_rad() + stiff.knee_rad(), limit_rad - 0.05);
      before_rad = stiff.knee_rad();
    }
  }
}

TEST(Hamstrings, DoNotActOnASmallBend) {
  for (const Method method : kMethods) {
    const Reaching free = reach_down(method, 0.0, 0.9);
    const Reaching limited = reach_down(method, 1.2, 0.9);
    EXPECT_LT(glm::distance(free.out.root_in_world, limited.out.root_in_world), 1e-12);
    EXPECT_EQ(free.knee_rad(), limited.knee_rad());
  }
}

}  // namespace
}  // namespace marey::retarget
