// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "recordings/markers/marker_file.h"

namespace marey::recordings {

/// Returns true if a note of the file contains these words.
[[nodiscard]] inline bool has_note(const MarkerFile& file, const std::string& words) {
  return std::any_of(
      file.notes.begin(), file.notes.end(), [&words](const std::string& note) {
        return note.find(words) != std::string::npos;
      });
}

}  // namespace marey::recordings
