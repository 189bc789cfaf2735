// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey::testing {

/// A small file that demands much of its reader. Made by rule, not by mutation.
struct Bomb {
  std::string name;  ///< "node_chain.gltf": the excessive part and the kind of file.
  std::string bytes;
  /// True: readers may accept it, as it is only large or odd. False: they reject it.
  bool may_be_read = false;
};

/// Brackets in brackets, chains of nodes, one accessor in many places, images beyond
/// their buffer.
[[nodiscard]] std::vector<Bomb> gltf_bombs();
/// BVH and ASF: deep chains, many branches, long names, counts without values.
[[nodiscard]] std::vector<Bomb> skeleton_bombs();
/// TOML: deep keys, lists and headers, many keys.
[[nodiscard]] std::vector<Bomb> toml_bombs();
/// YAML and XML as calibrations have it: deep lists, references to references, many
/// elements.
[[nodiscard]] std::vector<Bomb> tree_bombs();
/// C3D, TRC, MOT and CSV: counts without data, many columns, long lines.
[[nodiscard]] std::vector<Bomb> table_bombs();
/// NPZ: shapes without data, entries that overlap.
[[nodiscard]] std::vector<Bomb> npz_bombs();
/// JSON of marey's own reports.
[[nodiscard]] std::vector<Bomb> json_bombs();

/// Returns `depth` times `open`, then `middle`, then `depth` times `close`.
[[nodiscard]] std::string nested(const std::string& open,
                                 const std::string& middle,
                                 const std::string& close,
                                 std::size_t depth);
[[nodiscard]] std::string repeated(const std::string& text, std::size_t count);
/// `make(i)` for every i, with commas between.
template <class Make>
[[nodiscard]] std::string listed(std::size_t count, const Make& make) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += (i == 0 ? "" : ",") + make(i);
  return out;
}

}  // namespace marey::testing
