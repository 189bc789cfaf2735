// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/blend_inputs.h"

#include <array>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "edit/state/edit_state.h"
#include "engine/clips/make_clip.h"

#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/engine/base_sources.h"
#include "app/engine/open_base.h"
#include "app/motion/error_of_file.h"
#include "app/motion/retarget_files.h"
#include "core/base/in_quotes.h"
#include "core/base/input_file.h"
#include "core/human/average_proportions.h"
#include "core/nearest_word.h"
#include "core/pose.h"
#include "retarget/character/make_character.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRecipeName = ".edit.toml";

struct ReadFile {
  fs::path path;
  std::string role;
};

/// Adds a motion or recipe, and the files that the recipe names.
void add_read(const std::string& file, const char* role, std::vector<ReadFile>& out) {
  out.push_back({file, role});
  if (!file.ends_with(kRecipeName)) return;
  const auto recipe = read_named_recipe(file);
  if (!recipe) return;
  for (const EditSource& source : recipe->sources) {
    const fs::path beside = fs::path(file).parent_path() / source.path;
    out.push_back({source.path, "a source of the recipe"});
    out.push_back({beside, "a source of the recipe"});
  }
}

std::vector<ReadFile> read_files_of(const BlendArguments& args) {
  std::vector<ReadFile> out;
  if (args.base.empty()) {
    add_read(args.from, "the first motion", out);
    add_read(args.to, "the second motion", out);
  } else {
    out.push_back({args.base, "the base of clips"});
  }
  if (!args.avatar.empty()) out.push_back({args.avatar, "the body"});
  return out;
}

Result<engine::ClipSource> read_source(const fs::path& file, Console& console) {
  if (const Status ok = check_input_file(file); !ok) return ok.error();
  BaseInputs inputs;
  inputs.paths = {file};
  auto sources = read_base_sources(inputs, console);
  if (!sources) return sources.error();
  if (sources->size() == 1) return std::move(sources->front());
  return bad_input(file.string(),
                   "the recipe gives " + std::to_string(sources->size()) + " motions",
                   "make clips of it with marey base build, and name one with --base");
}

/// Makes the clips of both files. A file that is given twice becomes one clip.
Status make_clips(const BlendArguments& args,
                  std::vector<engine::ClipSource> sources,
                  BlendInputs& out) {
  const std::array files{args.from, args.to};
  std::array<std::string, 2> names;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (i > 0 && sources[i].name == names[0]) sources[i].name += " (2)";
    names[i] = sources[i].name;
    // Both together share a layout; each alone names its file in an error.
    const auto alone = engine::make_moves({&sources[i], 1});
    if (!alone) return of_file(files[i], alone.error());
  }
  auto moves = engine::make_moves(sources);
  if (!moves) return moves.error();
  auto base = engine::MotionBase::make(*std::move(moves));
  if (!base) return base.error();
  out.base = *std::move(base);
  out.from = *out.base->find(names[0]);
  out.to = sources.size() == 1 ? out.from : *out.base->find(names[1]);
  return Done{};
}

Status set_body(Skeleton skeleton, const std::string& name, BlendInputs& out) {
  auto map = retarget::map_body(skeleton);
  if (!map) return map.error();
  auto character = retarget::make_character(name, std::move(skeleton), *map);
  if (!character) return character.error();
  out.character = *std::move(character);
  out.map = *std::move(map);
  return Done{};
}

Status set_avatar(const fs::path& file, BlendInputs& out, Console& console) {
  if (const Status ok = check_input_file(file); !ok) return ok.error();
  auto avatar = open_avatar(file);
  if (!avatar) return avatar.error();
  for (const std::string& remark : avatar->remarks) console.warn(remark);
  out.look = avatar->look;
  const Status ok = set_body(std::move(avatar->skeleton), file.stem().string(), out);
  return ok ? ok : Status(of_file(file, ok.error()));
}

/// Makes an average body whose legs are as long as those of a clip's body.
Status set_average_body(const MotionClip& clip, BlendInputs& out) {
  constexpr double kStature_m = 1.75;
  const auto average = retarget::map_body(make_humanoid(average_proportions(kStature_m)));
  if (!average) return average.error();
  const double ratio = static_cast<double>(clip.leg_length_m) / average->leg_length_m;
  return set_body(
      make_humanoid(average_proportions(kStature_m * ratio)), "average body", out);
}

Status read_motions(const BlendArguments& args, BlendInputs& out, Console& console) {
  std::error_code ignored;
  std::vector<engine::ClipSource> sources;
  auto from = read_source(args.from, console);
  if (!from) return from.error();
  const Skeleton skeleton = from->motion.skeleton;
  sources.push_back(*std::move(from));
  if (!fs::equivalent(args.from, args.to, ignored)) {
    auto to = read_source(args.to, console);
    if (!to) return to.error();
    sources.push_back(*std::move(to));
  }
  if (const Status ok = make_clips(args, std::move(sources), out); !ok) return ok;
  if (!args.avatar.empty()) return set_avatar(args.avatar, out, console);
  if (is_gltf(args.from)) return set_avatar(args.from, out, console);
  const Status ok = set_body(skeleton, fs::path(args.from).stem().string(), out);
  return ok ? ok : Status(of_file(args.from, ok.error()));
}

Result<std::size_t> find_clip(const BlendArguments& args,
                              const engine::MotionBase& base,
                              const std::string& name) {
  if (const auto found = base.find(name)) return *found;
  std::vector<std::string_view> names;
  for (const MotionClip& clip : base.clips()) names.push_back(clip.name);
  return bad_input(args.base.string(),
                   "it has no clip " + in_quotes(name),
                   names.empty() ? "build it again with clips" : suggestion(name, names));
}

Status read_clips(const BlendArguments& args, BlendInputs& out, Console& console) {
  auto base = open_base(args.base);
  if (!base) return base.error();
  out.base = *std::move(base);
  const auto from = find_clip(args, *out.base, args.from);
  if (!from) return from.error();
  const auto to = find_clip(args, *out.base, args.to);
  if (!to) return to.error();
  out.from = *from;
  out.to = *to;
  if (!args.avatar.empty()) return set_avatar(args.avatar, out, console);
  return set_average_body(out.from_clip(), out);
}

/// Checks that a motion of the body can have the format.
Status check_body_format(const BlendArguments& args,
                         MotionFormat format,
                         const BlendInputs& inputs) {
  Motion rest{
      inputs.character.skeleton, {1.0}, 0, {rest_pose(inputs.character.skeleton)}};
  const auto state = edit::make_edit_state(std::move(rest));
  if (!state) return state.error();
  const Status ok = check_result_format(format, *state, inputs.look);
  return ok ? ok : Status(of_file(args.out, ok.error()));
}

}  // namespace

Result<MotionFormat> check_blend_out(const BlendArguments& args) {
  const auto format = output_format(args.out);
  if (!format) return format.error();
  std::error_code absent;
  for (const ReadFile& file : read_files_of(args)) {
    if (!fs::equivalent(args.out, file.path, absent)) continue;
    return bad_input(args.out.string(),
                     "the result would replace " + file.role,
                     "give the result another name");
  }
  return *format;
}

Result<BlendInputs> read_blend_inputs(const BlendArguments& args,
                                      MotionFormat format,
                                      Console& console) {
  BlendInputs out;
  const Status ok = args.base.empty() ? read_motions(args, out, console)
                                      : read_clips(args, out, console);
  if (!ok) return ok.error();
  if (const Status can = check_body_format(args, format, out); !can) return can.error();
  return out;
}

}  // namespace marey::app
