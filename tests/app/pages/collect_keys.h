// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include <nlohmann/json.hpp>

namespace marey::app {

/// Adds the keys of all objects within a JSON value.
inline void collect_keys(const nlohmann::ordered_json& value,
                         std::set<std::string>& keys) {
  if (value.is_object()) {
    for (const auto& [key, below] : value.items()) {
      keys.insert(key);
      collect_keys(below, keys);
    }
  } else if (value.is_array()) {
    for (const auto& below : value) collect_keys(below, keys);
  }
}

}  // namespace marey::app
