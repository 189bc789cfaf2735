// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/assert.h"
#include "live/page/edit_request.h"
#include "recordings/edit/edit_recipe_file.h"

namespace {

using namespace marey;
using namespace marey::live;

/// Asserts that the text of an operation is one operation, or is refused, and that it is
/// written as it was read.
void check_op(const std::string& text) {
  const Result<EditOp> op = recordings::parse_edit_op(text, "op");
  if (!op) {
    MAREY_ASSERT(!op.error().cause.empty());
    return;
  }
  const std::string written = recordings::edit_op_text(*op);
  const Result<EditOp> again = recordings::parse_edit_op(written, "op");
  MAREY_ASSERT(again && recordings::edit_op_text(*again) == written);
}

void check_patch(const OpsPatch& patch) {
  MAREY_ASSERT(!patch.empty() && patch.size() <= 64);
  for (const OpsPatchStep& step : patch) {
    MAREY_ASSERT(step.index >= 0 && step.to >= 0);
    if (!step.op_toml.empty()) check_op(step.op_toml);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<EditPageRequest> request = read_edit_request(text);
  if (!request) {
    MAREY_ASSERT(!request.error().cause.empty());
    return 0;
  }
  MAREY_ASSERT(request->id.size() <= 64);
  if (const auto* edit = std::get_if<EditRequest>(&request->body)) {
    check_patch(edit->patch);
  } else if (const auto* preview = std::get_if<PreviewRequest>(&request->body)) {
    if (request->type == "preview") check_patch(preview->patch);
    if (preview->span) MAREY_ASSERT(preview->span->first <= preview->span->last);
  }
  return 0;
}
