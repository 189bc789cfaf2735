// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_diff.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string_view>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {
namespace {

/// Returns an operation as one line.
std::string line_of(const EditOp& op) {
  std::string out;
  for (const char c : recordings::edit_op_text(op)) {
    if (c != '\n') {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += "  ";
    }
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return (op.off ? "(off) " : "") + out;
}

std::vector<std::string> lines_of(const EditRecipe& recipe) {
  std::vector<std::string> out;
  for (const EditOp& op : recipe.ops) out.push_back(line_of(op));
  return out;
}

/// Lines that only one list has, by the longest common part.
std::vector<std::string> differing(const std::vector<std::string>& a,
                                   const std::vector<std::string>& b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> common((a.size() + 1) * columns, 0);
  for (std::size_t i = a.size(); i-- > 0;) {
    for (std::size_t j = b.size(); j-- > 0;) {
      common[i * columns + j] = a[i] == b[j] ? 1 + common[(i + 1) * columns + j + 1]
                                             : std::max(common[(i + 1) * columns + j],
                                                        common[i * columns + j + 1]);
    }
  }
  std::vector<std::string> out;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() || j < b.size()) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      ++i;
      ++j;
    } else if (j == b.size() || (i < a.size() && common[(i + 1) * columns + j] >=
                                                     common[i * columns + j + 1])) {
      out.push_back("- " + a[i++]);
    } else {
      out.push_back("+ " + b[j++]);
    }
  }
  return out;
}

std::optional<MotionDifference> compare_motions(const Motion& a, const Motion& b) {
  if (a.skeleton.joints.size() != b.skeleton.joints.size()) return std::nullopt;
  MotionDifference out;
  for (std::size_t t = 0; t < std::min(a.poses.size(), b.poses.size()); ++t) {
    const auto first = world_from_joints(a.skeleton, a.poses[t]);
    const auto second = world_from_joints(b.skeleton, b.poses[t]);
    for (std::size_t j = 0; j < first.size(); ++j) {
      if (a.skeleton.joints[j].name != b.skeleton.joints[j].name) return std::nullopt;
      const double mm = 1e3 * glm::distance(first[j].translation, second[j].translation);
      if (mm > out.largest_mm) {
        out = {mm, a.skeleton.joints[j].name, static_cast<int>(t)};
      }
    }
  }
  return out;
}

std::optional<MarkerDifference> compare_tracks(const MarkerTracks& a,
                                               const MarkerTracks& b) {
  std::map<std::string_view, std::size_t> second_places;
  for (std::size_t m = 0; m < b.markers(); ++m) second_places.emplace(b.labels[m], m);
  MarkerDifference out;
  bool has_common = false;
  for (std::size_t m = 0; m < a.markers(); ++m) {
    const auto second = second_places.find(a.labels[m]);
    if (second == second_places.end()) continue;
    if (out.marker.empty()) out.marker = a.labels[m];
    has_common = true;
    for (std::size_t t = 0; t < std::min(a.frames(), b.frames()); ++t) {
      const auto& one = a.at(t, m);
      const auto& other = b.at(t, second->second);
      if (one.has_value() != other.has_value()) ++out.seen_in_one;
      if (!one || !other) continue;
      const double mm = 1e3 * glm::distance(one->p_in_world, other->p_in_world);
      if (mm <= out.largest_mm) continue;
      out.largest_mm = mm;
      out.marker = a.labels[m];
      out.frame = static_cast<int>(t);
    }
  }
  if (!has_common) return std::nullopt;
  return out;
}

}  // namespace

MarkerEditDifference compare_marker_edits(const EditRecipe& first,
                                          const edit::RenderedMarkers& first_result,
                                          const EditRecipe& second,
                                          const edit::RenderedMarkers& second_result) {
  MarkerEditDifference out;
  out.operations = differing(lines_of(first), lines_of(second));
  for (const edit::MarkerState& state : first_result.outputs) {
    out.first_frames += state.frame_count();
  }
  for (const edit::MarkerState& state : second_result.outputs) {
    out.second_frames += state.frame_count();
  }
  if (first_result.outputs.size() == 1 && second_result.outputs.size() == 1) {
    out.markers = compare_tracks(first_result.outputs.front().tracks,
                                 second_result.outputs.front().tracks);
  }
  return out;
}

EditDifference compare_edits(const EditRecipe& first,
                             const edit::Rendered& first_result,
                             const EditRecipe& second,
                             const edit::Rendered& second_result) {
  EditDifference out;
  out.operations = differing(lines_of(first), lines_of(second));
  for (const edit::EditState& state : first_result.outputs) {
    out.first_frames += state.frame_count();
  }
  for (const edit::EditState& state : second_result.outputs) {
    out.second_frames += state.frame_count();
  }
  if (first_result.outputs.size() == 1 && second_result.outputs.size() == 1) {
    out.motion = compare_motions(first_result.outputs.front().motion,
                                 second_result.outputs.front().motion);
  }
  return out;
}

}  // namespace marey::app
