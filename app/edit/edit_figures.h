// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::app {

/// Figures of one edited motion, measured on the result by forward kinematics.
struct EditFigures {
  std::string name;
  int frames = 0;
  double duration_s = 0.0;
  double slide_mm = 0.0;            ///< Largest drift of a foot within one contact.
  double slide_cm_per_s = 0.0;      ///< Mean over all contacts.
  double displaced_mm = 0.0;        ///< Largest displacement of an operation.
  double acceleration_ratio = 0.0;  ///< Peak of the joints, over the source's peak.
  double constraint_mm = 0.0;       ///< Largest error of a fully active constraint.
  int inferred_frames = 0;          ///< Frames that operations invented.
};

}  // namespace marey::app
