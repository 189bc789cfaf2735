// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

std::string_view name(BoneEvidence evidence) {
  switch (evidence) {
    case BoneEvidence::kFile:
      return "file";
    case BoneEvidence::kUser:
      return "told";
    case BoneEvidence::kName:
      return "name";
    case BoneEvidence::kChain:
      return "chain";
    case BoneEvidence::kShape:
      return "shape";
  }
  return "";
}

}  // namespace marey::retarget
