// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "retarget/adapt/plan/adapt_plan.h"

namespace marey::retarget {

/// A unit that the thesis' algorithm rotates as one rigid segment (Kulpa 2005, 4.2.2): a
/// clavicle, neck, head, hand or foot; a section of the spine, whose rotation its
/// vertebrae share; a bone of a limb that is outside the range of a target; the pelvis,
/// for orientations.
struct ThesisTurn {
  std::vector<int> joints;  ///< Joints that share the rotation, low to high.
  std::vector<int> below;   ///< Live joints at or below the first, parents first.
  std::vector<int> points;  ///< Targets that may rotate it, most important first.
  int limb_of_hinge = -1;   ///< For a limb's middle joint: it rotates about one axis.
  int extremity_of = -1;    ///< Limb that ends here: an orientation may be set.
  int support_limb = -1;    ///< Limb of its group: rotates only while this limb is free.
};

/// One step of a group.
struct ThesisStep {
  bool is_limb = false;
  int index = 0;  ///< Position in Plan::limbs or ThesisPlan::turns.
};

struct ThesisGroup {
  std::vector<ThesisStep> steps;
  bool is_trunk = false;  ///< The group has sections; it follows all limbs.
};

/// Groups that contribute to balance, heaviest first (thesis 5.2.2).
struct KineticGroup {
  int rank = 0;   ///< Equal for both arms, and for both legs: they balance together.
  int limb = -1;  ///< Limb, balanced in two steps; -1: one segment.
  std::vector<int> joints;  ///< Joints of the segment, low to high, which share the
                            ///< rotation.
  std::vector<int> below;   ///< Live joints at or below its root, parents first.
  std::vector<int> users;   ///< Targets that rotate it. It does not balance while one of
                            ///< them is active.
  int root = 0;             ///< Joint about which it rotates.
};

/// Order of the thesis' algorithm for a body, derived once from its plan.
struct ThesisPlan {
  std::vector<ThesisTurn> turns;
  /// In the order of kinematic adaptation, without the root (table 4.3).
  std::vector<ThesisGroup> groups;
  std::vector<KineticGroup> balancing;
  std::vector<char> moves_root;  ///< Per target: contributes to the root's translation.
  /// Per limb: targets for the orientation of its upper or lower bone.
  std::vector<std::vector<int>> bone_orientations;
  std::vector<std::vector<int>> supports;  ///< Per limb.
};

/// Builds the order from a plan. Linear in joints times targets.
[[nodiscard]] ThesisPlan make_thesis_plan(const Plan& plan);

}  // namespace marey::retarget
