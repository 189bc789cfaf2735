// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/motion/mot.h"

namespace {

using namespace marey;
using namespace marey::recordings;

/// Asserts that a written table is read back unchanged, angles to 12 digits.
void read_again(const MotTable& first) {
  const Result<MotTable> second = parse_mot(mot_text(first), "again.mot");
  MAREY_ASSERT(second.has_value());
  MAREY_ASSERT(second->notes.empty());
  MAREY_ASSERT(second->time_s == first.time_s);
  MAREY_ASSERT(second->columns.size() == first.columns.size());
  for (std::size_t i = 0; i < first.values.size(); ++i) {
    const double a = first.values[i];
    const double b = second->values[i];
    const bool is_angle = first.columns[i % first.columns.size()].is_angle;
    // Degrees are 57 times as many, and may not be numbers any more.
    if (is_angle && std::abs(a) > 1e306) continue;
    MAREY_ASSERT(std::isnan(a) == std::isnan(b));
    if (std::isnan(a)) continue;
    MAREY_ASSERT(is_angle ? std::abs(a - b) <= 1e-11 * std::abs(a) + 1e-300 : a == b);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<MotTable> table = parse_mot(text, "fuzz.mot");
  if (table && table->values.size() < 10'000) read_again(*table);
  return 0;
}
