// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_seeds_edits.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "recordings/edit/annotations_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "tests/support/files/random_recipe.h"

namespace marey::fuzz {

bool write_edit_seeds(const std::filesystem::path& folder) {
  constexpr std::uint64_t kPerOp = 3;
  for (std::size_t kind = 0; kind < edit_op_names().size(); ++kind) {
    EditRecipe recipe = testing::random_edit_recipe(kind, 0);
    for (std::uint64_t seed = 0; seed < kPerOp; ++seed) {
      recipe.ops.push_back(testing::random_edit_op(seed, kind));
    }
    const std::string name(edit_op_names()[kind]);
    if (!recordings::write_edit_recipe(folder / name, recipe)) return false;
  }
  ConstrainOp constrain;
  constrain.detect = DetectConstraints::kSupports;
  constrain.changes = {{"found leftFoot flat 2",
                        AtTime{1.25},
                        AtAnnotation{"left.toe_off", 1},
                        0.1,
                        0.2,
                        glm::dvec3(0.5, 0.0, -1.0)}};
  EditRecipe changes = testing::random_edit_recipe(0, 0);
  changes.ops = {EditOp{constrain}};
  if (!recordings::write_edit_recipe(folder / "changes", changes)) return false;
  const Annotations annotations{{{"a \"é\"", 0.0, 1.5}, {"b", 2.0, 2.0}},
                                {{"w", {0.0, 1e-300}}, {"v", {-1.5, 2.0}}}};
  return recordings::write_annotations(folder / "annotations", annotations).has_value();
}

}  // namespace marey::fuzz
