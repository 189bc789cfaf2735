// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/library/find/open_search.h"
#include "core/base/result.h"

namespace marey::app {

/// The motion that a search starts from.
struct SimilarQuery {
  std::vector<float> rows;  ///< body_features(), kFeatureStride floats each.
  std::string name;         ///< Name of the clip, or path of the file.
  std::optional<int> clip;  ///< Number of the clip; nullopt: a file.
  bool has_range = false;   ///< A part was asked for.
};

/// Divides "CLIP@1.5-3" into its name and its range of seconds. Without such an end, all
/// of it is the name.
[[nodiscard]] std::pair<std::string, std::optional<std::pair<double, double>>>
divide_range(const std::string& text);

/// Returns the number of the clip that is meant by an id, by the beginning of an id (four
/// digits or more) or by a name. Errors: (kBadInput) there is none, with the nearest
/// names, or there are several, with their ids; those of the index.
[[nodiscard]] Result<int> find_clip(const std::filesystem::path& library,
                                    const std::string& word);

/// Reads a query: "CLIP", "CLIP@a-b", "FILE" or "FILE@a-b", with a and b in seconds since
/// its first frame. An existing file is a file; all others are clips, see find_clip().
/// Errors: (kUsage) a range outside of the motion, or one that does not ascend;
/// find_clip()'s; read_motion()'s and make_library_motion()'s, with the file.
[[nodiscard]] Result<SimilarQuery> read_similar_query(
    const std::filesystem::path& library,
    const std::string& text,
    const OpenedSearch& search);

}  // namespace marey::app
