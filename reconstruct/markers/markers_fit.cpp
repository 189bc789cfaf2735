// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/markers_fit.h"

namespace marey::reconstruct {

std::string_view name(LabelUse use) {
  switch (use) {
    case LabelUse::kNamed:
      return "named";
    case LabelUse::kFound:
      return "found";
    case LabelUse::kMoved:
      return "moved";
    case LabelUse::kLeftOut:
      return "left-out";
  }
  return "left-out";
}

std::string_view name(JointOrigin origin) {
  switch (origin) {
    case JointOrigin::kMovement:
      return "movement";
    case JointOrigin::kLandmarks:
      return "landmarks";
    case JointOrigin::kProportions:
      return "proportions";
  }
  return "proportions";
}

}  // namespace marey::reconstruct
