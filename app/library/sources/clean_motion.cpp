// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/clean_motion.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "edit/render.h"
#include "edit/state/edit_state.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/edit/edit_recipe.h"
#include "core/pose.h"

namespace marey::app {
namespace {

/// Displacement of joints between two motions of one skeleton.
struct MovedJoints {
  double largest_m = 0.0;
  std::size_t samples = 0;
};

MovedJoints compare_places(const Motion& before, const Motion& after) {
  constexpr double kVisible_m = 1e-4;
  MovedJoints out;
  const std::size_t joints = before.skeleton.joints.size();
  std::vector<RigidTransform> a(joints);
  std::vector<RigidTransform> b(joints);
  for (std::size_t f = 0; f < before.poses.size(); ++f) {
    world_from_joints(before.skeleton, before.poses[f], a);
    world_from_joints(after.skeleton, after.poses[f], b);
    for (std::size_t j = 0; j < joints; ++j) {
      const double moved_m = glm::distance(a[j].translation, b[j].translation);
      out.largest_m = std::max(out.largest_m, moved_m);
      if (moved_m > kVisible_m) ++out.samples;
    }
  }
  return out;
}

/// Returns the operations that put the feet on the floor.
EditRecipe ground_recipe() {
  EditRecipe recipe;
  recipe.name = "ground";
  recipe.sources.push_back({"motion", "", "", 0});
  recipe.ops.push_back({LevelOp{}});
  recipe.ops.push_back({PlantOp{}});
  return recipe;
}

Status ground_motion(SourceMotion& out) {
  auto state = edit::make_edit_state(out.motion, out.uncertainty);
  if (!state) return state.error();
  edit::EditInputs inputs;
  inputs.sources.emplace("motion", *std::move(state));
  auto rendered = edit::render(ground_recipe(), std::move(inputs));
  if (!rendered) {
    Error error = rendered.error();
    error.cause = "clean = \"ground\" is not possible: " + error.cause;
    error.next = "set clean = \"none\" in library.toml, or leave the file out with skip";
    return error;
  }
  MAREY_ASSERT(rendered->outputs.size() == 1);
  edit::EditState& made = rendered->outputs.front();
  const MovedJoints moved = compare_places(out.motion, made.motion);
  out.motion = std::move(made.motion);
  out.uncertainty = std::move(made.uncertainty);
  out.figures.push_back(
      {"cleaned_mm", 1000.0 * moved.largest_m, std::nullopt, "", std::nullopt});
  out.figures.push_back({"cleaned_samples",
                         static_cast<double>(moved.samples),
                         std::nullopt,
                         "",
                         std::nullopt});
  std::string remark = "clean = \"ground\" moved joints by up to ";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1000.0 * moved.largest_m);
  remark += text.data();
  for (const edit::OpReport& report : rendered->reports) {
    for (const auto& [name, value] : report.figures) {
      std::snprintf(text.data(), text.size(), ", %s %.2f", name.c_str(), value);
      remark += text.data();
    }
  }
  out.remarks.push_back(std::move(remark));
  for (const edit::OpReport& report : rendered->reports) {
    for (const Finding& finding : report.findings) {
      out.remarks.push_back(finding.message());
    }
  }
  return Done{};
}

}  // namespace

Status clean_motion(CleanBy clean, bool is_solved, SourceMotion& motion) {
  if (clean == CleanBy::kGround) return ground_motion(motion);
  if (clean == CleanBy::kNone || is_solved) return Done{};
  return bad_input("",
                   "clean = \"repair\" works on markers and tags, and this file has none",
                   "set clean to \"none\" or \"ground\" in library.toml, or repair the "
                   "motion with marey edit and add its recipe");
}

}  // namespace marey::app
