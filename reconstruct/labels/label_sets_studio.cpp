// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sets of motion capture studios and of the databases that collect their recordings. "In"
// and "i" mean the thumb's side of a wrist or a hand, and the medial side at elbows,
// knees and ankles; "out" and "o" the other side.
#include <array>

#include "reconstruct/labels/label_sets.h"

namespace marey::reconstruct {
namespace {

using Row = LabelRow;

// clang-format off
/// ACCAD and later studios: CMU's set with both sides of the shoulders, elbows, wrists,
/// hands and knees.
constexpr std::array kStudio{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"ariel", "head_top"},
    Row{"c7", "c7"}, Row{"t8", "t8"}, Row{"t10", "t10"},
    Row{"clav", "suprasternal_notch"}, Row{"strn", "xiphoid"}, Row{"?bac", "?scapula"},
    Row{"?bak", "?scapula"}, Row{"?sho", "?acromion"}, Row{"?fsh", "?shoulder_front"},
    Row{"?fsho", "?shoulder_front"}, Row{"?bsh", "?shoulder_back"},
    Row{"?bsho", "?shoulder_back"}, Row{"?upa", "?upper_arm"},
    Row{"?elb", "?lateral_epicondyle_humerus"},
    Row{"?oel", "?lateral_epicondyle_humerus"}, Row{"?iel", "?medial_epicondyle_humerus"},
    Row{"?ieb", "?medial_epicondyle_humerus"}, Row{"?ilb", "?medial_epicondyle_humerus"},
    Row{"?frm", "?forearm"}, Row{"?fra", "?forearm"},
    Row{"?iwr", "?wrist_thumb_side"}, Row{"?owr", "?wrist_little_finger_side"},
    Row{"?ihand", "?thumb"}, Row{"?ohand", "?metacarpal_5_head"},
    Row{"?ihnd", "?thumb"}, Row{"?ohnd", "?metacarpal_5_head"},
    Row{"?fin", "?metacarpal_2_head"}, Row{"?thmb", "?thumb"}, Row{"?thm", "?thumb"},
    Row{"?fwt", "?waist_front"}, Row{"?bwt", "?waist_back"}, Row{"mbwt", "sacrum"},
    Row{"mfwt", "hips"}, Row{"?thi", "?thigh"}, Row{"?kne", "?lateral_epicondyle_femur"},
    Row{"?okne", "?lateral_epicondyle_femur"}, Row{"?kni", "?medial_epicondyle_femur"},
    Row{"?ikne", "?medial_epicondyle_femur"}, Row{"?shn", "?shank"},
    Row{"?ank", "?lateral_malleolus"}, Row{"?oank", "?lateral_malleolus"},
    Row{"?ani", "?medial_malleolus"}, Row{"?anki", "?medial_malleolus"},
    Row{"?iank", "?medial_malleolus"}, Row{"?hel", "?heel"}, Row{"?hee", "?heel"},
    Row{"?toe", "?metatarsal_2_head"}, Row{"?mt1", "?metatarsal_1_head"},
    Row{"?mt5", "?metatarsal_5_head"},
};

/// MoSh and SOMA, whose labels name the soft tissue as well.
constexpr std::array kSurface{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"fhead", "forehead"},
    Row{"bhead", "occiput"}, Row{"?cheeck", "head"}, Row{"chin", "head"},
    Row{"c7", "c7"}, Row{"t8", "t8"}, Row{"t10", "t10"},
    Row{"clav", "suprasternal_notch"}, Row{"strn", "xiphoid"}, Row{"?bak", "?scapula"},
    Row{"?scap", "?back"}, Row{"?bust", "upper_chest"}, Row{"?bustlo", "chest"},
    Row{"mblly", "navel"}, Row{"?sho", "?acromion"}, Row{"?upa", "?upper_arm"},
    Row{"?bcep", "?upper_arm"}, Row{"?elb", "?lateral_epicondyle_humerus"},
    Row{"?elbin", "?medial_epicondyle_humerus"}, Row{"?frm", "?forearm"},
    Row{"?frmin", "?forearm"}, Row{"?wra", "?wrist_thumb_side"},
    Row{"?wrb", "?wrist_little_finger_side"}, Row{"?thmb", "?thumb"},
    Row{"?fin", "?metacarpal_5_head"}, Row{"?fwt", "?waist_front"},
    Row{"?bwt", "?waist_back"}, Row{"?bum", "hips"}, Row{"?nwst", "spine"},
    Row{"?thi", "?thigh"}, Row{"?fthi", "?thigh"}, Row{"?fthiin", "?thigh"},
    Row{"?bthi", "?thigh"}, Row{"?thilo", "?thigh"},
    Row{"?kne", "?lateral_epicondyle_femur"}, Row{"?knein", "?medial_epicondyle_femur"},
    Row{"?kni", "?medial_epicondyle_femur"}, Row{"?shin", "?shank"},
    Row{"?shn", "?shank"}, Row{"?shnin", "?shank"}, Row{"?clf", "?shank"},
    Row{"?ank", "?lateral_malleolus"}, Row{"?ankin", "?medial_malleolus"},
    Row{"?hee", "?heel"}, Row{"?toe", "?metatarsal_2_head"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt5", "?metatarsal_5_head"},
    Row{"?rstbeef", "?lateral_midfoot"},
};

/// Words for the places of a suit, as used by several studios.
constexpr std::array kSuitWords{
    Row{"headtop", "head_top"}, Row{"topback", "c7"}, Row{"neckbase", "c7"},
    Row{"midback", "t8"}, Row{"loback", "t10"}, Row{"upthrx", "suprasternal_notch"},
    Row{"lothrx", "xiphoid"}, Row{"chest", "sternum"}, Row{"sternum", "sternum"},
    Row{"?ear", "?ear"}, Row{"?upback", "?back"}, Row{"?midback", "?scapula"},
    Row{"?shoulder", "?acromion"}, Row{"?fshoulder", "?shoulder_front"},
    Row{"?bshoulder", "?shoulder_back"}, Row{"?bicep", "?upper_arm"},
    Row{"?tricep", "?upper_arm"}, Row{"?elbow", "?lateral_epicondyle_humerus"},
    Row{"?outelbow", "?lateral_epicondyle_humerus"},
    Row{"?inelbow", "?medial_epicondyle_humerus"}, Row{"?forearm", "?forearm"},
    Row{"?inwrist", "?wrist_thumb_side"}, Row{"?outwrist", "?wrist_little_finger_side"},
    Row{"?thumb", "?thumb"}, Row{"?pinky", "?metacarpal_5_head"},
    Row{"?inhand", "?thumb"}, Row{"?outhand", "?metacarpal_5_head"},
    Row{"?fwaist", "?waist_front"}, Row{"?bwaist", "?waist_back"}, Row{"?ham", "?thigh"},
    Row{"?thigh", "?thigh"}, Row{"?knee", "?lateral_epicondyle_femur"},
    Row{"?outknee", "?lateral_epicondyle_femur"},
    Row{"?inknee", "?medial_epicondyle_femur"}, Row{"?shin", "?shank"},
    Row{"?calf", "?shank"}, Row{"?ankle", "?lateral_malleolus"},
    Row{"?outankle", "?lateral_malleolus"}, Row{"?inankle", "?medial_malleolus"},
    Row{"?heel", "?heel"}, Row{"?bigtoe", "?metatarsal_1_head"},
    Row{"?pinkytoe", "?metatarsal_5_head"}, Row{"?toetip", "?toe_tip"},
};

/// The Human Body Model (van den Bogert et al. 2013).
constexpr std::array kHumanBodyModel{
    Row{"thead", "head_top"}, Row{"fhead", "forehead"}, Row{"?head", "?side_head"},
    Row{"c7", "c7"}, Row{"t10", "t10"}, Row{"bbac", "upper_chest"}, Row{"strn", "sternum"},
    Row{"jn", "suprasternal_notch"}, Row{"xyph", "xiphoid"}, Row{"xiph", "xiphoid"},
    Row{"nave", "navel"}, Row{"sacr", "sacrum"}, Row{"?asis", "?asis"},
    Row{"?psis", "?psis"}, Row{"?gtro", "?greater_trochanter"}, Row{"?sho", "?acromion"},
    Row{"?delt", "?upper_arm"}, Row{"?lee", "?lateral_epicondyle_humerus"},
    Row{"?mee", "?medial_epicondyle_humerus"}, Row{"?frm", "?forearm"},
    Row{"?lw", "?radial_styloid"}, Row{"?mw", "?ulnar_styloid"},
    Row{"?fin", "?metacarpal_3_head"}, Row{"flthi", "left_thigh"},
    Row{"frthi", "right_thigh"}, Row{"?thi", "?thigh"},
    Row{"?lek", "?lateral_epicondyle_femur"}, Row{"rlke", "right_lateral_epicondyle_femur"},
    Row{"llke", "left_lateral_epicondyle_femur"},
    Row{"?mek", "?medial_epicondyle_femur"}, Row{"?ati", "?shank"},
    Row{"?lm", "?lateral_malleolus"}, Row{"?mm", "?medial_malleolus"},
    Row{"?hee", "?heel"}, Row{"?toe", "?metatarsal_2_head"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt5", "?metatarsal_5_head"},
};

constexpr std::array kStudioSets{
    LabelSet{"ACCAD", kStudio}, LabelSet{"SOMA", kSurface, true},
    LabelSet{"suit in words", kSuitWords, true},
    LabelSet{"Human Body Model", kHumanBodyModel, true},
};
// clang-format on

}  // namespace

std::span<const LabelSet> studio_label_sets() {
  return kStudioSets;
}

}  // namespace marey::reconstruct
