// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/lineage.h"

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/edit/annotation.h"
#include "core/edit/contact_edit.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::edit {

/// A motion with everything that belongs to it, between two operations. All times are
/// since the first pose, whatever Motion::first_frame is. [s]
struct EditState {
  Motion motion;
  retarget::BodyMap map;  ///< Map of the motion's skeleton.
  /// uncertainty[frame][joint]; empty: unknown.
  std::vector<std::vector<JointUncertainty>> uncertainty;
  ConstraintSet constraints;
  Annotations annotations;
  Contacts contacts;  ///< One contact frame per pose.
  /// Changes of the contacts by hand, in their order; they are applied again after each
  /// new detection.
  std::vector<ContactEdit> contact_edits;
  Lineage lineage;

  [[nodiscard]] int frame_count() const { return static_cast<int>(motion.poses.size()); }
  /// Time of the last pose. [s]
  [[nodiscard]] double duration_s() const {
    return frame_count() < 2 ? 0.0 : (frame_count() - 1) / motion.rate.hz;
  }
};

/// Makes the state of a source. `source` is its index in the recipe. Contacts are
/// detected by retarget::detect_contacts(). Linear in frames.
/// Errors (bad input, place is "frame N" or the skeleton): no frames; a number that is
/// not finite; a rate that is not positive; uncertainty of another number of frames;
/// those of map_body().
[[nodiscard]] Result<EditState> make_edit_state(
    Motion motion,
    std::vector<std::vector<JointUncertainty>> uncertainty = {},
    int source = 0);

}  // namespace marey::edit
