// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::edit {

/// The result of a recipe, or of its first operations.
struct Rendered {
  /// One motion, unless keep or split made several.
  std::vector<EditState> outputs;
  std::vector<OpReport>
      reports;  ///< One per operation and motion that it was applied to.
};

/// Results of operations, by a key that names all that they depend on. When it is full,
/// the results that were used longest ago are dropped. render() keeps the results of all
/// operations of a recipe with up to 64 of them, and some of a longer one.
class EditCache {
 public:
  explicit EditCache(std::size_t max_bytes = std::size_t{512} << 20)
      : max_bytes_(max_bytes) {}

  /// Returns the result, if it is known; valid until the next call of store().
  [[nodiscard]] const Rendered* find(const std::string& key);
  /// Takes a result. Returns the one in the cache, valid until the next call of store();
  /// nullptr: it is too large, and `result` is as before.
  const Rendered* store(const std::string& key, Rendered&& result);

 private:
  struct Entry {
    std::string key;
    Rendered result;
    std::size_t bytes = 0;
  };
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< The last used one first.
};

struct RenderOptions {
  /// Number of operations to apply; nullopt: all.
  std::optional<std::size_t> until{};
  /// For each operation a key of itself and of all before it, sources and avatars
  /// included (the SHA-256 of their texts and files); empty: nothing is cached.
  std::span<const std::string> keys{};
  EditCache* cache = nullptr;
  std::string recipe_file;  ///< For the place of errors.
  /// Called before each operation; true stops the rendering with an error. May be empty.
  std::function<bool()> is_cancelled{};
};

/// Applies the operations of a recipe, in their order, to its first source. Operations
/// that are off are absent. Pure: same recipe and inputs, same result, to the bit.
/// With a cache, only the operations after the last known result are applied.
///
/// `progress` receives the number of operations that are done, known results included.
///
/// Errors (bad input), with the recipe's file and the operation's line: apply_op()'s;
/// RenderOptions::is_cancelled returned true.
/// Precondition: `inputs` has all sources and avatars that the recipe names; as many keys
/// as operations, or none.
[[nodiscard]] Result<Rendered> render(const EditRecipe& recipe,
                                      const EditInputs& inputs,
                                      const RenderOptions& options = {},
                                      const Progress& progress = {});

/// The same, and uses up the inputs: results take the memory of the first source. For
/// motions of an hour, and programs that render once.
[[nodiscard]] Result<Rendered> render(const EditRecipe& recipe,
                                      EditInputs&& inputs,
                                      const RenderOptions& options = {},
                                      const Progress& progress = {});

/// Number of bytes that a state occupies, about.
[[nodiscard]] std::size_t bytes_of(const EditState& state);

}  // namespace marey::edit
