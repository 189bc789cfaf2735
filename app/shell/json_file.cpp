// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/json_file.h"

#include <string>
#include <utility>

#include "recordings/base/atomic_file.h"
#include "recordings/base/nesting.h"

namespace marey::app {

Result<nlohmann::ordered_json> read_json(const std::filesystem::path& path) {
  const Result<std::string> text = recordings::read_file(path);
  if (!text) return text.error();
  if (recordings::json_nests_too_deep(*text)) {
    return bad_input(path.string(),
                     "its lists and objects nest more than " +
                         std::to_string(recordings::kMaxNesting) + " deep",
                     "give a file that marey wrote");
  }
  if (recordings::json_has_too_many_keys(*text)) {
    return bad_input(path.string(),
                     "one of its objects has more than " +
                         std::to_string(recordings::kMaxKeys) + " keys",
                     "give a file that marey wrote");
  }
  auto json = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (!json.is_discarded()) return json;
  return bad_input(path.string(), "it is not valid JSON", "copy the file again");
}

}  // namespace marey::app
