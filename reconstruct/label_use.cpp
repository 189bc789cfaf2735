// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/fit_markers.h"

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

}  // namespace marey::reconstruct
