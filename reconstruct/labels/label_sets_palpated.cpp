// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sets that are named after palpated places: van Sint Jan's (2007) three letters, as used
// in Qualisys's and OptiTrack's biomechanical sets and the Istituto Rizzoli's (Leardini
// et al. 2007, 2011), the shoulder's of the ISB (Wu et al. 2005), and whole words.
#include <array>

#include "reconstruct/labels/label_sets.h"

namespace marey::reconstruct {
namespace {

using Row = LabelRow;

// clang-format off
constexpr std::array kPalpated{
    Row{"?hdf", "?front_head"}, Row{"?hdb", "?back_head"}, Row{"?ah", "?front_head"},
    Row{"?ph", "?back_head"}, Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"},
    Row{"sgl", "forehead"}, Row{"cv7", "c7"}, Row{"tv2", "t2"}, Row{"tv4", "t4"},
    Row{"tv5", "t4"}, Row{"tv6", "t6"}, Row{"tv7", "t6"}, Row{"tv8", "t8"},
    Row{"tv10", "t10"}, Row{"tv12", "t12"}, Row{"mai", "t8"}, Row{"lv1", "l1"},
    Row{"lv3", "l3"}, Row{"lv5", "l5"}, Row{"sjn", "suprasternal_notch"},
    Row{"snj", "suprasternal_notch"}, Row{"ij", "suprasternal_notch"},
    Row{"sxs", "xiphoid"}, Row{"px", "xiphoid"}, Row{"clav", "suprasternal_notch"},
    Row{"strn", "xiphoid"}, Row{"?caj", "?acromion"}, Row{"?saj", "?acromion"},
    Row{"?sae", "?acromion"}, Row{"?ac", "?acromion"}, Row{"?scap", "?scapula"},
    Row{"?saa", "?acromial_angle"}, Row{"?sia", "?inferior_scapular_angle"},
    Row{"?srs", "?scapular_spine_root"}, Row{"?scp", "?coracoid"},
    Row{"?hgt", "?shoulder"}, Row{"?ua", "?upper_arm"}, Row{"?ua1", "?upper_arm"},
    Row{"?ua2", "?upper_arm"}, Row{"?ua3", "?upper_arm"},
    Row{"?hle", "?lateral_epicondyle_humerus"}, Row{"?hme", "?medial_epicondyle_humerus"},
    Row{"?uoa", "?olecranon"}, Row{"?f1", "?forearm"}, Row{"?f2", "?forearm"},
    Row{"?fa", "?forearm"}, Row{"?rsp", "?radial_styloid"}, Row{"?usp", "?ulnar_styloid"},
    Row{"?uhe", "?ulnar_styloid"}, Row{"?hm1", "?metacarpal_2_head"},
    Row{"?hm2", "?metacarpal_2_head"}, Row{"?hm3", "?metacarpal_3_head"},
    Row{"?hm5", "?metacarpal_5_head"}, Row{"?hl5", "?metacarpal_5_head"},
    Row{"?wand1", ""}, Row{"?wand2", ""}, Row{"?wand3", ""}, Row{"?wand4", ""},
    Row{"?ias", "?asis"}, Row{"?ips", "?psis"}, Row{"?iasis", "?asis"},
    Row{"?ict", "?iliac_crest"}, Row{"?ftc", "?greater_trochanter"}, Row{"?th", "?thigh"},
    Row{"?th1", "?thigh"}, Row{"?th2", "?thigh"}, Row{"?th3", "?thigh"},
    Row{"?th4", "?thigh"}, Row{"?fap", "?patella"}, Row{"?pax", "?patella"},
    Row{"?fle", "?lateral_epicondyle_femur"}, Row{"?fme", "?medial_epicondyle_femur"},
    Row{"?fax", "?fibula_head"}, Row{"?ttc", "?tibial_tuberosity"},
    Row{"?tlc", "?lateral_tibial_condyle"}, Row{"?tmc", "?medial_tibial_condyle"},
    Row{"?sk", "?shank"}, Row{"?sk1", "?shank"}, Row{"?sk2", "?shank"},
    Row{"?sk3", "?shank"}, Row{"?sk4", "?shank"}, Row{"?fal", "?lateral_malleolus"},
    Row{"?tam", "?medial_malleolus"}, Row{"?fcc", "?heel"},
    Row{"?fst", "?medial_calcaneus"}, Row{"?fpt", "?lateral_calcaneus"},
    Row{"?fnt", "?navicular"}, Row{"?ftn", "?navicular"},
    Row{"?fmt", "?metatarsal_5_base"}, Row{"?fm1", "?metatarsal_1_head"},
    Row{"?fm2", "?metatarsal_2_head"}, Row{"?fm3", "?metatarsal_3_head"},
    Row{"?fm5", "?metatarsal_5_head"}, Row{"?fmt1", "?metatarsal_1_head"},
    Row{"?fmt2", "?metatarsal_2_head"}, Row{"?fmt5", "?metatarsal_5_head"},
    Row{"?dp1", "?big_toe"}, Row{"?fhx", "?big_toe"},
};

constexpr std::array kBmcLab{
    Row{"?asis", "?asis"}, Row{"?psis", "?psis"}, Row{"?iliaccrest", "?iliac_crest"},
    Row{"?gtr", "?greater_trochanter"}, Row{"?knee", "?lateral_epicondyle_femur"},
    Row{"?kneemedial", "?medial_epicondyle_femur"}, Row{"?hf", "?fibula_head"},
    Row{"?tt", "?tibial_tuberosity"}, Row{"?ankle", "?lateral_malleolus"},
    Row{"?anklemedial", "?medial_malleolus"}, Row{"?heel", "?heel"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt2", "?metatarsal_2_head"},
    Row{"?mt5", "?metatarsal_5_head"},
};

/// Visual3D's examples.
constexpr std::array kVisual3D{
    Row{"?asis", "?asis"}, Row{"?psis", "?psis"}, Row{"?ias", "?asis"},
    Row{"?ips", "?psis"}, Row{"?ic", "?iliac_crest"}, Row{"?gt", "?greater_trochanter"},
    Row{"?lk", "?lateral_epicondyle_femur"}, Row{"?mk", "?medial_epicondyle_femur"},
    Row{"?la", "?lateral_malleolus"}, Row{"?ma", "?medial_malleolus"},
    Row{"?he", "?heel"}, Row{"?heel", "?heel"}, Row{"?mh1", "?metatarsal_1_head"},
    Row{"?mh2", "?metatarsal_2_head"}, Row{"?mh5", "?metatarsal_5_head"},
    Row{"?th1", "?thigh"}, Row{"?th2", "?thigh"}, Row{"?th3", "?thigh"},
    Row{"?th4", "?thigh"}, Row{"?sk1", "?shank"}, Row{"?sk2", "?shank"},
    Row{"?sk3", "?shank"}, Row{"?sk4", "?shank"}, Row{"?sh1", "?shank"},
    Row{"?sh2", "?shank"}, Row{"?sh3", "?shank"}, Row{"?sh4", "?shank"},
    Row{"?ft1", "?foot"}, Row{"?ft2", "?foot"}, Row{"?ft3", "?foot"},
};

/// Clusters of plates alone.
constexpr std::array kClusters{
    Row{"pv1", "hips"}, Row{"pv2", "hips"}, Row{"pv3", "hips"}, Row{"pv4", "hips"},
    Row{"?th1", "?thigh"}, Row{"?th2", "?thigh"}, Row{"?th3", "?thigh"},
    Row{"?th4", "?thigh"}, Row{"?sk1", "?shank"}, Row{"?sk2", "?shank"},
    Row{"?sk3", "?shank"}, Row{"?sk4", "?shank"}, Row{"?ft1", "?foot"},
    Row{"?ft2", "?foot"}, Row{"?ft3", "?foot"}, Row{"?ft4", "?foot"},
};

/// Words, whole or abbreviated, with the same meaning in all sources.
constexpr std::array kWords{
    Row{"sternalnotch", "suprasternal_notch"}, Row{"jugularnotch", "suprasternal_notch"},
    Row{"manubrium", "suprasternal_notch"}, Row{"sternum", "sternum"},
    Row{"ster", "sternum"}, Row{"xiph", "xiphoid"}, Row{"xiphoid", "xiphoid"},
    Row{"t2", "t2"}, Row{"t4", "t4"}, Row{"t6", "t6"}, Row{"t8", "t8"}, Row{"t10", "t10"},
    Row{"t12", "t12"}, Row{"th12", "t12"}, Row{"l1", "l1"}, Row{"l3", "l3"},
    Row{"l5", "l5"}, Row{"c7", "c7"}, Row{"sacrum", "sacrum"}, Row{"sacral", "sacrum"},
    Row{"sacr", "sacrum"}, Row{"s1", "sacrum"}, Row{"s2", "sacrum"},
    Row{"tophead", "head_top"}, Row{"headtop", "head_top"}, Row{"forehead", "forehead"},
    Row{"?ear", "?ear"}, Row{"?clavicle", "?clavicle"}, Row{"?acromion", "?acromion"},
    Row{"?acromium", "?acromion"}, Row{"?acr", "?acromion"},
    Row{"?shoulder", "?acromion"}, Row{"?scapula", "?scapula"},
    Row{"?elbow", "?lateral_epicondyle_humerus"},
    Row{"?elbowlat", "?lateral_epicondyle_humerus"},
    Row{"?elbowlateral", "?lateral_epicondyle_humerus"},
    Row{"?elbowmed", "?medial_epicondyle_humerus"},
    Row{"?elbowmedial", "?medial_epicondyle_humerus"}, Row{"?olecranon", "?olecranon"},
    Row{"?wrist", "?wrist"}, Row{"?wristradius", "?radial_styloid"},
    Row{"?wristulna", "?ulnar_styloid"}, Row{"?wristrad", "?radial_styloid"},
    Row{"?wristuln", "?ulnar_styloid"}, Row{"?wristlat", "?radial_styloid"},
    Row{"?wristmed", "?ulnar_styloid"}, Row{"?asis", "?asis"}, Row{"?psis", "?psis"},
    Row{"?iliac", "?iliac_crest"}, Row{"?iliaccrest", "?iliac_crest"},
    Row{"?ic", "?iliac_crest"}, Row{"?ilcrest", "?iliac_crest"},
    Row{"?troch", "?greater_trochanter"}, Row{"?trochanter", "?greater_trochanter"},
    Row{"?gtroch", "?greater_trochanter"},
    Row{"?greatertrochanter", "?greater_trochanter"}, Row{"?gt", "?greater_trochanter"},
    Row{"?gtr", "?greater_trochanter"}, Row{"?suppat", "?suprapatella"},
    Row{"?patella", "?patella"}, Row{"?knee", "?lateral_epicondyle_femur"},
    Row{"?kneelat", "?lateral_epicondyle_femur"},
    Row{"?kneelateral", "?lateral_epicondyle_femur"},
    Row{"?kneemed", "?medial_epicondyle_femur"},
    Row{"?kneemedial", "?medial_epicondyle_femur"},
    Row{"?latknee", "?lateral_epicondyle_femur"},
    Row{"?medknee", "?medial_epicondyle_femur"},
    Row{"?lknee", "?lateral_epicondyle_femur"}, Row{"?mknee", "?medial_epicondyle_femur"},
    Row{"?knjntln", "?lateral_tibial_condyle"}, Row{"?fibhead", "?fibula_head"},
    Row{"?hf", "?fibula_head"}, Row{"?tubtib", "?tibial_tuberosity"},
    Row{"?tt", "?tibial_tuberosity"}, Row{"?tibtub", "?tibial_tuberosity"},
    Row{"?ankle", "?lateral_malleolus"}, Row{"?anklelat", "?lateral_malleolus"},
    Row{"?anklelateral", "?lateral_malleolus"}, Row{"?anklemed", "?medial_malleolus"},
    Row{"?anklemedial", "?medial_malleolus"}, Row{"?latankle", "?lateral_malleolus"},
    Row{"?medankle", "?medial_malleolus"}, Row{"?mankle", "?medial_malleolus"},
    Row{"?latmal", "?lateral_malleolus"}, Row{"?medmal", "?medial_malleolus"},
    Row{"?heel", "?heel"}, Row{"?calc", "?heel"}, Row{"?calcaneus", "?heel"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt2", "?metatarsal_2_head"},
    Row{"?mt3", "?metatarsal_3_head"}, Row{"?mt5", "?metatarsal_5_head"},
    Row{"?1meta", "?metatarsal_1_head"}, Row{"?5meta", "?metatarsal_5_head"},
    Row{"?toe", "?metatarsal_2_head"}, Row{"?bigtoe", "?big_toe"},
    Row{"?hallux", "?big_toe"}, Row{"?toetip", "?toe_tip"},
    Row{"?navicular", "?navicular"},
};

constexpr std::array kPalpatedSets{
    LabelSet{"anatomical (van Sint Jan)", kPalpated}, LabelSet{"BMC lab", kBmcLab},
    LabelSet{"Visual3D", kVisual3D, true}, LabelSet{"clusters", kClusters},
    LabelSet{"", kWords},
};
// clang-format on

}  // namespace

std::span<const LabelSet> palpated_label_sets() {
  return kPalpatedSets;
}

}  // namespace marey::reconstruct
