// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/push_reference.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/assert.h"

namespace marey::dynamics {

PushReference make_push_reference(double duration_s, std::vector<double> force_m_s2) {
  MAREY_ASSERT(duration_s > 0.0 && force_m_s2.size() >= 2);
  const std::size_t count = force_m_s2.size();
  PushReference out{duration_s, std::move(force_m_s2), {}, {}};
  out.impulse_m_s.assign(count, 0.0);
  out.double_impulse_m.assign(count, 0.0);
  const double step_s = duration_s / static_cast<double>(count - 1);
  for (std::size_t i = 1; i < count; ++i) {
    const double before = out.force_m_s2[i - 1];
    const double after = out.force_m_s2[i];
    out.impulse_m_s[i] = out.impulse_m_s[i - 1] + step_s * (before + after) / 2.0;
    out.double_impulse_m[i] = out.double_impulse_m[i - 1] +
                              step_s * out.impulse_m_s[i - 1] +
                              step_s * step_s * (2.0 * before + after) / 6.0;
  }
  return out;
}

}  // namespace marey::dynamics
