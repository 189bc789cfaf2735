// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "retarget/adapt_plan.h"

namespace marey::retarget {

/// What the thesis' algorithm turns as one rigid segment (Kulpa 2005, 4.2.2): a clavicle,
/// neck, head, hand or foot; a section of the spine, whose turn its vertebrae share; a
/// limb's bone whose whole limb is out of a wish's range; the pelvis, for orientations.
struct ThesisTurn {
  std::vector<int> joints;  ///< That share the turn, low to high.
  std::vector<int> below;   ///< Live joints at or below the first, parents first.
  std::vector<int> points;  ///< Wishes that may turn it, most important first.
  int limb_of_hinge = -1;   ///< Of a limb's middle joint: it turns about one axis.
  int extremity_of = -1;    ///< The limb that ends here: an orientation may be set.
  int support_limb = -1;    ///< The limb of its group: turned only while that is free.
};

/// One step through a group.
struct ThesisStep {
  bool is_limb = false;
  int index = 0;  ///< Position in Plan::limbs or ThesisPlan::turns.
};

struct ThesisGroup {
  std::vector<ThesisStep> steps;
  bool is_trunk = false;  ///< Has sections: after all limbs.
};

/// Who may balance, heaviest first (thesis 5.2.2).
struct KineticGroup {
  int rank = 0;             ///< The same for arms, for legs: they balance together.
  int limb = -1;            ///< In two steps; else as one segment:
  std::vector<int> joints;  ///< low to high, that share the turn.
  std::vector<int> below;   ///< Live joints at or below its root, parents first.
  std::vector<int> users;   ///< Wishes that turn it: while one is active, it is theirs.
  int root = 0;             ///< The joint about which it turns.
};

/// How the thesis walks through a body, made once from its plan.
struct ThesisPlan {
  std::vector<ThesisTurn> turns;
  /// In the order of kinematic adaptation, the root left out (table 4.3).
  std::vector<ThesisGroup> groups;
  std::vector<KineticGroup> balancing;
  std::vector<char> moves_root;  ///< Per wish: counts for the root's translation.
  /// Per limb: wishes for the orientation of its upper or lower bone.
  std::vector<std::vector<int>> bone_orientations;
  std::vector<std::vector<int>> supports;  ///< Per limb.
};

/// Linear in joints times wishes.
[[nodiscard]] ThesisPlan make_thesis_plan(const Plan& plan);

}  // namespace marey::retarget
