// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// Whether an AprilGrid is as it was declared: all cameras together find its black
/// squares larger or smaller than the gaps between them allow. Lens and light do that to
/// a camera, by pixels; a wrong measure on the ruler does it to all, by a share.
void judge_print(FindingList& list);

}  // namespace marey::app
