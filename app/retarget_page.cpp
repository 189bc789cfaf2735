// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget_page.h"

namespace marey::app {

std::string retarget_page(const RetargetRun& run) {
  return run.motion.string();
}

}  // namespace marey::app
