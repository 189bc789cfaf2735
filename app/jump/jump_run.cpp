// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/jump/jump_run.h"

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "edit/find/peak_acceleration.h"
#include "edit/state/edit_state.h"

#include "app/adapt/adapt_body.h"
#include "app/edit/edit_inputs.h"
#include "app/edit/edit_outputs.h"
#include "app/motion/error_of_file.h"
#include "core/base/in_quotes.h"
#include "core/base/input_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Puts the source on the character's body, and takes over its masses.
Status put_on_character(const JumpArguments& args, EditFiles& files) {
  edit::EditState& source = files.inputs.sources.begin()->second;
  AdaptBodyOptions options;
  options.motion = args.motion;
  options.character = args.character;
  options.plant_feet = false;
  auto body = make_adapt_body(source.motion, options);
  if (!body) return body.error();
  auto state = edit::make_edit_state(std::move(body->reference));
  if (!state) return of_file(args.motion, state.error());
  files.source_peak_m_per_s2 = edit::peak_acceleration(state->motion).m_per_s2;
  files.inputs.masses = std::move(body->character.masses);
  files.look = std::move(body->look);
  source = *std::move(state);
  return Done{};
}

/// Returns the place of an error or a finding of the operation: the motion's file, and
/// the option or frame. `where` begins with the operation's name, or is empty.
std::string place_in_motion(const JumpArguments& args, std::string where) {
  for (const std::string prefix : {"operation 1: ", "jump@1", "jump", ": "}) {
    if (where.starts_with(prefix)) where.erase(0, prefix.size());
  }
  const std::string file = args.motion.string();
  return where.empty() ? file : file + ": " + with_jump_options(where);
}

std::vector<Finding> findings_of_jump(const JumpArguments& args, const EditRun& run) {
  std::vector<Finding> out;
  for (const std::string& remark : run.files.remarks) {
    Finding note;
    note.cause = remark;
    out.push_back(std::move(note));
  }
  for (Finding finding : run.rendered.reports.front().findings) {
    finding.where = place_in_motion(args, finding.where);
    finding.cause = with_jump_options(finding.cause);
    finding.next = with_jump_options(finding.next);
    out.push_back(std::move(finding));
  }
  return out;
}

}  // namespace

Result<MotionFormat> check_jump_out(const JumpArguments& args) {
  const auto format = output_format(args.out);
  if (!format) return format.error();
  std::vector<std::pair<fs::path, const char*>> read{{args.motion, "the motion"},
                                                     {args.character, "--character"}};
  std::error_code absent;
  if (fs::is_directory(args.motion, absent)) {
    read.front().first = args.motion / "motion.npz";
  }
  if (!args.character.empty()) {
    read.emplace_back(body_file_of(args.character), "the character's body");
  }
  for (const auto& [file, role] : read) {
    if (!fs::equivalent(args.out, file, absent)) continue;
    return bad_input(args.out.string(),
                     std::string("the result would replace ") + role,
                     "give the result another name");
  }
  return *format;
}

Result<JumpRun> run_jump_edit(const JumpArguments& args,
                              MotionFormat format,
                              Console& console) {
  std::error_code absent;
  if (!fs::is_directory(args.motion, absent)) {
    if (const Status ok = check_input_file(args.motion); !ok) return ok.error();
  }
  EditRecipe recipe = jump_recipe(args);
  auto files = read_edit_files(recipe, {});
  if (!files) return files.error();
  if (!args.character.empty()) {
    if (const Status ok = put_on_character(args, *files); !ok) return ok.error();
  }
  const edit::EditState& source = files->inputs.sources.begin()->second;
  if (const Status ok = check_result_format(format, source, files->look); !ok) {
    return of_file(args.out, ok.error());
  }
  auto edit =
      render_read_files("", std::move(recipe), *std::move(files), std::nullopt, console);
  if (!edit) {
    Error error = edit.error();
    error.where = place_in_motion(args, error.where);
    error.cause = with_jump_options(error.cause);
    error.next = with_jump_options(error.next);
    return error;
  }
  JumpRun out;
  out.edit = *std::move(edit);
  out.figures = measure_edit(out.edit.recipe, out.edit.files, out.edit.rendered).front();
  out.findings = findings_of_jump(args, out.edit);
  return out;
}

}  // namespace marey::app
