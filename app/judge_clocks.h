// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// Whether clocks and line delays are what cameras have, and hold throughout.
void judge_clocks(FindingList& list);

}  // namespace marey::app
