// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/name_markers.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/labels/named_labels.h"

namespace marey::reconstruct {
namespace {

using testing::expect_names;
using testing::kPlugInGait;
using testing::name_of;
using testing::unnamed;
using testing::words;

// addbiomechanics/Expert2/run0350cms.trc.
TEST(NameMarkers, DecidesAmbiguousLabelsByTheirCompany) {
  expect_names(
      words("C7 RSH LSH MAN T7 LARM LELB LFOREARM LWR RASI LASI SACR P1 P2 P3 LTHLP "
            "LLEPI LPAT LTILAT LLMAL LHEEL LMFS LMFL LP1MT LTOE LP5MT x52"),
      "running with clusters",
      {{"RSH", "right_acromion"},
       {"LTOE", "left_toe_tip"},
       {"P1", "hips"},
       {"LPAT", "left_patella"},
       {"x52", ""}});
  // Forty-five numbered points, three of which have names of a set.
  std::vector<std::string> numbered;
  for (int i = 1; i <= 45; ++i)
    numbered.push_back(std::string("P").append(std::to_string(i)));
  EXPECT_EQ(unnamed(numbered), numbered);
}

// mocaprecovery/03_rolling.c3d: every label begins with one more L.
TEST(NameMarkers, LeavesOutALetterThatAllLabelsShare) {
  const auto labels = words(
      "LRFHD LLFHD LLBHD LRBHD LCLAV LSTRN LLAC LLUA1 LCV7 LTV10 LL_IPS LR_IPS LRAC "
      "LL_HLE "
      "LL_RSP LL_USP LL_HM1 LL_HL5 LRF1 LR_IAS LL_FTC LL_TH1 LL_FLE LL_SK1 LR-SK1 LR_FCC "
      "LR_TAM");
  EXPECT_TRUE(unnamed(labels).empty());
  EXPECT_EQ(name_markers(labels).prefix, "L");
  expect_names(labels,
               "anatomical (van Sint Jan)",
               {{"LRFHD", "right_front_head"},
                {"LL_IPS", "left_psis"},
                {"LCLAV", "suprasternal_notch"},
                {"LRF1", "right_forearm"},
                {"LR-SK1", "right_shank"}});
}

TEST(NameMarkers, LeavesOutASubjectsName) {
  for (const std::string prefix : {"Bob:", "Bob_", "S01-", "Trial 3:Bob_"}) {
    std::vector<std::string> labels;
    for (const std::string& label : words(kPlugInGait)) labels.push_back(prefix + label);
    EXPECT_TRUE(unnamed(labels).empty()) << prefix;
    EXPECT_EQ(name_markers(labels).prefix, prefix);
  }
  // A person's name on only some labels is not a prefix.
  EXPECT_EQ(unnamed(words("Bob_LASI LASI RASI LPSI RPSI")), words("Bob_LASI"));
}

// The common letter of a one-legged study is a side, not a prefix.
TEST(NameMarkers, KeepsASideThatAllLabelsShare) {
  expect_names(words("LASI LPSI LTHI LKNE LTIB LANK LHEE LTOE"),
               "Plug-in Gait",
               {{"LASI", "left_asis"}, {"LTOE", "left_metatarsal_2_head"}});
}

TEST(NameMarkers, NamesOneOfSeveralSubjects) {
  std::vector<std::string> labels;
  for (const std::string& label : words("LASI RASI SACR LKNE RKNE")) {
    labels.push_back("Ann:" + label);
  }
  for (const std::string& label : words("LASI RASI LPSI RPSI LKNE RKNE")) {
    labels.push_back("Bob:" + label);
  }
  const MarkerNames names = name_markers(labels);
  EXPECT_EQ(names.prefix, "Bob:");
  EXPECT_EQ(name_of(labels, names, "Ann:LASI"), "");
  EXPECT_EQ(name_of(labels, names, "Bob:LASI"), "left_asis");
  ASSERT_EQ(names.notes.size(), 1U);
  EXPECT_EQ(names.notes[0],
            "the labels belong to several subjects: only those of \"Bob:\" are used");
}

TEST(NameMarkers, DistinguishesComputedPointsFromUnknownOnes) {
  const auto labels =
      words("LASI RASI LPSI RPSI LKNE RKNE LANK RANK LHEE RHEE LTOE RTOE PELO LFEP foo");
  std::vector<bool> expected(labels.size(), false);
  expected[12] = expected[13] = true;
  EXPECT_EQ(name_markers(labels).is_computed, expected);
}

TEST(NameMarkers, DoesNotMindHowASideIsWritten) {
  expect_names(
      words("Left_Knee knee_r Knee-Left RightHeel heel.l LEFT.ANKLE.LAT asisl ASISr"),
      "",
      {{"Left_Knee", "left_lateral_epicondyle_femur"},
       {"knee_r", "right_lateral_epicondyle_femur"},
       {"RightHeel", "right_heel"},
       {"heel.l", "left_heel"},
       {"LEFT.ANKLE.LAT", "left_lateral_malleolus"},
       {"asisl", "left_asis"},
       {"ASISr", "right_asis"}});
}

// ezc3d/Vicon.c3d: STYLr is the radius's styloid and SCAPl something lateral on a
// scapula, but PSISr and PSISl are right and left.
TEST(NameMarkers, AcceptsALastLetterIfBothSidesExist) {
  expect_names(words("ASISr ASISl PSISr PSISl XIPH T10 SCAPl SCAPm STYLr STYLu"),
               "",
               {{"PSISr", "right_psis"}, {"SCAPl", ""}, {"STYLr", ""}, {"T10", "t10"}});
}

TEST(NameMarkers, KnowsSegmentsByTheirWords) {
  expect_names(
      words("RTH1 LThigh3 R_SHANK_LAT_2 RSH2 LUA1 Pelvis2 right_forearm_b HEAD1 LFT3 "
            "Left_Thigh_Upper Cluster1 RTH PVC1"),
      "",
      {{"RTH1", "right_thigh"},
       {"LThigh3", "left_thigh"},
       {"R_SHANK_LAT_2", "right_shank"},
       {"RSH2", "right_shank"},
       {"LUA1", "left_upper_arm"},
       {"Pelvis2", "hips"},
       {"HEAD1", "head"},
       {"LFT3", "left_foot"},
       {"Left_Thigh_Upper", "left_thigh"},
       {"Cluster1", ""},
       {"PVC1", ""}});
}

// c3d_org_samples/sample_26/Walking_Hybrid_2.c3d holds most of its markers three times.
TEST(NameMarkers, NamesTheFirstOfEqualLabelsAlone) {
  EXPECT_EQ(
      unnamed(words("R_ASIS L_ASIS SACRUM R_SHANK_1 R_SHANK_2 R_HEEL R_ASIS_2 SACRUM_2 "
                    "R_SHANK_1_2 R_HEEL_3")),
      words("R_ASIS_2 SACRUM_2 R_SHANK_1_2 R_HEEL_3"));
}

TEST(NameMarkers, NamesNoMarkerForMeaninglessLabels) {
  for (const char* const text : {"M00 M01 M02 M03",
                                 "2000 2001 2002",
                                 "*1 *2 *3",
                                 "Marker_1 Marker_2",
                                 "L1 L2 L3 R1 R2 R3",
                                 "T1 T2 T3 T4",
                                 "boite:gauche_ext boite:droite_int",
                                 "toe heel latAnkle hip",
                                 "LHipAngles RKneeMoment LGRF"}) {
    EXPECT_EQ(unnamed(words(text)), words(text)) << text;
    EXPECT_EQ(name_markers(words(text)).set, "");
  }
  EXPECT_TRUE(name_markers({}).landmarks.empty());
}

}  // namespace
}  // namespace marey::reconstruct
