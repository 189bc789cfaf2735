// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sets of gait laboratories: Davis et al. (1991), Kadaba et al. (1990) and their
// successors.
#include <array>

#include "reconstruct/labels/label_sets.h"

namespace marey::reconstruct {
namespace {

using Row = LabelRow;

// clang-format off
/// Vicon's, with the additions of its Conventional Gait Model 2, of the Oxford Foot
/// Model, and medial markers. Points that the model computes have empty landmarks, as has
/// the device that aligns the knee's axis.
constexpr std::array kPlugInGait{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"c7", "c7"},
    Row{"t10", "t10"}, Row{"clav", "suprasternal_notch"}, Row{"strn", "xiphoid"},
    Row{"?bak", "?scapula"}, Row{"?sho", "?acromion"}, Row{"?upa", "?upper_arm"},
    Row{"?elb", "?lateral_epicondyle_humerus"},
    Row{"?elbm", "?medial_epicondyle_humerus"},
    Row{"?melb", "?medial_epicondyle_humerus"}, Row{"?frm", "?forearm"},
    Row{"?fra", "?forearm"}, Row{"?wra", "?wrist_thumb_side"},
    Row{"?wrb", "?wrist_little_finger_side"}, Row{"?fin", "?metacarpal_2_head"},
    Row{"?ua1", "?upper_arm"}, Row{"?ua2", "?upper_arm"}, Row{"?ua3", "?upper_arm"},
    Row{"?la1", "?forearm"}, Row{"?la2", "?forearm"}, Row{"?la3", "?forearm"},
    Row{"?asi", "?asis"}, Row{"?psi", "?psis"}, Row{"sacr", "sacrum"},
    Row{"?thi", "?thigh"}, Row{"?thi2", "?thigh"}, Row{"?thi3", "?thigh"},
    Row{"?thl", "?thigh"}, Row{"?thap", "?thigh"}, Row{"?thad", "?thigh"},
    Row{"?kne", "?lateral_epicondyle_femur"}, Row{"?knm", "?medial_epicondyle_femur"},
    Row{"?kmed", "?medial_epicondyle_femur"}, Row{"?knem", "?medial_epicondyle_femur"},
    Row{"?mkn", "?medial_epicondyle_femur"}, Row{"?mkne", "?medial_epicondyle_femur"},
    Row{"?kneem", "?medial_epicondyle_femur"}, Row{"?knemed", "?medial_epicondyle_femur"},
    Row{"?kd1", ""}, Row{"?kd2", ""}, Row{"?kax", ""}, Row{"?tib", "?shank"},
    Row{"?tib2", "?shank"}, Row{"?tib3", "?shank"}, Row{"?tibl", "?shank"},
    Row{"?tiap", "?shank"}, Row{"?tiad", "?shank"}, Row{"?ank", "?lateral_malleolus"},
    Row{"?anm", "?medial_malleolus"}, Row{"?med", "?medial_malleolus"},
    Row{"?mak", "?medial_malleolus"}, Row{"?amed", "?medial_malleolus"},
    Row{"?mank", "?medial_malleolus"}, Row{"?ankm", "?medial_malleolus"},
    Row{"?ankmed", "?medial_malleolus"}, Row{"?hee", "?heel"},
    Row{"?toe", "?metatarsal_2_head"}, Row{"?mt5", "?metatarsal_5_head"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?fmh", "?metatarsal_1_head"},
    Row{"?smh", "?metatarsal_2_head"}, Row{"?vmh", "?metatarsal_5_head"},
    Row{"?latfoot", "?lateral_midfoot"}, Row{"?hlx", "?big_toe"},
    Row{"?hfb", "?fibula_head"}, Row{"?tub", "?tibial_tuberosity"},
    Row{"?mma", "?medial_malleolus"}, Row{"?cpg", ""}, Row{"?lca", "?lateral_calcaneus"},
    Row{"?stl", "?medial_calcaneus"}, Row{"?p5m", "?metatarsal_5_base"},
    Row{"?d5m", "?metatarsal_5_head"}, Row{"?p1m", "?metatarsal_1_base"},
    Row{"?d1m", "?metatarsal_1_head"}, Row{"pelvis1", "hips"}, Row{"pelvis2", "hips"},
    Row{"pelvis3", "hips"}, Row{"pel%", ""}, Row{"?fe%", ""}, Row{"?ti%", ""},
    Row{"?fo%", ""}, Row{"?to%", ""}, Row{"?cl%", ""}, Row{"?hu%", ""}, Row{"?ra%", ""},
    Row{"?hn%", ""}, Row{"he%", ""}, Row{"hed%", ""}, Row{"trx%", ""},
};

/// The CMU Graphics Lab's database, recorded with Vicon 8.
constexpr std::array kCmu{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"ariel", "head_top"},
    Row{"c7", "c7"}, Row{"t10", "t10"}, Row{"clav", "suprasternal_notch"},
    Row{"strn", "xiphoid"}, Row{"?bac", "?scapula"}, Row{"?sho", "?acromion"},
    Row{"?upa", "?upper_arm"}, Row{"?elb", "?lateral_epicondyle_humerus"},
    Row{"?ieb", "?medial_epicondyle_humerus"}, Row{"?iel", "?medial_epicondyle_humerus"},
    Row{"?ani", "?medial_malleolus"}, Row{"mbwt", "sacrum"}, Row{"mfwt", "hips"},
    Row{"?frm", "?forearm"}, Row{"?wra", "?wrist_thumb_side"},
    Row{"?wrb", "?wrist_little_finger_side"}, Row{"?fin", "?metacarpal_2_head"},
    Row{"?thmb", "?thumb"}, Row{"?thm", "?thumb"}, Row{"?fwt", "?waist_front"},
    Row{"?bwt", "?waist_back"}, Row{"?thi", "?thigh"},
    Row{"?kne", "?lateral_epicondyle_femur"}, Row{"?kni", "?medial_epicondyle_femur"},
    Row{"?shn", "?shank"}, Row{"?ank", "?lateral_malleolus"}, Row{"?hel", "?heel"},
    Row{"?hee", "?heel"}, Row{"?toe", "?metatarsal_2_head"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt5", "?metatarsal_5_head"},
};

/// Motion Analysis's, of Cleveland Clinic and Helen Hayes Hospital; often truncated to
/// four letters, which makes pairs of equal labels: the second one is the inner one.
constexpr std::array kHelenHayes{
    Row{"thea", "head_top"}, Row{"fhea", "forehead"}, Row{"rhea", "occiput"},
    Row{"tophead", "head_top"}, Row{"fronthead", "forehead"}, Row{"rearhead", "occiput"},
    Row{"?off", "?scapula"}, Row{"?offset", "?scapula"}, Row{"?scapula", "?scapula"},
    Row{"c7", "c7"}, Row{"ij", "suprasternal_notch"}, Row{"px", "xiphoid"},
    Row{"?sho", "?acromion"}, Row{"?shoulder", "?acromion"},
    Row{"?elb", "?lateral_epicondyle_humerus"},
    Row{"?elbow", "?lateral_epicondyle_humerus"}, Row{"?wri", "?wrist"},
    Row{"?wrist", "?wrist"}, Row{"?asi", "?asis"}, Row{"?asis", "?asis"},
    Row{"vsac", "sacrum"}, Row{"vsacral", "sacrum"}, Row{"vsacrum", "sacrum"},
    Row{"?thi", "?thigh"}, Row{"?thigh", "?thigh"}, Row{"?sha", "?shank"},
    Row{"?shank", "?shank"}, Row{"?kne", "?lateral_epicondyle_femur"},
    Row{"?knee", "?lateral_epicondyle_femur"}, Row{"?kne2", "?medial_epicondyle_femur"},
    Row{"?kneemedial", "?medial_epicondyle_femur"}, Row{"?ank", "?lateral_malleolus"},
    Row{"?ankle", "?lateral_malleolus"}, Row{"?ank2", "?medial_malleolus"},
    Row{"?anklemedial", "?medial_malleolus"}, Row{"?hee", "?heel"}, Row{"?heel", "?heel"},
    Row{"?toe", "?metatarsal_2_head"}, Row{"?to", "?metatarsal_2_head"},
    Row{"?foo", "?metatarsal_1_head"}, Row{"?foo2", "?metatarsal_5_head"},
    Row{"?footmed", "?metatarsal_1_head"}, Row{"?footlat", "?metatarsal_5_head"},
    Row{"vmid", ""}, Row{"vpel", ""}, Row{"v?hi", ""}, Row{"v?kn", ""}, Row{"v?an", ""},
    Row{"v?ha", ""}, Row{"v?to", ""}, Row{"v?he", ""},
};

/// Innovative Sports Training's.
constexpr std::array kMotionMonitor{
    Row{"?off", "?scapula"}, Row{"?asi", "?asis"}, Row{"?psi", "?psis"},
    Row{"vsac", "sacrum"}, Row{"?grt", "?greater_trochanter"}, Row{"?thi", "?thigh"},
    Row{"?lfc", "?lateral_epicondyle_femur"}, Row{"?mfc", "?medial_epicondyle_femur"},
    Row{"?ttb", "?tibial_tuberosity"}, Row{"?sha", "?shank"},
    Row{"?lma", "?lateral_malleolus"}, Row{"?mma", "?medial_malleolus"},
    Row{"?pm1", "?metatarsal_1_base"}, Row{"?cal", "?heel"},
    Row{"?toe", "?metatarsal_2_head"}, Row{"?dft", "?toe_tip"},
};

/// Charnwood Dynamics's, with wands: the spines' markers are on a frame around the
/// pelvis.
constexpr std::array kCodamotion{
    Row{"?sacwand", ""}, Row{"?psis", "hips"}, Row{"?asis", "hips"},
    Row{"?hip", "?greater_trochanter"}, Row{"?postfem", "?thigh"},
    Row{"?antfem", "?thigh"}, Row{"?posttib", "?shank"}, Row{"?anttib", "?shank"},
    Row{"?knee", "?lateral_epicondyle_femur"}, Row{"?ankle", "?lateral_malleolus"},
    Row{"?heel", "?heel"}, Row{"?toe", "?metatarsal_5_head"},
};

constexpr std::array kGaitSets{
    LabelSet{"Plug-in Gait", kPlugInGait}, LabelSet{"CMU", kCmu},
    LabelSet{"Helen Hayes", kHelenHayes}, LabelSet{"The MotionMonitor", kMotionMonitor},
    LabelSet{"Codamotion gait", kCodamotion, true},
};
// clang-format on

}  // namespace

std::span<const LabelSet> gait_label_sets() {
  return kGaitSets;
}

}  // namespace marey::reconstruct
