// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// What follows for points: expected errors, frames and cameras held out.
void judge_trust(FindingList& list);

}  // namespace marey::app
