// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Reports as JSON: the scan detects exactly the texts that nest deeper than its limit.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/base/assert.h"
#include "recordings/base/nesting.h"

namespace {

std::size_t depth_of(const nlohmann::json& value) {
  if (!value.is_structured()) return 0;
  std::size_t deepest = 0;
  for (const auto& item : value) deepest = std::max(deepest, depth_of(item));
  return deepest + 1;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const bool too_deep = marey::recordings::json_nests_too_deep(text);
  // Deeper ones would need the stack that the scan is to save.
  if (too_deep && size > 4000) return 0;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return 0;
  MAREY_ASSERT((depth_of(json) > marey::recordings::kMaxNesting) == too_deep);
  return 0;
}
