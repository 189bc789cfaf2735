// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Labels of files from many laboratories; comments name the files (in
// ../shared/data/mocap). The expected places were verified with the files' markers where
// possible.
#include "reconstruct/labels/label_sets.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/reconstruct/labels/named_labels.h"

namespace marey::reconstruct {
namespace {

using testing::expect_names;
using testing::kPlugInGait;
using testing::unnamed;
using testing::words;

TEST(LabelSets, NameLandmarksThatThereAre) {
  for (const LabelSet& set : label_sets()) {
    for (const LabelRow& row : set.rows) {
      std::string name(row.landmark);
      if (name.starts_with('?')) name = std::string("left_").append(name, 1);
      EXPECT_TRUE(name.empty() || find_landmark(name) != nullptr)
          << set.name << ": " << row.landmark;
      // A place with a side has a label with a side; a label with a side and without such
      // a place is a wand's.
      if (row.landmark.starts_with('?')) {
        EXPECT_NE(row.label.find('?'), std::string_view::npos) << row.label;
      }
    }
  }
}

TEST(LabelSets, HaveEachLabelOnce) {
  for (const LabelSet& set : label_sets()) {
    std::set<std::string_view> labels;
    for (const LabelRow& row : set.rows) {
      EXPECT_TRUE(labels.insert(row.label).second) << set.name << ": " << row.label;
    }
  }
}

TEST(NameMarkers, KnowsPlugInGait) {
  const auto labels = words(kPlugInGait);
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "Plug-in Gait",
               {{"LASI", "left_asis"},
                {"RPSI", "right_psis"},
                {"LTHI", "left_thigh"},
                {"RKNE", "right_lateral_epicondyle_femur"},
                {"LTOE", "left_metatarsal_2_head"},
                {"STRN", "xiphoid"},
                {"RBAK", "right_scapula"},
                {"LWRA", "left_wrist_thumb_side"}});
}

// Both sides of wrists, hands and shoulders: formerly hands had no name, and a shoulder's
// marker was placed on one.
TEST(NameMarkers, KnowsStudiosWithBothSidesOfWristsAndShoulders) {
  const auto labels = words(
      "ARIEL LFHD LBHD RFHD RBHD C7 T8 T10 CLAV STRN LBAC RBAC LSHO RSHO LFSH LBSH "
      "RFSH RBSH LUPA RUPA LELB LIEL RELB RIEL LFRM RFRM LIWR LOWR RIWR ROWR "
      "LIHAND LOHAND RIHAND ROHAND LFWT RFWT LBWT RBWT MBWT LTHI RTHI LKNE LKNI "
      "RKNE RKNI LSHN RSHN LANK RANK LHEL RHEL LMT5 RMT5");
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "ACCAD",
               {{"LIWR", "left_wrist_thumb_side"},
                {"ROWR", "right_wrist_little_finger_side"},
                {"LIHAND", "left_thumb"},
                {"ROHAND", "right_metacarpal_5_head"},
                {"LFSH", "left_shoulder_front"},
                {"RBSH", "right_shoulder_back"},
                {"LIEL", "left_medial_epicondyle_humerus"},
                {"RKNI", "right_medial_epicondyle_femur"},
                {"MBWT", "sacrum"}});
}

TEST(NameMarkers, KnowsTheSurfaceMarkersOfSoma) {
  const auto labels = words(
      "C7 CLAV LANK LFWT LBAK LUPA LBHD LSCAP LBUM LBUST LCHEECK LELB LELBIN LFHD LFIN "
      "LFRM LFTHI LFTHIIN LHEE LWRA LKNE LKNEIN LMT1 LMT5 LNWST LWRB LBWT LRSTBEEF LSHO "
      "LTHI LTHMB LSHIN LTOE MBLLY RANK RFWT RBAK RUPA RBHD RSCAP RBUM RBUST RCHEECK "
      "RELB RELBIN RFHD RFIN RFRM RWRA RFTHI RFTHIIN RHEE RKNE RKNEIN RMT1 RMT5 RNWST "
      "RWRB RBWT RRSTBEEF RSHO RTHI RTHMB RSHIN RTOE STRN T10");
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "SOMA",
               {{"LELBIN", "left_medial_epicondyle_humerus"},
                {"RFIN", "right_metacarpal_5_head"},
                {"LFTHIIN", "left_thigh"},
                {"RRSTBEEF", "right_lateral_midfoot"}});
}

TEST(NameMarkers, KnowsTheHumanBodyModel) {
  const auto labels = words(
      "LASIS RASIS LPSIS RPSIS LGTRO RGTRO LLEK RLEK LLM RLM RTOE LTOE LSHO RSHO "
      "LLEE RLEE LMEE RMEE LLW RLW LMW RMW XYPH C7 THEAD RHEAD LHEAD SACR T10 NAVE "
      "STRN LDELT RDELT RFIN LFIN BBAC FRTHI FLTHI RATI LATI RHEE LHEE RMT5 LMT5 "
      "RFRM LFRM FHEAD");
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "Human Body Model",
               {{"LLEK", "left_lateral_epicondyle_femur"},
                {"RLEE", "right_lateral_epicondyle_humerus"},
                {"RLM", "right_lateral_malleolus"},
                {"FLTHI", "left_thigh"},
                {"LMW", "left_ulnar_styloid"}});
}

// c3d_org_samples/sample_03/gait-pig.c3d and sample_07/16bitanalog.c3d.
TEST(NameMarkers, OmitsPointsThatPlugInGaitComputes) {
  const auto labels = words(
      "RKNE LKNE RTIB LTHI RTHI LTIB LTOE RANK LANK RASI LASI RTOE SACR PELO PELP PELA "
      "PELL LFEO LFEP LTIO LTIA LFOO LFOP LTOO LTOL RFOO RFOA RTOA LKAX LKD1 LKD2 "
      "LHipAngles RKneeForce CentreOfMass LHJC *12");
  EXPECT_EQ(unnamed(labels),
            words("PELO PELP PELA PELL LFEO LFEP LTIO LTIA LFOO LFOP LTOO LTOL RFOO RFOA "
                  "RTOA LKAX LKD1 LKD2 LHipAngles RKneeForce CentreOfMass LHJC *12"));
}

// c3d_org_samples/sample_00/Vicon Motion Systems.
TEST(NameMarkers, KnowsTheClustersOfConventionalGaitModel2) {
  expect_names(
      words("LASI RASI LPSI RPSI LTHI LTHAP LTHAD LKNE LTIB LTIAP LTIAD LANK LHEE "
            "LTOE LFMH LVMH LHJC_CGM_2.4 LFEMUR_CGM_2.4O PELVIS_CGM_2.4A LMED"),
      "Plug-in Gait",
      {{"LTHAP", "left_thigh"},
       {"LTIAD", "left_shank"},
       {"LFMH", "left_metatarsal_1_head"},
       {"LVMH", "left_metatarsal_5_head"},
       {"LMED", "left_medial_malleolus"},
       {"LHJC_CGM_2.4", ""},
       {"LFEMUR_CGM_2.4O", ""},
       {"PELVIS_CGM_2.4A", ""}});
}

// bmclab/Gait.c3d: truncated to four letters; RFOO is the inner of two on the foot.
TEST(NameMarkers, KnowsHelenHayesWithEqualLabels) {
  const auto labels = words(
      "RSHO ROFF RELB RWRI LSHO LELB LWRI RASI LASI VSAC RTHI RKNE RSHA RANK RHEE RTOE "
      "LTHI "
      "LKNE LSHA LANK LHEE LTOE RKNE_2 RANK_2 LKNE_2 LANK_2 RFOO RFOO_2 LFOO LFOO_2 C7 "
      "IJ PX");
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "Helen Hayes",
               {{"VSAC", "sacrum"},
                {"ROFF", "right_scapula"},
                {"RWRI", "right_wrist"},
                {"RKNE", "right_lateral_epicondyle_femur"},
                {"RKNE_2", "right_medial_epicondyle_femur"},
                {"LANK_2", "left_medial_malleolus"},
                {"RFOO", "right_metatarsal_1_head"},
                {"RFOO_2", "right_metatarsal_5_head"},
                {"IJ", "suprasternal_notch"}});
}

// mocaprecovery/135_02.c3d.
TEST(NameMarkers, KnowsCmuBehindASubjectsName) {
  std::vector<std::string> labels;
  for (const std::string& label : words(
           "LFHD RFHD LBHD RBHD C7 T10 CLAV STRN RBAC LSHO LUPA LELB LFRM LWRA LWRB LFIN "
           "RSHO RUPA RELB RFRM RWRA RWRB RFIN LFWT RFWT LBWT RBWT LTHI LKNE LSHN LANK "
           "LHEE "
           "LTOE LMT5 RTHI RKNE RSHN RANK RHEE RTOE RMT5")) {
    labels.push_back("male:" + label);
  }
  EXPECT_TRUE(unnamed(labels).empty());
  EXPECT_EQ(name_markers(labels).prefix, "male:");
  expect_names(labels,
               "CMU",
               {{"male:LFWT", "left_waist_front"},
                {"male:RSHN", "right_shank"},
                {"male:RBAC", "right_scapula"},
                {"male:LMT5", "left_metatarsal_5_head"}});
}

// opensim-models/Rajagopal/ExpData/static_run.trc.
TEST(NameMarkers, KnowsRajagopalsRunning) {
  const auto labels = words(
      "LASI RASI LPSI RPSI RTH2 RTH3 RLFC RMFC LTH1 LLFC LMFC RTB1 RLMAL RMMAL RCAL RTOE "
      "RMT5 "
      "LACR RACR CLAV C7 LASH LPSH RUA1 RLEL RMEL RFAsuperior RFAradius RFAulna RHJC "
      "LSJC REJC");
  EXPECT_EQ(unnamed(labels), words("RHJC LSJC REJC"));
  expect_names(labels,
               "Rajagopal running (OpenSim)",
               {{"RTOE", "right_metatarsal_1_head"},
                {"RLFC", "right_lateral_epicondyle_femur"},
                {"LMFC", "left_medial_epicondyle_femur"},
                {"RLMAL", "right_lateral_malleolus"},
                {"RLEL", "right_lateral_epicondyle_humerus"},
                {"RFAulna", "right_ulnar_styloid"},
                {"LASH", "left_shoulder_front"},
                {"RTB1", "right_shank"}});
}

// opensim-models/Rajagopal/ExpData/static_walk_1.trc.
TEST(NameMarkers, KnowsRajagopalsWalkingWithoutItsComputedPoints) {
  const auto labels = words(
      "R.Shoulder L.Shoulder R.Clavicle R.Biceps R.Elbow R.MElbow R.Forearm R.Wrist "
      "R.ASIS "
      "L.ASIS R.PSIS S2 R.TH1 R.Knee R.MKnee R.SH1 R.Ankle R.MAnkle R.Heel R.MT5 R.Toe "
      "R_HJC "
      "L.HeelGround L.AnkleJoint R.AnkleJointGround MidASIS MidClavicle");
  EXPECT_EQ(
      unnamed(labels),
      words("R_HJC L.HeelGround L.AnkleJoint R.AnkleJointGround MidASIS MidClavicle"));
  expect_names(labels,
               "Rajagopal walking (OpenSim)",
               {{"R.Shoulder", "right_acromion"},
                {"S2", "sacrum"},
                {"R.SH1", "right_shank"},
                {"R.Toe", "right_big_toe"},
                {"R.MElbow", "right_medial_epicondyle_humerus"}});
}

// opensim-models/Hamner/subject02_static.trc.
TEST(NameMarkers, KnowsGait2354) {
  const auto labels = words(
      "R.ASIS L.ASIS V.Sacral R.Thigh.Upper R.Thigh.Front R.Thigh.Rear R.Knee.Lat "
      "R.Knee.Med "
      "R.Shank.Upper R.Ankle.Lat R.Ankle.Med R.Heel R.Midfoot.Sup R.Midfoot.Lat "
      "R.Toe.Tip "
      "Sternum R.Acromium R.Bicep R.Elbow R.Wrist.Med R.Wrist.Lat R.Toe.Lat R.Toe.Med "
      "R.Temple Top.Head");
  EXPECT_TRUE(unnamed(labels).empty());
  expect_names(labels,
               "gait2354 (OpenSim)",
               {{"V.Sacral", "sacrum"},
                {"R.Thigh.Rear", "right_thigh"},
                {"R.Midfoot.Sup", "right_midfoot"},
                {"R.Toe.Tip", "right_toe_tip"},
                {"R.Toe.Med", "right_metatarsal_1_head"},
                {"R.Wrist.Lat", "right_radial_styloid"},
                {"Top.Head", "head_top"}});
}

// nimblephysics/osim/LaiArnoldSubject5/DJ1.trc: r_sh2 is a shank's, R_Sternum an end of a
// clavicle.
TEST(NameMarkers, KnowsLaiAndArnold) {
  const auto labels = words(
      "r_knee r_shank_antsup r_ankle r_calc r_5meta r_toe L_knee r_sh2 L_sh3 r_thigh1 "
      "r.ASIS "
      "r.PSIS C7 R_Shoulder R_Sternum R_humerus R_elbow_med R_elbow_lat R_forearm "
      "R_wrist_radius R_HJC R_HJC_reg r_mknee");
  EXPECT_EQ(unnamed(labels), words("R_HJC R_HJC_reg"));
  expect_names(labels,
               "Lai-Arnold (OpenSim)",
               {{"r_sh2", "right_shank"},
                {"R_Sternum", "right_clavicle"},
                {"r_toe", "right_metatarsal_1_head"},
                {"r_mknee", "right_medial_epicondyle_femur"}});
}

TEST(NameMarkers, KnowsOpenCapsMarkersFromItsKeypoints) {
  const auto labels = words(
      "Neck RShoulder RElbow RWrist midHip RHip RKnee RAnkle LKnee RHeel r.ASIS_study "
      "L.PSIS_study r_knee_study L_mknee_study r_calc_study L_toe_study r_5meta_study "
      "C7_study r_lwrist_study L_thigh2_study RHJC_study r_shoulder_study");
  EXPECT_EQ(unnamed(labels),
            words("Neck RShoulder RElbow RWrist midHip RHip RKnee RAnkle LKnee RHeel "
                  "RHJC_study"));
  expect_names(labels,
               "OpenCap",
               {{"r.ASIS_study", "right_asis"},
                {"L_mknee_study", "left_medial_epicondyle_femur"},
                {"r_lwrist_study", "right_radial_styloid"},
                {"L_thigh2_study", "left_thigh"}});
}

// A knee's keypoint is its centre; Helen Hayes's marker is on its outer side.
TEST(NameMarkers, NamesNoKeypoints) {
  const auto labels = words(
      "Hip RHip RKnee RAnkle RBigToe RSmallToe RHeel LHip LKnee LAnkle LBigToe LSmallToe "
      "LHeel Neck Head Nose RShoulder RElbow RWrist LShoulder LElbow LWrist");
  EXPECT_EQ(unnamed(labels), labels);
  const MarkerNames names = name_markers(labels);
  EXPECT_EQ(names.set, "keypoints");
  ASSERT_EQ(names.notes.size(), 1U);
  EXPECT_EQ(
      names.notes[0],
      "these are the labels of keypoints, which are computed points, not markers on "
      "the body");
}

// ezc3d/Qualisys.c3d.
TEST(NameMarkers, KnowsPalpatedLandmarks) {
  const auto labels = words(
      "L_IAS L_IPS SNJ SXS TV8 CV7 R_SCAP L_HDF L_HDB L_FTC L_WAND1 L_FLE L_FME L_FAX "
      "L_TTC "
      "L_WAND2 L_FAL L_TAM L_FCC L_FM1 L_FM5 L_HM5 L_HM2 L_UHE L_RSP L_HLE L_HME L_SAJ");
  EXPECT_EQ(unnamed(labels), words("L_WAND1 L_WAND2"));
  expect_names(labels,
               "anatomical (van Sint Jan)",
               {{"L_FTC", "left_greater_trochanter"},
                {"L_FAX", "left_fibula_head"},
                {"L_TTC", "left_tibial_tuberosity"},
                {"L_UHE", "left_ulnar_styloid"},
                {"L_SAJ", "left_acromion"},
                {"CV7", "c7"}});
}

// x_ is the only actor's prefix in a recording of Qualisys's animation set.
TEST(NameMarkers, KnowsAnimationSets) {
  const auto labels = words(
      "x_HeadL x_HeadTop x_HeadR x_HeadFront x_LShoulderTop x_LShoulderBack x_LArm "
      "x_LElbowOut "
      "x_LWristOut x_LWristIn x_LHandOut x_LHandIn x_Chest x_SpineTop x_BackL "
      "x_WaistLFront "
      "x_WaistRBack x_LThigh x_LKneeOut x_LShin x_LAnkleOut x_LHeelBack x_LForefootOut "
      "x_LToeTip x_LForefootIn x_LThumbTip");
  EXPECT_EQ(unnamed(labels), words("x_LThumbTip"));
  expect_names(labels,
               "Qualisys animation",
               {{"x_HeadL", "left_side_head"},
                {"x_WaistLFront", "left_waist_front"},
                {"x_WaistRBack", "right_waist_back"},
                {"x_BackL", "left_back"},
                {"x_LWristIn", "left_radial_styloid"},
                {"x_LForefootIn", "left_metatarsal_1_head"}});
}

}  // namespace
}  // namespace marey::reconstruct
