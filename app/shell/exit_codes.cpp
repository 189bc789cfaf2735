// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/exit_codes.h"

namespace marey::app {

Exit exit_for(Errc code) {
  switch (code) {
    case Errc::kInternal:
      return Exit::kInternal;
    case Errc::kUsage:
      return Exit::kUsage;
    case Errc::kBadInput:
      return Exit::kBadInput;
    case Errc::kQuality:
      return Exit::kQualityGate;
    case Errc::kDevice:
      return Exit::kDevice;
  }
  return Exit::kInternal;
}

}  // namespace marey::app
