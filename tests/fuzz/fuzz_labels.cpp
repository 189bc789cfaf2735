// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tables of labels and verdicts, and files of BABEL. Rows that were read are written and
// read again as the same text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "recordings/library/babel_file.h"
#include "recordings/library/label_file.h"
#include "recordings/library/verdict_file.h"

namespace {

using namespace marey;
using namespace marey::recordings;

template <class T>
bool check(const Result<T>& result) {
  if (result) return true;
  MAREY_ASSERT(!result.error().cause.empty() && !result.error().next.empty());
  return false;
}

void check_labels(std::string_view text) {
  const auto labels = parse_labels(text, "fuzz.csv", "fuzz");
  if (!check(labels)) return;
  const std::string written = labels_text(*labels);
  const auto again = parse_labels(written, "again.csv", "fuzz");
  MAREY_ASSERT(again && labels_text(*again) == written);
}

void check_verdicts(std::string_view text) {
  const auto verdicts = parse_verdicts(text, "fuzz.csv");
  if (!check(verdicts)) return;
  const std::string written = verdicts_text(*verdicts);
  const auto again = parse_verdicts(written, "again.csv");
  MAREY_ASSERT(again && verdicts_text(*again) == written);
}

void check_babel(std::string_view text) {
  const auto babel = parse_babel(text, "fuzz.json", "fuzz");
  if (!check(babel)) return;
  const std::string written = labels_text(babel->rows);
  MAREY_ASSERT(parse_labels(written, "again.csv", "fuzz"));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check_labels(text);
  check_verdicts(text);
  check_babel(text);
  return 0;
}
