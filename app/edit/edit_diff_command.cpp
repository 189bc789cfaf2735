// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/edit/edit_commands.h"
#include "app/edit/edit_diff.h"
#include "app/edit/edit_run.h"

namespace marey::app {
namespace {

void print_operations(const std::vector<std::string>& operations,
                      int first_frames,
                      int second_frames) {
  for (const std::string& line : operations) std::printf("%s\n", line.c_str());
  std::printf("frames: %d and %d\n", first_frames, second_frames);
}

Exit print_difference(const EditDifference& difference, bool as_json) {
  if (as_json) {
    nlohmann::ordered_json json{{"operations", difference.operations},
                                {"first_frames", difference.first_frames},
                                {"second_frames", difference.second_frames}};
    if (difference.motion) {
      json["largest_mm"] = difference.motion->largest_mm;
      json["joint"] = difference.motion->joint;
      json["frame"] = difference.motion->frame;
    }
    print_edit_json(json);
    return Exit::kOk;
  }
  print_operations(
      difference.operations, difference.first_frames, difference.second_frames);
  if (difference.motion && difference.motion->joint.empty()) {
    std::printf("largest difference: none\n");
  } else if (difference.motion) {
    std::printf("largest difference: %.3f mm, %s, frame %d\n",
                difference.motion->largest_mm,
                difference.motion->joint.c_str(),
                difference.motion->frame);
  } else {
    std::printf("the results have different joints or several motions\n");
  }
  return Exit::kOk;
}

Exit print_difference(const MarkerEditDifference& difference, bool as_json) {
  if (as_json) {
    nlohmann::ordered_json json{{"operations", difference.operations},
                                {"first_frames", difference.first_frames},
                                {"second_frames", difference.second_frames}};
    if (difference.markers) {
      json["largest_mm"] = difference.markers->largest_mm;
      json["marker"] = difference.markers->marker;
      json["frame"] = difference.markers->frame;
      json["seen_in_one"] = difference.markers->seen_in_one;
    }
    print_edit_json(json);
    return Exit::kOk;
  }
  print_operations(
      difference.operations, difference.first_frames, difference.second_frames);
  if (!difference.markers) {
    std::printf("the results have no marker in common, or several recordings\n");
    return Exit::kOk;
  }
  if (difference.markers->marker.empty()) {
    std::printf("largest difference: none\n");
  } else {
    std::printf("largest difference: %.3f mm, %s, frame %d\n",
                difference.markers->largest_mm,
                difference.markers->marker.c_str(),
                difference.markers->frame);
  }
  if (difference.markers->seen_in_one > 0) {
    std::printf("samples that only one result has: %zu\n",
                difference.markers->seen_in_one);
  }
  return Exit::kOk;
}

Exit diff_recordings(EditRecipe first,
                     EditRecipe second,
                     const EditArguments& args,
                     Console& console) {
  const auto a =
      render_marker_recipe(args.diff_first, std::move(first), run_options(args), console);
  if (!a) return console.fail(a.error());
  const auto b = render_marker_recipe(
      args.diff_second, std::move(second), run_options(args), console);
  if (!b) return console.fail(b.error());
  return print_difference(
      compare_marker_edits(a->recipe, a->rendered, b->recipe, b->rendered), args.json);
}

}  // namespace

Exit run_edit_diff(const EditArguments& args, Console& console) {
  auto first = read_named_recipe(args.diff_first);
  if (!first) return console.fail(first.error());
  auto second = read_named_recipe(args.diff_second);
  if (!second) return console.fail(second.error());
  const bool first_has =
      edits_markers(*first, options_of_reading(args.diff_first, run_options(args)));
  const bool second_has =
      edits_markers(*second, options_of_reading(args.diff_second, run_options(args)));
  if (first_has != second_has) {
    return console.fail(bad_input(
        args.diff_second.string(),
        std::string("edits ") + (second_has ? "labelled markers" : "a motion") +
            ", and the other recipe " + (first_has ? "labelled markers" : "a motion"),
        "compare two recipes of one kind"));
  }
  if (first_has) {
    return diff_recordings(*std::move(first), *std::move(second), args, console);
  }
  const auto a =
      render_recipe(args.diff_first, *std::move(first), run_options(args), console);
  if (!a) return console.fail(a.error());
  const auto b =
      render_recipe(args.diff_second, *std::move(second), run_options(args), console);
  if (!b) return console.fail(b.error());
  return print_difference(compare_edits(a->recipe, a->rendered, b->recipe, b->rendered),
                          args.json);
}

}  // namespace marey::app
