// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/anthropometry.h"

#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/body/place_masses.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

constexpr std::array kTables{MassTable::kDempster,
                             MassTable::kDeLevaFemale,
                             MassTable::kDeLevaMale,
                             MassTable::kDeLeva};

MassSpec weighing(MassTable table, double total_kg) {
  MassSpec spec;
  spec.table = table;
  spec.total_kg = total_kg;
  return spec;
}

std::vector<PointMass> masses_of(const Skeleton& skeleton, const MassSpec& spec) {
  const auto masses = place_masses(skeleton, mapped(skeleton), spec);
  EXPECT_TRUE(masses) << (masses ? "" : masses.error().message());
  return masses ? *masses : std::vector<PointMass>{};
}

double total_kg(const std::vector<PointMass>& masses) {
  return std::accumulate(
      masses.begin(), masses.end(), 0.0, [](double sum, const PointMass& mass) {
        return sum + mass.mass_kg;
      });
}

glm::dvec3 com_of(const std::vector<PointMass>& masses,
                  const std::vector<RigidTransform>& world_from_joint) {
  glm::dvec3 sum(0.0);
  for (const PointMass& mass : masses) {
    sum += mass.mass_kg * (world_from_joint[index(mass.joint)] * mass.p_in_joint);
  }
  return sum / total_kg(masses);
}

std::vector<RigidTransform> at_rest(const Skeleton& skeleton) {
  return world_from_joints(skeleton, rest_pose(skeleton));
}

// Returns the masses of hips and vertebrae.
std::vector<PointMass> of_trunk(const std::vector<PointMass>& masses,
                                const BodyMap& map) {
  std::vector<PointMass> trunk;
  for (const PointMass& mass : masses) {
    const bool vertebra = map.joints[index(mass.joint)].role == JointRole::kVertebra;
    if (vertebra || mass.joint == map.hips()) trunk.push_back(mass);
  }
  return trunk;
}

const PointMass& of(const std::vector<PointMass>& masses, JointIndex joint) {
  for (const PointMass& mass : masses) {
    if (mass.joint == joint) return mass;
  }
  ADD_FAILURE() << "no mass on joint " << static_cast<int>(joint);
  return masses.front();
}

Skeleton average_adult() {
  return make_humanoid(average_proportions(1.75));
}

// The published shares sum to one body; de Leva's women miss one in ten thousand.
TEST(SegmentTable, AddsUpToOneBody) {
  for (const MassTable which : kTables) {
    const SegmentTable& t = segment_table(which);
    const double sum =
        t.head.mass_share + t.trunk.mass_share +
        2.0 * (t.upper_arm.mass_share + t.forearm.mass_share + t.hand.mass_share +
               t.thigh.mass_share + t.shank.mass_share + t.foot.mass_share);
    EXPECT_NEAR(sum, 1.0, 1.01e-4);
  }
}

// Table 4 gives the same point from two ends: the trunk's from the cervicale (trunk 2,
// 51.38 % of 603.3 mm), the hand's to the knuckle (79.00 % of 86.2 mm).
TEST(SegmentTable, AgreesWithTheOtherEndPointsOfDeLeva) {
  const SegmentTable& t = segment_table(MassTable::kDeLevaMale);
  EXPECT_NEAR(t.trunk.com_at * 515.5, (1.0 - 0.5138) * 603.3, 0.1 /* mm, rounding */);
  EXPECT_NEAR(t.hand.com_at * 187.9, 0.79 * 86.2, 0.1);
}

TEST(WeighSegments, KeepsTheTotalWhateverSegmentsAreGiven) {
  for (const MassTable table : kTables) {
    MassSpec spec = weighing(table, 82.5);
    spec.segment_kg[index(B::kLeftLowerLeg)] = 0.9;
    const auto kg = weigh_segments(spec);
    ASSERT_TRUE(kg);
    EXPECT_NEAR(std::accumulate(kg->begin(), kg->end(), 0.0), 82.5, 1e-12);
    EXPECT_EQ((*kg)[index(B::kLeftLowerLeg)], 0.9);
    // The others keep the table's proportions.
    const SegmentTable& t = segment_table(table);
    EXPECT_NEAR((*kg)[index(B::kHips)] / (*kg)[index(B::kHead)],
                t.trunk.mass_share / t.head.mass_share,
                1e-12);
  }
}

TEST(WeighSegments, TakesAllSegmentsWithoutATotal) {
  MassSpec spec;
  for (const MassSegment& segment : kMassSegments) {
    spec.segment_kg[index(segment.bone)] = 5.0;
  }
  const auto kg = weigh_segments(spec);
  ASSERT_TRUE(kg);
  EXPECT_NEAR(std::accumulate(kg->begin(), kg->end(), 0.0), 70.0, 1e-12);
}

std::string refusal(const MassSpec& spec) {
  const auto kg = weigh_segments(spec);
  return kg ? "" : kg.error().message();
}

TEST(WeighSegments, RejectsInvalidMasses) {
  EXPECT_EQ(refusal(weighing(MassTable::kDempster, 0.0)),
            "character: masses: the total is not above zero. Next: give it in kg.");
  EXPECT_NE(refusal(weighing(MassTable::kDempster, -3.0)), "");
  EXPECT_NE(
      refusal(weighing(MassTable::kDempster, std::numeric_limits<double>::quiet_NaN())),
      "");
  MassSpec spec;
  spec.segment_kg[index(B::kHips)] = -1.0;
  EXPECT_EQ(refusal(spec),
            "character: masses: the mass of trunk is not a valid mass. Next: give it in "
            "kg, zero or more.");
}

TEST(WeighSegments, RefusesSegmentsThatDoNotAddUp) {
  MassSpec some;
  some.segment_kg[index(B::kHead)] = 5.0;
  EXPECT_NE(refusal(some).find("neither the total nor trunk is given"),
            std::string::npos);
  some.total_kg = 4.0;
  EXPECT_NE(refusal(some).find("do not add up"), std::string::npos);
  MassSpec all;
  for (const MassSegment& segment : kMassSegments) {
    all.segment_kg[index(segment.bone)] = 5.0;
  }
  all.total_kg = 70.0;
  EXPECT_EQ(refusal(all), "");
  all.total_kg = 71.0;
  EXPECT_NE(refusal(all).find("do not add up"), std::string::npos);
}

TEST(PlaceMasses, KeepsTheTotalOnEveryBody) {
  Dice dice(41);
  for (const MassTable table : kTables) {
    for (int k = 0; k < 20; ++k) {
      const Skeleton plain = testing::random_humanoid(dice);
      for (const Skeleton& body : {plain,
                                   testing::with_vertebrae(plain, 1 + k % 15),
                                   testing::without(plain, B::kLeftHand),
                                   testing::without(plain, B::kNeck),
                                   testing::without(plain, B::kRightToes),
                                   testing::with_extra_joints(plain)}) {
        EXPECT_NEAR(total_kg(masses_of(body, weighing(table, 61.9))), 61.9, 1e-9);
      }
    }
  }
}

// Between the hip centres and the shoulder centres, for any number of vertebrae.
TEST(PlaceMasses, PutsTheTrunkWhereTheTableHasItWithAnyVertebrae) {
  Dice dice(42);
  for (const MassTable table : kTables) {
    const SegmentTable& t = segment_table(table);
    for (int vertebrae = 1; vertebrae <= 15; ++vertebrae) {
      const Skeleton body = testing::with_random_axes(
          testing::with_vertebrae(testing::random_humanoid(dice), vertebrae), dice);
      const BodyMap map = mapped(body);
      const auto frames = at_rest(body);
      const auto trunk = of_trunk(masses_of(body, weighing(table, 70.0)), map);
      const glm::dvec3 hips = 0.5 * (frames[index(map.leg(0).upper)].translation +
                                     frames[index(map.leg(1).upper)].translation);
      const glm::dvec3 shoulders = 0.5 * (frames[index(map.limbs[0]->upper)].translation +
                                          frames[index(map.limbs[1]->upper)].translation);
      const glm::dvec3 wanted = hips + t.trunk.com_at * (shoulders - hips);
      EXPECT_LT(glm::distance(com_of(trunk, frames), wanted), 1e-12);
      EXPECT_EQ(trunk.size(), static_cast<std::size_t>(vertebrae) + 1);
    }
  }
}

// More vertebrae cut the same trunk finer: with the same bend, its mass is in the same
// place. The coarse spine bends in fewer places; 0.3 rad over half a metre makes some
// millimetres.
TEST(PlaceMasses, BendsTheTrunksMassAlikeWithAnyVertebrae) {
  const Skeleton few = testing::with_vertebrae(average_adult(), 7);
  const Skeleton many = testing::with_vertebrae(average_adult(), 14);
  const auto bent = [](const Skeleton& body, std::size_t count) {
    Pose pose = rest_pose(body);
    for (std::size_t k = 1; k <= count; ++k) {
      pose.parent_from_joint[k] =
          glm::angleAxis(0.3 / static_cast<double>(count), glm::dvec3(1, 0, 0));
    }
    const auto masses = masses_of(body, weighing(MassTable::kDeLevaMale, 70.0));
    return com_of(of_trunk(masses, mapped(body)), world_from_joints(body, pose));
  };
  const glm::dvec3 upright = com_of(
      of_trunk(masses_of(few, weighing(MassTable::kDeLevaMale, 70.0)), mapped(few)),
      at_rest(few));
  EXPECT_GT(glm::distance(bent(few, 7), upright), 0.02);
  EXPECT_LT(glm::distance(bent(few, 7), bent(many, 14)), 0.005);
}

TEST(PlaceMasses, PutsLimbsOnTheLineBetweenTheirJoints) {
  Dice dice(43);
  const Skeleton body = testing::with_random_axes(
      testing::in_a_pose(testing::random_humanoid(dice), 0.7), dice);
  const BodyMap map = mapped(body);
  const auto frames = at_rest(body);
  const auto masses = masses_of(body, weighing(MassTable::kDempster, 70.0));
  const auto expect = [&](JointIndex from, JointIndex to, const SegmentRow& row) {
    const glm::dvec3 a = frames[index(from)].translation;
    const glm::dvec3 b = frames[index(to)].translation;
    const PointMass& mass = of(masses, from);
    EXPECT_NEAR(mass.mass_kg, 70.0 * row.mass_share, 1e-9);
    EXPECT_LT(
        glm::distance(frames[index(from)] * mass.p_in_joint, a + row.com_at * (b - a)),
        1e-12);
  };
  const SegmentTable& t = segment_table(MassTable::kDempster);
  for (std::size_t side = 0; side < 2; ++side) {
    expect(map.limbs[side]->upper, map.limbs[side]->lower, t.upper_arm);
    expect(map.limbs[side]->lower, map.limbs[side]->end, t.forearm);
    expect(map.limbs[2 + side]->upper, map.limbs[2 + side]->lower, t.thigh);
    expect(map.limbs[2 + side]->lower, map.limbs[2 + side]->end, t.shank);
  }
}

// The ends of the body, with the end points of each table, on an average adult at rest.
TEST(PlaceMasses, PutsHeadHandsAndFeetWhereTheTablesHaveThem) {
  const Skeleton body = average_adult();
  const BodyMap map = mapped(body);
  const auto frames = at_rest(body);
  const auto place = [&](B bone) { return frames[index(*body.find(bone))].translation; };
  const auto tip = [&](B bone) {
    const JointIndex joint = *body.find(bone);
    return frames[index(joint)] * *body[joint].tip_in_joint;
  };
  for (const MassTable table : kTables) {
    const bool dempster = table == MassTable::kDempster;
    const SegmentTable& t = segment_table(table);
    const auto masses = masses_of(body, weighing(table, 70.0));
    const auto com = [&](B bone) {
      const PointMass& mass = of(masses, *body.find(bone));
      return frames[index(mass.joint)] * mass.p_in_joint;
    };
    // Dempster's is at the knuckles, at 0.459 of de Leva's length to the finger tip.
    const double hand_at = t.hand.com_at * (dempster ? 0.459 : 1.0);
    EXPECT_LT(glm::distance(com(B::kRightHand),
                            glm::mix(place(B::kRightHand), tip(B::kRightHand), hand_at)),
              1e-12);
    // At the ear, or half way from the neck's base to the vertex.
    const double up =
        (com(B::kHead).y - place(B::kNeck).y) / (tip(B::kHead).y - place(B::kNeck).y);
    EXPECT_NEAR(up, dempster ? 0.55 : t.head.com_at, 0.01);
    // Between ankle and ball, or in front of the heel, which is behind the ankle: by both
    // a little in front of it, and half as high.
    const glm::dvec3 foot = com(B::kLeftFoot);
    EXPECT_NEAR(foot.x, place(B::kLeftFoot).x, 1e-9);
    EXPECT_NEAR(foot.y, 0.5 * place(B::kLeftFoot).y, dempster ? 0.015 : 1e-9);
    EXPECT_GT(foot.z, place(B::kLeftFoot).z + 0.2 * 0.16 * 1.75 * 0.5);
    EXPECT_LT(foot.z, place(B::kLeftToes).z * 0.51);
    if (!dempster) {
      const double length_m = 0.152 * 1.75;  // Winter's; its end is the toes' tip.
      const double heel = tip(B::kLeftToes).z - length_m;
      EXPECT_NEAR((foot.z - heel) / length_m, t.foot.com_at, 0.002);
    }
  }
}

// Measured with arms at the sides: 0.54 to 0.58 of the stature (Winter, chapter 4). The
// arms of a T-pose are 10 % of the mass and 0.15 to 0.2 of the stature higher.
TEST(PlaceMasses, PutsTheWholeBodysCentreWhereItIsMeasured) {
  const Skeleton body = average_adult();
  for (const MassTable table : {MassTable::kDeLevaFemale, MassTable::kDeLevaMale}) {
    const glm::dvec3 com = com_of(masses_of(body, weighing(table, 70.0)), at_rest(body));
    EXPECT_NEAR(com.x, 0.0, 1e-12);
    EXPECT_GT(com.y / 1.75, 0.54 + 0.015);
    EXPECT_LT(com.y / 1.75, 0.58 + 0.02);
    EXPECT_LT(std::abs(com.z), 0.02);
  }
}

// Measured by balance boards on people who stand with their arms at their sides: 0.55 to
// 0.57 of the stature (women's and men's means). With the 0.66 that table 5.1 of the
// thesis has for the trunk it would be 0.59.
TEST(PlaceMasses, PutsTheCentreOfAStandingBodyAtItsMeasuredPlace) {
  const Skeleton body = average_adult();
  Pose standing = rest_pose(body);
  for (const auto& [bone, sign] :
       {std::pair{B::kLeftUpperArm, -1.0}, std::pair{B::kRightUpperArm, 1.0}}) {
    standing.parent_from_joint[index(*body.find(bone))] =
        glm::angleAxis(sign * 1.5, glm::dvec3(0, 0, 1));
  }
  const auto height = [&](const MassSpec& spec) {
    return com_of(masses_of(body, spec), world_from_joints(body, standing)).y / 1.75;
  };
  EXPECT_GT(height({}), 0.55) << "the default";
  EXPECT_LT(height({}), 0.57) << "the default";
  for (const MassTable table : {MassTable::kDeLevaFemale, MassTable::kDeLevaMale}) {
    EXPECT_GT(height(weighing(table, 70.0)), 0.55);
    EXPECT_LT(height(weighing(table, 70.0)), 0.57);
  }
  EXPECT_NEAR(height(weighing(MassTable::kDempster, 70.0)), 0.59, 0.005);
}

// Table 5.1 of the thesis has the trunk's centre at 0.66 of it, where Winter has that of
// trunk, head and neck together; the trunk alone is at 0.5. That is 0.16 of 0.265 of the
// stature for half the mass, 0.021; legs that are lighter than de Leva's make up the
// rest.
TEST(PlaceMasses, FollowsTheThesisInAHighTrunk) {
  const Skeleton body = average_adult();
  const auto height = [&](MassTable table) {
    return com_of(masses_of(body, weighing(table, 70.0)), at_rest(body)).y / 1.75;
  };
  const double higher = height(MassTable::kDempster) - height(MassTable::kDeLevaMale);
  EXPECT_GT(higher, 0.021);
  EXPECT_LT(higher, 0.021 + 0.015);
}

TEST(PlaceMasses, GivesAMirroredBodyMirroredMasses) {
  Dice dice(44);
  const Skeleton body = testing::random_humanoid(dice);
  const Skeleton other = testing::mirrored_body(body);
  for (const MassTable table : kTables) {
    const glm::dvec3 a = com_of(masses_of(body, weighing(table, 70.0)), at_rest(body));
    const glm::dvec3 b = com_of(masses_of(other, weighing(table, 70.0)), at_rest(other));
    EXPECT_LT(glm::distance(a * glm::dvec3(-1, 1, 1), b), 1e-12);
  }
}

// An arm without a hand is extended straight: the hand's mass is beyond the elbow's bone.
TEST(PlaceMasses, CarriesAMissingHandBeyondTheForearm) {
  const Skeleton whole = average_adult();
  const Skeleton cut = testing::without(whole, B::kLeftHand);
  const MassSpec spec = weighing(MassTable::kDeLevaMale, 70.0);
  // The average arm is the estimate.
  EXPECT_LT(glm::distance(com_of(masses_of(whole, spec), at_rest(whole)),
                          com_of(masses_of(cut, spec), at_rest(cut))),
            1e-4);
}

}  // namespace
}  // namespace marey::retarget
