// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/assess_subject.h"

#include <string>

#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

/// A fit without warnings: four tags, all joints known, all seen by two cameras.
struct Fitted {
  SubjectBundle bundle;
  SubjectEvidence evidence;

  Fitted() {
    bundle.usual.fill(0.4);
    bundle.model.lengths.fill(0.4);
    bundle.length_sigma_m.fill(0.003);
    bundle.centre_sigma_m.fill(0.004);
    bundle.prior_weight = 10.0;
    bundle.model.tags = {{TagId{10}, HumanBone::kLeftLowerLeg, 0.08},
                         {TagId{11}, HumanBone::kLeftFoot, 0.08},
                         {TagId{12}, HumanBone::kRightHand, 0.08},
                         {TagId{13}, HumanBone::kHips, 0.08}};
    for (std::size_t tag = 0; tag < bundle.model.tags.size(); ++tag) {
      bundle.model.segment_from_tag[tag] = {};
      evidence.tags.push_back({tag, 100, 0.95, 1.0});
    }
    for (ExtremityFit& fit : evidence.extremities) {
      fit = {true, 1.0, 100, 1000.0, 0.2};
    }
    evidence.seen_twice_share.fill(0.5);
    evidence.located_frames.fill(300);
  }

  /// Returns the warnings, one per line.
  [[nodiscard]] std::string warning_text() const {
    std::string text;
    Fitted left = *this;
    (void)leave_out_extremities(left.bundle, left.evidence);
    for (const Finding& warning : assess_subject(left.bundle, left.evidence)) {
      EXPECT_EQ(warning.severity, Severity::kPoor);
      EXPECT_FALSE(warning.next.empty()) << warning.cause;
      text += warning.cause + "\n";
    }
    return text;
  }
};

constexpr std::size_t kLeftLeg = 2;

TEST(AssessSubject, HasNoWarningsForAGoodFit) {
  EXPECT_EQ(Fitted().warning_text(), "");
}

TEST(AssessSubject, NamesATagThatNoPlaceExplains) {
  Fitted fit;
  fit.bundle.model.segment_from_tag.erase(3);
  fit.evidence.unexplained = {3};
  EXPECT_EQ(fit.warning_text(), "") << "few frames show it";
  std::vector<TagSighting> sightings(12);
  for (TagSighting& sighting : sightings) sighting.tag = 3;
  BundleFrame frame;
  frame.sightings = sightings;
  fit.bundle.frames.push_back(frame);
  EXPECT_EQ(fit.warning_text(), "tag 13 does not move with segment \"hips\"\n");
}

TEST(AssessSubject, NamesATagWhoseSightingsAreTwoPopulations) {
  Fitted fit;
  fit.evidence.tags[0].explained_share = 0.6;
  EXPECT_NE(fit.warning_text().find("tag 10 on segment \"leftLowerLeg\""),
            std::string::npos);
  EXPECT_NE(fit.warning_text().find("40 % of its sightings"), std::string::npos)
      << fit.warning_text();
  fit.evidence.tags[0] = {0, 100, 0.95, 6.0};
  EXPECT_NE(
      fit.warning_text().find("tag 10 on segment \"leftLowerLeg\" fits its place worse"),
      std::string::npos);
  fit.evidence.tags[0] = {0, 10, 0.6, 6.0};
  EXPECT_EQ(fit.warning_text(), "") << "too few sightings to judge by";
}

TEST(AssessSubject, NamesAFootThatFitsInTwoWays) {
  Fitted fit;
  ExtremityFit& foot = fit.evidence.extremities[kLeftLeg];
  // Weighted sightings: the limit is ten times that of independent ones.
  foot.runner_up_cost = 40.0;
  EXPECT_NE(fit.warning_text().find("\"leftFoot\" fit in two ways, 200 mm apart"),
            std::string::npos)
      << fit.warning_text();
  foot.sightings = 4;
  EXPECT_NE(fit.warning_text().find("\"leftFoot\" fit in two ways"), std::string::npos);
  foot.runner_up_m = 0.02;
  EXPECT_EQ(fit.warning_text(), "") << "both fits have the same result";
  foot = {false, 0.0, 100, 0.0, 0.0};
  EXPECT_NE(fit.warning_text().find("no place of the tags on segment \"leftFoot\""),
            std::string::npos);
}

TEST(AssessSubject, LeavesOutTheTagsOfAFootWithTwoPossiblePlaces) {
  Fitted fit;
  EXPECT_FALSE(leave_out_extremities(fit.bundle, fit.evidence));
  fit.evidence.extremities[kLeftLeg].runner_up_cost = 40.0;
  EXPECT_TRUE(leave_out_extremities(fit.bundle, fit.evidence));
  EXPECT_FALSE(fit.bundle.model.place(1)) << "the left foot's tag";
  for (const std::size_t other : {0, 2, 3}) EXPECT_TRUE(fit.bundle.model.place(other));
  const auto& reason = fit.evidence.left_out[kLeftLeg];
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->cause.find("the joint \"leftFoot\" is inferred"), std::string::npos)
      << reason->cause;
  EXPECT_NE(reason->next.find("turning that segment slowly"), std::string::npos);
  EXPECT_EQ(assess_subject(fit.bundle, fit.evidence).size(), 1U);
}

TEST(AssessSubject, NamesALimbThatTwoCamerasHardlySee) {
  Fitted fit;
  fit.evidence.seen_twice_share[index(HumanBone::kRightHand)] = 0.01;
  EXPECT_EQ(fit.warning_text(), "");
  fit.evidence.seen_twice_share[index(HumanBone::kRightLowerArm)] = 0.05;
  EXPECT_NE(fit.warning_text().find("\"rightLowerArm\" and \"rightHand\""),
            std::string::npos)
      << fit.warning_text();
}

TEST(AssessSubject, NamesABoneThatHardlyAnyFrameLocates) {
  Fitted fit;
  fit.evidence.located_frames[index(HumanBone::kLeftUpperArm)] = 0;
  EXPECT_EQ(fit.warning_text(), "") << "it has no tags";
  fit.evidence.located_frames[index(HumanBone::kLeftLowerLeg)] = 15;
  EXPECT_EQ(fit.warning_text(), "");
  fit.evidence.located_frames[index(HumanBone::kLeftLowerLeg)] = 14;
  EXPECT_NE(
      fit.warning_text().find("segment \"leftLowerLeg\" is seen well enough in only 14"),
      std::string::npos)
      << fit.warning_text();
}

TEST(AssessSubject, NamesATagThatIsNotOnItsSegmentsSkin) {
  Fitted fit;
  fit.bundle.model.segment_from_tag[0].translation = glm::dvec3(0.0, -0.2, 0.2);
  EXPECT_NE(fit.warning_text().find(
                "tag 10 is fitted to a place where segment \"leftLowerLeg\""),
            std::string::npos)
      << fit.warning_text();
}

TEST(AssessSubject, NamesALimbThatStandsTurnedAboutItself) {
  Fitted fit;
  BundleFrame frame;
  frame.standing = true;
  fit.bundle.frames.push_back(frame);
  EXPECT_EQ(fit.warning_text(), "");
  fit.bundle.frames[0].posture.set_rotation(
      PoseParameter::kLeftLeg, rotation_from_vector(glm::dvec3(0.0, 2.5, 0.0)));
  EXPECT_NE(fit.warning_text().find(
                "segment \"leftUpperLeg\" is fitted turned about its own axis "
                "by 143 degrees"),
            std::string::npos)
      << fit.warning_text();
}

TEST(AssessSubject, WarnsOfUnequalSidesAndImplausibleLengths) {
  Fitted fit;
  fit.bundle.model.lengths[index(Length::kRightLowerLeg)] = 0.455;
  EXPECT_NE(
      fit.warning_text().find("\"leftLowerLeg\" is 400 mm long on the left and 455 mm on "
                              "the right"),
      std::string::npos)
      << fit.warning_text();
  fit = {};
  fit.bundle.model.lengths[index(Length::kLeftUpperArm)] = 0.6;
  fit.bundle.model.lengths[index(Length::kRightUpperArm)] = 0.6;
  EXPECT_NE(fit.warning_text().find("\"leftUpperArm\" is 600 mm long"),
            std::string::npos);
}

TEST(AssessSubject, NamesAJointThatIsHardlyKnown) {
  Fitted fit;
  fit.bundle.centre_sigma_m[index(HumanBone::kRightLowerLeg)] = 0.021;
  EXPECT_NE(fit.warning_text().find(
                "near end of segment \"rightLowerLeg\" has an uncertainty of 21 mm"),
            std::string::npos)
      << fit.warning_text();
  fit.bundle.centre_sigma_m[index(HumanBone::kRightLowerLeg)].reset();
  EXPECT_NE(fit.warning_text().find("could not be determined"), std::string::npos);
}

}  // namespace
}  // namespace marey::reconstruct
