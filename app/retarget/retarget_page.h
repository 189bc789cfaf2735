// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/retarget/retarget_json.h"

namespace marey::app {

/// Returns the page of `marey retarget --report`, one self-contained file. For every
/// avatar it shows the foot contact quality compared with the source, when feet stand in
/// the source and on the avatar, and pictures of all bodies at the same moments. Same
/// input, same bytes. Some tens of kilobytes per avatar, whatever the motion's length.
[[nodiscard]] std::string retarget_page(const RetargetRun& run);

}  // namespace marey::app
