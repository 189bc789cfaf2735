// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/segment_inertia.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/body/place_masses.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

constexpr std::array kInertiaTables{MassTable::kDempster,
                                    MassTable::kDeLevaFemale,
                                    MassTable::kDeLevaMale,
                                    MassTable::kDeLeva};

MassSpec man_of(double total_kg, MassTable table) {
  MassSpec spec;
  spec.table = table;
  spec.total_kg = total_kg;
  return spec;
}

std::vector<PointMass> bodies_masses(const Skeleton& skeleton, const MassSpec& spec) {
  const auto masses = place_masses(skeleton, mapped(skeleton), spec);
  EXPECT_TRUE(masses);
  return masses ? *masses : std::vector<PointMass>{};
}

double distance_of(const glm::dmat3& a, const glm::dmat3& b) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) sum += glm::dot(a[c] - b[c], a[c] - b[c]);
  return std::sqrt(sum);
}

const PointMass* mass_on(const std::vector<PointMass>& masses,
                         std::optional<JointIndex> joint) {
  for (const PointMass& mass : masses) {
    if (mass.joint == joint) return &mass;
  }
  return nullptr;
}

Pose arms_at(const Skeleton& body, double raised_rad) {
  Pose pose = rest_pose(body);
  for (const auto& [bone, sign] :
       {std::pair{B::kLeftUpperArm, 1.0}, std::pair{B::kRightUpperArm, -1.0}}) {
    pose.parent_from_joint[index(*body.find(bone))] =
        glm::angleAxis(sign * raised_rad, glm::dvec3(0, 0, 1));
  }
  return pose;
}

// Moments about the axes from back to front, from side to side, and along the body.
struct WholeBody {
  double stature_m = 0.0;
  double mass_kg = 0.0;
  glm::dvec3 standing_kg_m2{0.0};
  glm::dvec3 arms_up_kg_m2{0.0};
};

// Santschi, DuBois & Omoto 1963 ("Moments of inertia and centers of gravity of the living
// human body", AMRL-TDR-63-36): three men measured as pendulums, in pounds, inches and
// lb in s^2; stated error 2 to 8 %. The moment along the body depends on its breadth and
// on the distance of the arms, which a table by stature and mass does not know.
std::vector<WholeBody> santschi() {
  constexpr double kInertia = 0.11298;
  constexpr double kInch_m = 0.0254;
  constexpr double kPound_kg = 0.45359;
  return {{72.2 * kInch_m,
           173.5 * kPound_kg,
           kInertia * glm::dvec3(132, 119, 13.1),
           kInertia * glm::dvec3(174, 159, 12.5)},
          {67.4 * kInch_m,
           147.3 * kPound_kg,
           kInertia * glm::dvec3(95.6, 81.9, 10.3),
           kInertia * glm::dvec3(126, 110, 10.2)},
          {73.3 * kInch_m,
           203.0 * kPound_kg,
           kInertia * glm::dvec3(144, 129, 14.2),
           kInertia * glm::dvec3(188, 172, 13.8)}};
}

TEST(SegmentInertia, GivesWholeBodiesTheirMeasuredMoments) {
  for (const WholeBody& man : santschi()) {
    const Skeleton body = make_humanoid(average_proportions(man.stature_m));
    const auto masses = bodies_masses(body, man_of(man.mass_kg, MassTable::kDeLevaMale));
    const auto expect_near = [&](double raised_rad, const glm::dvec3& wanted) {
      const glm::dmat3 inertia =
          testing::judged_inertia(body, masses, arms_at(body, raised_rad));
      const glm::dvec3 got(inertia[2][2], inertia[0][0], inertia[1][1]);
      const glm::dvec3 ratio = got / wanted;
      EXPECT_NEAR(ratio.x, 1.0, 0.1) << man.stature_m << " m, arms " << raised_rad;
      EXPECT_NEAR(ratio.y, 1.0, 0.1) << man.stature_m << " m, arms " << raised_rad;
      EXPECT_NEAR(ratio.z, 0.85, 0.15) << man.stature_m << " m, arms " << raised_rad;
    };
    expect_near(-1.5, man.standing_kg_m2);
    expect_near(1.5, man.arms_up_kg_m2);
  }
}

TEST(SegmentInertia, IsThatOfABodyOnEverySkeleton) {
  Dice dice(71);
  for (int k = 0; k < 100; ++k) {
    const Skeleton plain = testing::random_humanoid(dice);
    const std::array bodies{
        plain,
        testing::with_random_axes(testing::with_vertebrae(plain, 1 + k % 15), dice),
        testing::in_a_pose(plain, 0.8),
        testing::without(plain, B::kLeftHand),
        testing::without(plain, B::kNeck),
        testing::with_extra_joints(plain)};
    for (const Skeleton& body : bodies) {
      const MassTable table = kInertiaTables[static_cast<std::size_t>(k) % 4];
      for (const PointMass& mass : bodies_masses(body, man_of(70.0, table))) {
        const glm::dmat3& j = mass.inertia_per_kg_m2;
        EXPECT_LT(distance_of(j, glm::transpose(j)), 1e-15);
        // Sylvester's rule for the inertia and, for a body that has an extent in every
        // direction, for half its trace minus the inertia.
        const glm::dmat3 spread =
            0.5 * (j[0][0] + j[1][1] + j[2][2]) * glm::dmat3(1.0) - j;
        for (const glm::dmat3& m : {j, spread}) {
          EXPECT_GT(m[0][0], 0.0);
          EXPECT_GT(m[0][0] * m[1][1] - m[0][1] * m[1][0], 0.0);
          EXPECT_GT(glm::determinant(m), 0.0);
        }
      }
    }
  }
}

// The trunk's own axes: along the line from the hip centres to the shoulder centres.
TEST(SegmentInertia, GivesTheTrunkTheTablesMomentsWithAnyVertebrae) {
  Dice dice(72);
  for (int vertebrae = 1; vertebrae <= 15; ++vertebrae) {
    for (const MassTable table : kInertiaTables) {
      // Random lengths of average shape: the spine stays near the trunk's line.
      const Skeleton body = testing::with_random_axes(
          testing::with_vertebrae(
              make_humanoid(average_proportions(dice.between(1.0, 2.2))), vertebrae),
          dice);
      const BodyMap map = mapped(body);
      const auto frames = world_from_joints(body, rest_pose(body));
      std::vector<PointMass> trunk;
      double trunk_kg = 0.0;
      for (const PointMass& mass : bodies_masses(body, man_of(70.0, table))) {
        const bool vertebra = map.joints[index(mass.joint)].role == JointRole::kVertebra;
        if (!vertebra && mass.joint != map.hips()) continue;
        trunk.push_back(mass);
        trunk_kg += mass.mass_kg;
      }
      const auto place = [&](JointIndex j) { return frames[index(j)].translation; };
      const glm::dvec3 along =
          0.5 * (place(map.limbs[0]->upper) + place(map.limbs[1]->upper)) -
          0.5 * (place(map.leg(0).upper) + place(map.leg(1).upper));
      const double length_m = glm::length(along);
      const glm::dvec3 up = along / length_m;
      const glm::dvec3 aside(1.0, 0.0, 0.0);
      const glm::dvec3 front = glm::normalize(glm::cross(aside, up));
      const glm::dmat3 inertia =
          testing::judged_inertia(body, trunk, rest_pose(body)) / trunk_kg;
      const GyrationRadii& radii = segment_table(table).trunk.gyration;
      const auto radius = [&](const glm::dvec3& axis) {
        return std::sqrt(glm::dot(axis, inertia * axis)) / length_m;
      };
      EXPECT_NEAR(radius(front), radii.sagittal, 1e-9) << vertebrae;
      EXPECT_NEAR(radius(aside), radii.transverse, 1e-9) << vertebrae;
      EXPECT_NEAR(radius(up), radii.longitudinal, 1e-9) << vertebrae;
    }
  }
}

// A hand's inertia about the axis across the palm's plane is the largest.
TEST(SegmentInertia, LiesAlongTheSegmentsOfABodyInAnyRestPose) {
  Dice dice(73);
  for (int k = 0; k < 50; ++k) {
    const Skeleton body = testing::with_random_axes(
        testing::in_a_pose(testing::random_humanoid(dice), 0.1 * (k % 8)), dice);
    const auto frames = world_from_joints(body, rest_pose(body));
    const SegmentTable& t = segment_table(MassTable::kDeLevaMale);
    const auto masses = bodies_masses(body, man_of(70.0, MassTable::kDeLevaMale));
    for (const auto& [from, to, row] :
         {std::tuple{B::kLeftUpperArm, B::kLeftLowerArm, &t.upper_arm},
          std::tuple{B::kRightLowerArm, B::kRightHand, &t.forearm},
          std::tuple{B::kLeftUpperLeg, B::kLeftLowerLeg, &t.thigh},
          std::tuple{B::kRightLowerLeg, B::kRightFoot, &t.shank}}) {
      const glm::dvec3 along = frames[index(*body.find(to))].translation -
                               frames[index(*body.find(from))].translation;
      const double length_m = glm::length(along);
      const PointMass* mass = mass_on(masses, body.find(from));
      ASSERT_NE(mass, nullptr);
      const glm::dquat& world = frames[index(mass->joint)].rotation;
      const glm::dvec3 in_joint = glm::conjugate(world) * (along / length_m);
      const glm::dvec3 turned = mass->inertia_per_kg_m2 * in_joint;
      // An eigenvector with the longitudinal moment; the other two in the trace.
      const double longitudinal = std::pow(row->gyration.longitudinal * length_m, 2.0);
      EXPECT_LT(glm::distance(turned, longitudinal * in_joint), 1e-12);
      const glm::dmat3& j = mass->inertia_per_kg_m2;
      EXPECT_NEAR(j[0][0] + j[1][1] + j[2][2] - longitudinal,
                  length_m * length_m *
                      (std::pow(row->gyration.sagittal, 2.0) +
                       std::pow(row->gyration.transverse, 2.0)),
                  1e-12);
    }
  }
}

TEST(SegmentInertia, IsMirroredOnTheOtherSide) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  const glm::dvec3 mirror(-1.0, 1.0, 1.0);
  for (const MassTable table : kInertiaTables) {
    const auto masses = bodies_masses(body, man_of(70.0, table));
    for (const B left : {B::kLeftUpperArm,
                         B::kLeftLowerArm,
                         B::kLeftHand,
                         B::kLeftUpperLeg,
                         B::kLeftLowerLeg,
                         B::kLeftFoot}) {
      const PointMass* a = mass_on(masses, body.find(left));
      const PointMass* b = mass_on(masses, body.find(mirrored(left)));
      ASSERT_TRUE(a != nullptr && b != nullptr);
      EXPECT_LT(glm::distance(mirror * a->p_in_joint, b->p_in_joint), 1e-12);
      glm::dmat3 image = a->inertia_per_kg_m2;
      for (int c = 0; c < 3; ++c) image[c] *= mirror[c] * mirror;
      EXPECT_LT(distance_of(image, b->inertia_per_kg_m2), 1e-15);
    }
  }
}

// Turned joint axes describe the same body.
TEST(SegmentInertia, DoesNotDependOnTheAxesOfTheJoints) {
  Dice dice(74);
  for (int k = 0; k < 50; ++k) {
    const Skeleton body = testing::random_humanoid(dice);
    const Skeleton other = testing::with_random_axes(body, dice);
    const auto inertia = [&](const Skeleton& skeleton) {
      return testing::judged_inertia(
          skeleton,
          bodies_masses(skeleton, man_of(70.0, MassTable::kDeLeva)),
          rest_pose(skeleton));
    };
    EXPECT_LT(distance_of(inertia(body), inertia(other)), 1e-9);
  }
}

// Two parts further apart than the whole allows: the nearest possible, never negative.
TEST(PartInertia, StaysPossibleForPartsFarApart) {
  const glm::dmat3 whole = inertia_per_kg({0.3, 0.28, 0.15}, {{0.0, 0.5, 0.0}});
  const std::array parts{SegmentPart{0.5, {0.0, 0.4, 0.0}},
                         SegmentPart{0.5, {0.0, -0.4, 0.0}}};
  const glm::dmat3 part = part_inertia_per_kg(whole, parts);
  EXPECT_GT(glm::determinant(part), 0.0);
  EXPECT_GT(part[0][0], 0.0);
  // The moment along the body is not concerned.
  EXPECT_NEAR(part[1][1], whole[1][1], 1e-12);
}

TEST(InertiaPerKg, IsZeroWithoutALength) {
  EXPECT_EQ(inertia_per_kg({0.3, 0.3, 0.1}, {}), glm::dmat3(0.0));
}

}  // namespace
}  // namespace marey::retarget
