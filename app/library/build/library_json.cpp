// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/library_json.h"

#include "core/base/format_text.h"

namespace marey::app {

nlohmann::ordered_json library_json(const BuiltLibrary& built) {
  const recordings::IndexHead& head = built.merged.head;
  nlohmann::ordered_json failures = nlohmann::ordered_json::array();
  for (const Error& error : built.failures) {
    failures.push_back(
        {{"where", error.where}, {"cause", error.cause}, {"next", error.next}});
  }
  return {{"version", head.version},
          {"version_sha256", head.version_name},
          {"is_new_version", built.merged.is_new_version},
          {"sources", built.sources},
          {"sources_read", built.read},
          {"clips", head.clips},
          {"seconds", head.seconds},
          {"warned", head.warned},
          {"failed", head.failed},
          {"duplicates", head.duplicates},
          {"failures", failures},
          {"remarks", built.remarks}};
}

std::string library_sentence(const BuiltLibrary& built) {
  constexpr double kSecondsPerHour = 3600.0;
  const recordings::IndexHead& head = built.merged.head;
  const char* state = built.merged.is_new_version ? "" : " (as before)";
  return format_text(
      "version %d%s: %lld clips of %zu sources, %.2f h; quality: %lld warned, %lld "
      "failed; %lld duplicates; %zu sources read",
      head.version,
      state,
      static_cast<long long>(head.clips),
      built.sources,
      head.seconds / kSecondsPerHour,
      static_cast<long long>(head.warned),
      static_cast<long long>(head.failed),
      static_cast<long long>(head.duplicates),
      built.read);
}

}  // namespace marey::app
