// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/pages/report.h"

namespace marey::app {

/// A name that would like to be markup.
inline constexpr const char* kHostile = "</script><b>x</b>&<!--\"'\xE2\x80\xA8";
inline constexpr int kFrames = 40;

/// A report with one of everything: two cameras, two trials of kFrames frames on two
/// avatars each, gaps, pictures, warnings. Every name that can be is kHostile.
[[nodiscard]] Report report();

}  // namespace marey::app
