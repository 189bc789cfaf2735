// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sets for animation, whose words name the places of markers on a suit. The inner side is
// the thumb's on a wrist, and the big toe's on a foot.
#include <array>

#include "reconstruct/labels/label_sets.h"

namespace marey::reconstruct {
namespace {

using Row = LabelRow;

// clang-format off
constexpr std::array kQualisys{
    Row{"head?", "?side_head"}, Row{"headtop", "head_top"}, Row{"headfront", "forehead"},
    Row{"headback", "occiput"}, Row{"?shouldertop", "?acromion"},
    Row{"?shoulderback", "?shoulder_back"}, Row{"?arm", "?upper_arm"},
    Row{"?elbowout", "?lateral_epicondyle_humerus"},
    Row{"?elbowin", "?medial_epicondyle_humerus"}, Row{"?elbowback", "?olecranon"},
    Row{"?wristin", "?radial_styloid"}, Row{"?wristout", "?ulnar_styloid"},
    Row{"?handin", "?metacarpal_2_head"}, Row{"?handout", "?metacarpal_5_head"},
    Row{"?hand2", "?metacarpal_2_head"}, Row{"?hand5", "?metacarpal_5_head"},
    Row{"chest", "sternum"}, Row{"spinetop", "c7"}, Row{"back?", "?back"},
    Row{"spinethoracic2", "t2"}, Row{"spinethoracic12", "t12"}, Row{"spinelow", "l3"},
    Row{"backtop", "t2"}, Row{"backmiddle", "t8"}, Row{"backlow", "t12"},
    Row{"waist?front", "?waist_front"}, Row{"waist?back", "?waist_back"},
    Row{"waist?", "?waist_side"}, Row{"waistback", "sacrum"}, Row{"?thigh", "?thigh"},
    Row{"?thighfront", "?thigh"}, Row{"?thighfrontlow", "?thigh"},
    Row{"?kneeout", "?lateral_epicondyle_femur"},
    Row{"?kneein", "?medial_epicondyle_femur"}, Row{"?shin", "?shank"},
    Row{"?shinfront", "?shank"}, Row{"?shinfronthigh", "?shank"},
    Row{"?ankleout", "?lateral_malleolus"}, Row{"?anklein", "?medial_malleolus"},
    Row{"?heelback", "?heel"}, Row{"?heel", "?heel"},
    Row{"?forefootin", "?metatarsal_1_head"}, Row{"?forefootout", "?metatarsal_5_head"},
    Row{"?forefoot2", "?metatarsal_2_head"}, Row{"?forefoot5", "?metatarsal_5_head"},
    Row{"?toetip", "?toe_tip"},
};

constexpr std::array kOptiTrack{
    Row{"headtop", "head_top"}, Row{"headfront", "forehead"}, Row{"headside", "head"},
    Row{"backtop", "c7"}, Row{"chest", "sternum"}, Row{"chesttop", "suprasternal_notch"},
    Row{"chestlow", "xiphoid"}, Row{"back?", "?back"}, Row{"waist?front", "?waist_front"},
    Row{"waist?back", "?waist_back"}, Row{"waistcback", "sacrum"},
    Row{"waistcfront", "hips"}, Row{"?shoulderback", "?shoulder_back"},
    Row{"?shouldertop", "?acromion"}, Row{"?uarmhigh", "?upper_arm"},
    Row{"?uarm", "?upper_arm"}, Row{"?farm", "?forearm"},
    Row{"?elbowout", "?lateral_epicondyle_humerus"},
    Row{"?elbowin", "?medial_epicondyle_humerus"}, Row{"?wristin", "?radial_styloid"},
    Row{"?wristout", "?ulnar_styloid"}, Row{"?handin", "?metacarpal_2_head"},
    Row{"?handout", "?metacarpal_5_head"}, Row{"?thigh", "?thigh"},
    Row{"?thighside", "?thigh"}, Row{"?thighfront", "?thigh"},
    Row{"?kneeout", "?lateral_epicondyle_femur"},
    Row{"?kneein", "?medial_epicondyle_femur"}, Row{"?shin", "?shank"},
    Row{"?shinside", "?shank"}, Row{"?ankleout", "?lateral_malleolus"},
    Row{"?anklein", "?medial_malleolus"}, Row{"?heel", "?heel"},
    Row{"?toein", "?metatarsal_1_head"}, Row{"?toeout", "?metatarsal_5_head"},
    Row{"?toetip", "?toe_tip"},
};

/// The Karlsruhe whole-body motion database.
constexpr std::array kKit{
    Row{"?fhd", "?front_head"}, Row{"?bhd", "?back_head"}, Row{"c7", "c7"},
    Row{"t10", "t10"}, Row{"l3", "l3"}, Row{"clav", "suprasternal_notch"},
    Row{"strn", "xiphoid"}, Row{"?bak", "?scapula"}, Row{"?sho", "?acromion"},
    Row{"?upa", "?upper_arm"}, Row{"?ael", "?lateral_epicondyle_humerus"},
    Row{"?aol", "?olecranon"}, Row{"?fra", "?forearm"}, Row{"?wts", "?radial_styloid"},
    Row{"?wps", "?ulnar_styloid"}, Row{"?hts", "?metacarpal_2_head"},
    Row{"?hps", "?metacarpal_5_head"}, Row{"?asi", "?asis"}, Row{"?psi", "?psis"},
    Row{"?hip", "?greater_trochanter"}, Row{"?thi", "?thigh"},
    Row{"?kne", "?lateral_epicondyle_femur"}, Row{"?tib", "?shank"},
    Row{"?ank", "?lateral_malleolus"}, Row{"?hee", "?heel"},
    Row{"?mt1", "?metatarsal_1_head"}, Row{"?mt5", "?metatarsal_5_head"},
    Row{"?toe", "?metatarsal_2_head"},
};

constexpr std::array kAnimationSets{
    LabelSet{"Qualisys animation", kQualisys, true},
    LabelSet{"OptiTrack", kOptiTrack, true}, LabelSet{"KIT", kKit, true},
};
// clang-format on

}  // namespace

std::span<const LabelSet> animation_label_sets() {
  return kAnimationSets;
}

}  // namespace marey::reconstruct
