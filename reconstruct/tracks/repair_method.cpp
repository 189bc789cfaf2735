// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/repair_method.h"

namespace marey::reconstruct {

std::string_view name(RepairMethod method) {
  switch (method) {
    case RepairMethod::kCluster:
      return "cluster";
    case RepairMethod::kStructure:
      return "structure";
    case RepairMethod::kSpline:
      return "spline";
    case RepairMethod::kLeftEmpty:
      return "left-empty";
  }
  return "left-empty";
}

}  // namespace marey::reconstruct
