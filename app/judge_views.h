// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// What was shown to each camera: coverage, tilt, views, views in common.
void judge_views(FindingList& list);

}  // namespace marey::app
