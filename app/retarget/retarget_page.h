// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/retarget/retarget_figures.h"

namespace marey::app {

/// The page of `marey retarget --report`: one file that needs nothing else. Of every
/// avatar how its feet keep to the floor against the source's, when feet stand in the
/// source and on it, and pictures of all bodies at the same moments. The same bytes for
/// the same input; some tens of kilobytes an avatar, however long the motion is.
[[nodiscard]] std::string retarget_page(const RetargetRun& run);

}  // namespace marey::app
