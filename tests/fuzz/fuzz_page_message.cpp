// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "core/base/assert.h"
#include "live/page/page_request.h"

namespace {

using namespace marey;
using namespace marey::live;

/// Asserts the limits of a request, for any sender.
void check(const PageRequest& request) {
  if (const auto* drag = std::get_if<DragRequest>(&request)) {
    MAREY_ASSERT(!drag->id.empty() && drag->id.size() <= 200);
    for (int i = 0; i < 3; ++i) MAREY_ASSERT(std::abs(drag->p_in_world[i]) <= 1e4);
    MAREY_ASSERT(drag->frame.value_or(0) >= 0);
  } else if (const auto* shown = std::get_if<ShownRequest>(&request)) {
    MAREY_ASSERT(std::isfinite(shown->sent_s));
  } else if (const auto* constraint = std::get_if<ConstraintRequest>(&request)) {
    MAREY_ASSERT(!constraint->id.empty() && constraint->id.size() <= 200);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<PageRequest> request = read_page_request(text);
  if (request) {
    check(*request);
  } else {
    MAREY_ASSERT(!request.error().cause.empty());
  }
  return 0;
}
