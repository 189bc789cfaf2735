// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/base_recipe.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "app/edit/edit_inputs.h"
#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "core/base/input_file.h"
#include "core/constraint.h"
#include "core/edit/edit_recipe.h"
#include "recordings/base/sha256.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSumDigits = 64;

/// Returns the place of the operation that makes a loop of the result; nullopt: it is
/// none. Operations that join or divide motions after it end the loop.
std::optional<std::size_t> find_loop(const EditRecipe& recipe) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < recipe.ops.size(); ++i) {
    const EditOpParameters& op = recipe.ops[i].parameters;
    if (recipe.ops[i].off) continue;
    if (std::holds_alternative<CyclifyOp>(op)) found = i;
    const bool ends_loop =
        std::holds_alternative<CutOp>(op) || std::holds_alternative<KeepOp>(op) ||
        std::holds_alternative<SplitOp>(op) || std::holds_alternative<SpliceOp>(op);
    if (ends_loop) found.reset();
  }
  return found;
}

void cut_ranges(std::vector<FrameRange>& ranges, int frames) {
  std::erase_if(ranges, [&](const FrameRange& range) { return range.first >= frames; });
  for (FrameRange& range : ranges) range.last = std::min(range.last, frames - 1);
}

/// Removes constraints that begin after the end, unless another one refers to them.
void cut_constraints(ConstraintSet& set, double end_s) {
  std::set<std::string> referred;
  for (const Constraint& constraint : set.constraints) {
    const auto* goal = std::get_if<DistanceToConstraint>(&constraint.goal);
    if (goal != nullptr) referred.insert(goal->other_id);
  }
  std::erase_if(set.constraints, [&](const Constraint& constraint) {
    return constraint.activation.start_s.value_or(0.0) >= end_s &&
           !referred.contains(constraint.id);
  });
}

/// Removes all frames behind the first `frames`.
void cut_state(edit::EditState& state, int frames) {
  state.motion.poses.resize(static_cast<std::size_t>(frames));
  state.contacts.frame_count = frames;
  for (FootContacts& foot : state.contacts.feet) {
    for (auto* ranges : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
      cut_ranges(*ranges, frames);
    }
  }
  const double end_s = state.duration_s();
  cut_constraints(state.constraints, end_s);
  std::vector<Annotation>& notes = state.annotations.notes;
  std::erase_if(notes, [&](const Annotation& note) { return note.start_s >= end_s; });
  for (Annotation& note : notes) note.end_s = std::min(note.end_s, end_s);
}

/// Cuts a motion of `cycles` cycles to one less, with the first frame of the last one:
/// it closes the loop. Errors (bad input): its frames are no such cycles.
Status close_loop(int cycles, const fs::path& file, edit::EditState& state) {
  const int frames = state.frame_count();
  if (frames % cycles != 0) {
    return bad_input(file.string(),
                     "its loop has another length after the operation cyclify",
                     "place operations that change the duration before cyclify");
  }
  cut_state(state, frames - frames / cycles + 1);
  return Done{};
}

std::vector<std::string> texts_of_tags(const EditRecipe& recipe) {
  std::vector<std::string> texts;
  for (const EditOp& op : recipe.ops) {
    const auto* tag = std::get_if<TagOp>(&op.parameters);
    if (tag != nullptr && !op.off) texts.push_back(tag->text);
  }
  return texts;
}

/// Returns the name of the body of a result: that of the last avatar.
std::string body_of(const EditRecipe& recipe) {
  std::string body;
  for (const EditOp& op : recipe.ops) {
    const auto* avatar = std::get_if<RetargetOp>(&op.parameters);
    if (avatar != nullptr && !op.off) body = fs::path(avatar->avatar).stem().string();
  }
  return body;
}

}  // namespace

std::vector<std::string> tags_of(const Annotations& annotations,
                                 std::vector<std::string> more) {
  for (const Annotation& note : annotations.notes) {
    for (const std::string_view mark : {"tag: ", "tag:", "tag "}) {
      if (!note.text.starts_with(mark)) continue;
      more.push_back(note.text.substr(mark.size()));
      break;
    }
  }
  std::erase(more, std::string());
  std::sort(more.begin(), more.end());
  more.erase(std::unique(more.begin(), more.end()), more.end());
  return more;
}

engine::ClipSource clip_source_of(edit::EditState state) {
  engine::ClipSource source;
  source.motion = std::move(state.motion);
  source.map = std::move(state.map);
  source.contacts = std::move(state.contacts);
  source.annotations = std::move(state.annotations);
  source.constraints = std::move(state.constraints);
  source.tags = tags_of(source.annotations, {});
  return source;
}

Result<std::vector<engine::ClipSource>> read_base_motion(const fs::path& file,
                                                         Console& console) {
  if (const Status ok = check_input_file(file); !ok) return ok.error();
  EditRecipe recipe;
  recipe.name = file.stem().string();
  EditSource named;
  named.path = file.string();
  recipe.sources.push_back(named);
  auto files = read_edit_files(recipe, {});
  if (!files) return files.error();
  for (const std::string& remark : files->remarks) console.warn(remark);
  auto source = clip_source_of(std::move(files->inputs.sources.begin()->second));
  source.name = recipe.name;
  source.document_sha256 = files->sha256.front().substr(0, kSumDigits);
  std::vector<engine::ClipSource> out;
  out.push_back(std::move(source));
  return out;
}

Result<std::vector<engine::ClipSource>> render_base_recipe(const fs::path& file,
                                                           Console& console) {
  auto recipe = read_named_recipe(file);
  if (!recipe) return recipe.error();
  auto recipe_sum = recordings::sha256_of_file(file);
  if (!recipe_sum) return recipe_sum.error();
  const auto loop = find_loop(*recipe);
  int cycles = 0;
  // The first frame of one more cycle closes the loop.
  if (loop) cycles = ++std::get<CyclifyOp>(recipe->ops[*loop].parameters).cycles;
  auto run = render_recipe(file, *std::move(recipe), {}, console);
  if (!run) return run.error();
  for (const std::string& remark : run->files.remarks) console.warn(remark);
  const std::vector<std::string> names =
      edit_names(run->recipe, run->rendered.outputs.size());
  std::vector<engine::ClipSource> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    edit::EditState& state = run->rendered.outputs[i];
    if (loop) {
      if (const Status ok = close_loop(cycles, file, state); !ok) return ok.error();
    }
    engine::ClipSource source = clip_source_of(std::move(state));
    source.tags = tags_of(source.annotations, texts_of_tags(run->recipe));
    source.name = names[i];
    source.loops = loop.has_value();
    source.body = body_of(run->recipe);
    source.document_sha256 = run->files.sha256.front().substr(0, kSumDigits);
    source.recipe_sha256 = *recipe_sum;
    out.push_back(std::move(source));
  }
  return out;
}

}  // namespace marey::app
