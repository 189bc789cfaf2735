// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sets of OpenSim's musculoskeletal models, and of programs that provide input for them.
#include <array>

#include "reconstruct/labels/label_sets.h"

namespace marey::reconstruct {
namespace {

using Row = LabelRow;

// clang-format off
/// Markers of gait2354, gait10dof and Hamner's running.
constexpr std::array kGait2354{
    Row{"tophead", "head_top"}, Row{"?temple", "?side_head"}, Row{"sternum", "sternum"},
    Row{"?acromium", "?acromion"}, Row{"?bicep", "?upper_arm"},
    Row{"?elbow", "?lateral_epicondyle_humerus"}, Row{"?wristmed", "?ulnar_styloid"},
    Row{"?wristlat", "?radial_styloid"}, Row{"?asis", "?asis"}, Row{"vsacral", "sacrum"},
    Row{"?thighupper", "?thigh"}, Row{"?thighfront", "?thigh"},
    Row{"?thighrear", "?thigh"}, Row{"?kneelat", "?lateral_epicondyle_femur"},
    Row{"?kneemed", "?medial_epicondyle_femur"}, Row{"?shankupper", "?shank"},
    Row{"?shankfront", "?shank"}, Row{"?shankrear", "?shank"},
    Row{"?anklelat", "?lateral_malleolus"}, Row{"?anklemed", "?medial_malleolus"},
    Row{"?heel", "?heel"}, Row{"?midfootsup", "?midfoot"},
    Row{"?midfootlat", "?lateral_midfoot"}, Row{"?toelat", "?metatarsal_5_head"},
    Row{"?toemed", "?metatarsal_1_head"}, Row{"?toetip", "?toe_tip"},
};

/// Markers of Rajagopal's full body, running; Stanford's short labels.
constexpr std::array kRajagopal{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"c7", "c7"},
    Row{"t10", "t10"}, Row{"clav", "suprasternal_notch"}, Row{"strn", "xiphoid"},
    Row{"?clav", "?clavicle"}, Row{"?acr", "?acromion"}, Row{"?ash", "?shoulder_front"},
    Row{"?psh", "?shoulder_back"}, Row{"?ua1", "?upper_arm"}, Row{"?ua2", "?upper_arm"},
    Row{"?ua3", "?upper_arm"}, Row{"?lel", "?lateral_epicondyle_humerus"},
    Row{"?mel", "?medial_epicondyle_humerus"}, Row{"?fasuperior", "?forearm"},
    Row{"?faradius", "?radial_styloid"}, Row{"?faulna", "?ulnar_styloid"},
    Row{"?mcp1", "?metacarpal_1_head"}, Row{"?mcp2", "?metacarpal_2_head"},
    Row{"?mcp3", "?metacarpal_3_head"}, Row{"?mcp5", "?metacarpal_5_head"},
    Row{"?asi", "?asis"}, Row{"?psi", "?psis"}, Row{"?th1", "?thigh"},
    Row{"?th2", "?thigh"}, Row{"?th3", "?thigh"}, Row{"?th4", "?thigh"},
    Row{"?lfc", "?lateral_epicondyle_femur"}, Row{"?mfc", "?medial_epicondyle_femur"},
    Row{"?tb1", "?shank"}, Row{"?tb2", "?shank"}, Row{"?tb3", "?shank"},
    Row{"?tb4", "?shank"}, Row{"?lmal", "?lateral_malleolus"},
    Row{"?mmal", "?medial_malleolus"}, Row{"?cal", "?heel"},
    Row{"?toe", "?metatarsal_1_head"}, Row{"?mt1", "?metatarsal_1_head"},
    Row{"?mt2", "?metatarsal_2_head"}, Row{"?mt5", "?metatarsal_5_head"}, Row{"?hjc", ""},
    Row{"?kjc", ""}, Row{"?ajc", ""}, Row{"?sjc", ""}, Row{"?ejc", ""}, Row{"?wjc", ""},
};

/// Markers of Rajagopal's full body, walking.
constexpr std::array kRajagopalWalking{
    Row{"?shoulder", "?acromion"}, Row{"?clavicle", "?clavicle"},
    Row{"?biceps", "?upper_arm"}, Row{"?elbow", "?lateral_epicondyle_humerus"},
    Row{"?melbow", "?medial_epicondyle_humerus"}, Row{"?forearm", "?forearm"},
    Row{"?wrist", "?wrist"}, Row{"?asis", "?asis"}, Row{"?psis", "?psis"},
    Row{"s2", "sacrum"}, Row{"?th1", "?thigh"}, Row{"?th2", "?thigh"},
    Row{"?th3", "?thigh"}, Row{"?th4", "?thigh"},
    Row{"?knee", "?lateral_epicondyle_femur"}, Row{"?mknee", "?medial_epicondyle_femur"},
    Row{"?sh1", "?shank"}, Row{"?sh2", "?shank"}, Row{"?sh3", "?shank"},
    Row{"?sh4", "?shank"}, Row{"?ankle", "?lateral_malleolus"},
    Row{"?mankle", "?medial_malleolus"}, Row{"?heel", "?heel"},
    Row{"?mt5", "?metatarsal_5_head"}, Row{"?toe", "?big_toe"}, Row{"?hjc", ""},
    Row{"?heelground", ""}, Row{"?toeground", ""}, Row{"?mt5ground", ""},
    Row{"?anklejoint", ""}, Row{"?anklejointground", ""}, Row{"?kneejoint", ""},
    Row{"midasis", ""}, Row{"midpsis", ""}, Row{"midclavicle", ""},
};

/// Markers of Lai's and Arnold's models.
constexpr std::array kLaiArnold{
    Row{"c7", "c7"}, Row{"?shoulder", "?acromion"}, Row{"?sternum", "?clavicle"},
    Row{"sternum", "suprasternal_notch"}, Row{"?humerus", "?upper_arm"},
    Row{"?elbowlat", "?lateral_epicondyle_humerus"},
    Row{"?elbowmed", "?medial_epicondyle_humerus"}, Row{"?forearm", "?forearm"},
    Row{"?wristradius", "?radial_styloid"}, Row{"?wristulna", "?ulnar_styloid"},
    Row{"?asis", "?asis"}, Row{"?psis", "?psis"}, Row{"?thigh1", "?thigh"},
    Row{"?thigh2", "?thigh"}, Row{"?thigh3", "?thigh"}, Row{"?thigh4", "?thigh"},
    Row{"?thigh5", "?thigh"}, Row{"?knee", "?lateral_epicondyle_femur"},
    Row{"?mknee", "?medial_epicondyle_femur"}, Row{"?shankantsup", "?shank"},
    Row{"?sh1", "?shank"}, Row{"?sh2", "?shank"}, Row{"?sh3", "?shank"},
    Row{"?sh4", "?shank"}, Row{"?ankle", "?lateral_malleolus"},
    Row{"?mankle", "?medial_malleolus"}, Row{"?calc", "?heel"},
    Row{"?5meta", "?metatarsal_5_head"}, Row{"?toe", "?metatarsal_1_head"},
    Row{"?band", "?foot"}, Row{"?bandshoe", "?foot"}, Row{"?hjc", ""}, Row{"?hjcreg", ""},
};

/// Markers of a runner's model with clusters on thigh and shank.
constexpr std::array kRunning{
    Row{"c7", "c7"}, Row{"?sh", "?acromion"}, Row{"man", "suprasternal_notch"},
    Row{"t7", "t6"}, Row{"?arm", "?upper_arm"},
    Row{"?elb", "?lateral_epicondyle_humerus"}, Row{"?forearm", "?forearm"},
    Row{"?wr", "?wrist"}, Row{"?asi", "?asis"}, Row{"sacr", "sacrum"}, Row{"p1", "hips"},
    Row{"p2", "hips"}, Row{"p3", "hips"}, Row{"?thlp", "?thigh"}, Row{"?thld", "?thigh"},
    Row{"?thap", "?thigh"}, Row{"?thad", "?thigh"},
    Row{"?lepi", "?lateral_epicondyle_femur"}, Row{"?mepi", "?medial_epicondyle_femur"},
    Row{"?pat", "?patella"}, Row{"?tiap", "?shank"}, Row{"?tiad", "?shank"},
    Row{"?tilat", "?shank"}, Row{"?lmal", "?lateral_malleolus"},
    Row{"?mmal", "?medial_malleolus"}, Row{"?heel", "?heel"}, Row{"?mfs", "?midfoot"},
    Row{"?mfl", "?lateral_midfoot"}, Row{"?p1mt", "?metatarsal_1_head"},
    Row{"?p5mt", "?metatarsal_5_head"}, Row{"?toe", "?toe_tip"},
};

/// OpenCap: markers like Lai and Arnold's, computed from keypoints, which are in its
/// files as well.
constexpr std::array kOpenCap{
    Row{"c7study", "c7"}, Row{"?shoulderstudy", "?acromion"}, Row{"?asisstudy", "?asis"},
    Row{"?psisstudy", "?psis"}, Row{"?lelbowstudy", "?lateral_epicondyle_humerus"},
    Row{"?melbowstudy", "?medial_epicondyle_humerus"},
    Row{"?lwriststudy", "?radial_styloid"}, Row{"?mwriststudy", "?ulnar_styloid"},
    Row{"?thigh1study", "?thigh"}, Row{"?thigh2study", "?thigh"},
    Row{"?thigh3study", "?thigh"}, Row{"?thigh4study", "?thigh"},
    Row{"?kneestudy", "?lateral_epicondyle_femur"},
    Row{"?mkneestudy", "?medial_epicondyle_femur"}, Row{"?sh1study", "?shank"},
    Row{"?sh2study", "?shank"}, Row{"?sh3study", "?shank"}, Row{"?sh4study", "?shank"},
    Row{"?anklestudy", "?lateral_malleolus"}, Row{"?manklestudy", "?medial_malleolus"},
    Row{"?calcstudy", "?heel"}, Row{"?5metastudy", "?metatarsal_5_head"},
    Row{"?toestudy", "?metatarsal_1_head"}, Row{"?hjcstudy", ""}, Row{"neck", ""},
    Row{"nose", ""}, Row{"midhip", ""}, Row{"hip", ""}, Row{"?hip", ""}, Row{"?knee", ""},
    Row{"?ankle", ""}, Row{"?shoulder", ""}, Row{"?elbow", ""}, Row{"?wrist", ""},
    Row{"?bigtoe", ""}, Row{"?smalltoe", ""}, Row{"?heel", ""}, Row{"?eye", ""},
    Row{"?ear", ""}, Row{"head", ""},
};

/// Markerless programs (OpenPose's BODY_25, HALPE_26): joint centres.
constexpr std::array kKeypoints{
    Row{"neck", ""}, Row{"nose", ""}, Row{"midhip", ""}, Row{"hip", ""}, Row{"?hip", ""},
    Row{"?knee", ""}, Row{"?ankle", ""}, Row{"?shoulder", ""}, Row{"?elbow", ""},
    Row{"?wrist", ""}, Row{"?bigtoe", ""}, Row{"?smalltoe", ""}, Row{"?heel", ""},
    Row{"?eye", ""}, Row{"?ear", ""}, Row{"head", ""},
};

constexpr std::array kModelsSets{
    LabelSet{"gait2354 (OpenSim)", kGait2354},
    LabelSet{"Rajagopal running (OpenSim)", kRajagopal},
    LabelSet{"Rajagopal walking (OpenSim)", kRajagopalWalking},
    LabelSet{"Lai-Arnold (OpenSim)", kLaiArnold},
    LabelSet{"running with clusters", kRunning, true},
    LabelSet{"keypoints", kKeypoints, true}, LabelSet{"OpenCap", kOpenCap, true},
};
// clang-format on

}  // namespace

std::span<const LabelSet> model_label_sets() {
  return kModelsSets;
}

}  // namespace marey::reconstruct
