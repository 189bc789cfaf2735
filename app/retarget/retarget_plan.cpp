// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/retarget_plan.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/assert.h"
#include "core/base/extension.h"
#include "recordings/body/bone_map_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

std::optional<MotionFormat> format_by_extension(const fs::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind.empty() ? std::nullopt : motion_format(kind.substr(1));
}

Status choose_formats(const RetargetArguments& args, RetargetPlan& plan) {
  for (const std::string& word : args.formats) {
    const auto format = motion_format(word);
    MAREY_ASSERT(format);
    if (std::ranges::find(plan.formats, *format) == plan.formats.end()) {
      plan.formats.push_back(*format);
    }
  }
  plan.formats_are_wanted = !plan.formats.empty() || !plan.file.empty();
  if (!plan.file.empty()) plan.formats = {*format_by_extension(plan.file)};
  if (plan.formats.empty()) {
    plan.formats = {MotionFormat::kGlb, MotionFormat::kBvh, MotionFormat::kVrma};
  }
  if (args.bvh_dialect.empty() ||
      std::ranges::find(plan.formats, MotionFormat::kBvh) != plan.formats.end()) {
    return Done{};
  }
  return bad_input(args.out.string(),
                   "only a .bvh is written in a dialect",
                   "leave out --bvh-dialect");
}

/// Returns true if OUT is a file.
Result<bool> is_file(const RetargetArguments& args, std::size_t avatars) {
  std::error_code ignored;
  if (fs::is_directory(args.out, ignored) || !args.out.has_filename()) return false;
  if (format_by_extension(args.out)) {
    if (avatars > 1) {
      return bad_input(args.out.string(),
                       "--out is one file, but there are several avatars",
                       "name a folder");
    }
    if (!args.formats.empty()) {
      return bad_input(args.out.string(),
                       "--out is one file, and its extension sets the format",
                       "name a folder, or leave out --formats");
    }
    return true;
  }
  // Assumes an unsupported file format, not a folder with a point in its name.
  if (avatars == 1 && args.formats.empty() && args.out.has_extension()) {
    return bad_input(args.out.string(),
                     "cannot write a \"" + kind_by_extension(args.out) + "\" file",
                     "name the result " + motion_extensions() + ", or a folder");
  }
  return false;
}

/// Returns the input files and their roles.
std::vector<std::pair<fs::path, std::string>> inputs_of(const RetargetArguments& args,
                                                        const RetargetPlan& plan) {
  std::vector<std::pair<fs::path, std::string>> in{
      {args.motion, "the motion"},
      {recordings::bone_map_path(args.motion), "the motion's bone map"}};
  if (args.motion_bones) in.emplace_back(*args.motion_bones, "the motion's bone map");
  if (args.bones) in.emplace_back(*args.bones, "the avatar's bone map");
  for (const RetargetPlan::Avatar& avatar : plan.avatars) {
    in.emplace_back(avatar.file.path, "an avatar");
    in.emplace_back(recordings::bone_map_path(avatar.file.path), "an avatar's bone map");
  }
  return in;
}

Status check_outs(const RetargetArguments& args, const RetargetPlan& plan) {
  std::vector<fs::path> outs{plan.page, args.constraints_out};
  for (const RetargetPlan::Avatar& avatar : plan.avatars) {
    for (const MotionFormat format : plan.formats) {
      outs.push_back(plan.out(avatar, format));
    }
  }
  std::erase_if(outs, [](const fs::path& out) { return out.empty(); });
  std::set<fs::path> names;
  for (const fs::path& out : outs) {
    if (!names.insert(out.lexically_normal()).second) {
      return bad_input(out.string(),
                       "two results would have this name",
                       "give --constraints-out another name, or rename an avatar's file: "
                       "results are named after it");
    }
    for (const auto& [in, role] : inputs_of(args, plan)) {
      std::error_code absent;
      if (!fs::equivalent(in, out, absent)) continue;
      return bad_input(out.string(),
                       "the result would replace " + role,
                       "give the result another name or folder");
    }
  }
  const fs::path& constraints = args.constraints_out;
  if (!constraints.empty() && kind_by_extension(constraints) != ".xml") {
    return bad_input(constraints.string(),
                     "constraints are written as .xml",
                     "give a name that ends in .xml");
  }
  return Done{};
}

/// Checks for options that exclude each other.
Status check_options(const RetargetArguments& args) {
  const retarget::RetargetOptions& options = args.options.retarget;
  if (args.balance && args.no_ground) {
    return bad_input("--balance",
                     "balance needs feet that are kept on the floor",
                     "leave out --no-ground");
  }
  if (!args.options.live) return Done{};
  const bool path = options.path == retarget::WorldLengths::kKept;
  const bool heights = options.heights == retarget::WorldLengths::kKept;
  if (!args.balance && !path && !heights) return Done{};
  return bad_input(args.balance ? "--balance"
                   : path       ? "--path kept"
                                : "--heights kept",
                   "this option needs the whole motion",
                   "leave out --live");
}

}  // namespace

fs::path RetargetPlan::out(const Avatar& avatar, MotionFormat format) const {
  return file.empty() ? fs::path(avatar.stem.string() + "." + std::string(name(format)))
                      : file;
}

Result<RetargetPlan> plan_retarget(const RetargetArguments& args) {
  std::vector<fs::path> avatars = args.avatars;
  avatars.insert(avatars.end(), args.more_avatars.begin(), args.more_avatars.end());
  MAREY_ASSERT(!avatars.empty());
  if (args.bones && avatars.size() > 1) {
    return bad_input("--bones",
                     "this bone map is for one avatar, but there are several",
                     "store a map next to each avatar: marey inspect AVATAR --write-map");
  }
  if (!args.constraints_out.empty() && avatars.size() > 1) {
    return bad_input("--constraints-out",
                     "footprints are written for one avatar, but there are several",
                     "give one avatar");
  }
  if (const Status ok = check_options(args); !ok) return ok.error();
  RetargetPlan plan;
  const auto file = is_file(args, avatars.size());
  if (!file) return file.error();
  if (*file) plan.file = args.out;
  if (const Status ok = choose_formats(args, plan); !ok) return ok.error();
  for (const fs::path& avatar : avatars) {
    const std::string name = avatar.stem().string();
    plan.avatars.push_back({{avatar, args.bones}, name, args.out / name});
  }
  if (args.report) {
    plan.page =
        *file ? fs::path(args.out.string() + ".html") : args.out / "retarget.html";
  }
  if (const Status ok = check_outs(args, plan); !ok) return ok.error();
  return plan;
}

}  // namespace marey::app
