// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "dynamics/jumps/support_push.h"

namespace marey::dynamics {

/// Vertical speeds at the end of a support. [m/s]
struct EndSpeeds {
  double low_m_s = 0.0;
  double high_m_s = 0.0;
};

/// Returns the smallest and the largest vertical end speed above 0 and up to
/// `largest_m_s` for which derive_support() finds a push, to 0.1 mm/s; that of the wish
/// is not used. nullopt: none of 96 equally spaced speeds is possible. Some milliseconds.
[[nodiscard]] std::optional<EndSpeeds> possible_speeds(const SupportReference& reference,
                                                       SupportWish wish,
                                                       double largest_m_s);

}  // namespace marey::dynamics
