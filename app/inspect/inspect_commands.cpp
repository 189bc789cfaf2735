// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_commands.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/inspect/inspect_body.h"
#include "app/inspect/inspect_engine.h"
#include "app/inspect/inspect_inputs.h"
#include "app/inspect/inspect_jumps.h"
#include "app/inspect/inspect_markers.h"
#include "app/inspect/inspect_results.h"
#include "app/motion/neutral.h"
#include "app/motion/raw_body.h"
#include "core/base/extension.h"
#include "core/base/input_file.h"
#include "recordings/session/file_kind.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

/// Returns an error that names the program for a file that marey writes for other
/// programs.
std::optional<Error> for_others(const std::filesystem::path& file) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kPrograms{
      {{".html", "a web browser"},
       {".pdf", "a PDF viewer, and print it at 100 %"},
       {".svg", "a web browser"},
       {".png", "a picture viewer"},
       {".jpg", "a picture viewer"},
       {".mkv", "a video player"},
       {".mp4", "a video player"},
       {".avi", "a video player"},
       {".mov", "a video player"}}};
  const std::string kind = kind_by_extension(file);
  for (const auto& [extension, program] : kPrograms) {
    if (kind != extension) continue;
    return bad_input(file.string(),
                     "holds pages, pictures or video, which inspect does not read",
                     "open it with " + std::string(program) +
                         "; inspect the folder that it is in for its figures");
  }
  return std::nullopt;
}

Result<Json> inspect_file(const std::filesystem::path& file,
                          const InspectBodyOptions& options,
                          Console& console) {
  const std::string extension = kind_by_extension(file);
  const std::string named = file.filename().string();
  if (named == "calibration.toml") return inspect_calibration(file);
  if (named == "subject.toml") return inspect_subject(file);
  if (named == "session.toml") return inspect_session(file);
  if (named == "joints.csv" || named == "segments.csv") return inspect_table(file);
  if (extension == ".json") return inspect_report(file);
  if (is_body_file(file)) return inspect_body(file, options, console);
  if (extension == ".marey") return inspect_base(file);
  if (extension == ".c3d" || extension == ".trc") return inspect_markers(file);
  if (extension == ".mot" || extension == ".sto") return inspect_angles(file);
  if (extension == ".asf") return inspect_acclaim(file);
  if (auto other = for_others(file)) return *other;
  const auto kind = recordings::file_kind(file);
  if (!kind) return kind.error();
  if (*kind == recordings::FileKind::kTake) return inspect_take(file);
  if (*kind == recordings::FileKind::kLiveTake) return inspect_live_take(file);
  const bool is_session =
      *kind == recordings::FileKind::kSession ||
      (*kind == recordings::FileKind::kUnknown && extension == ".toml");
  return is_session ? inspect_session(file) : inspect_kind(file, *kind);
}

Result<Json> inspect(const std::filesystem::path& file,
                     const InspectBodyOptions& options,
                     Console& console) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return inspect_folder(file);
  if (const Status ok = check_input_file(file); !ok) return ok.error();
  return inspect_file(file, options, console);
}

/// Returns JSON text. Bytes of foreign files that are not UTF-8 are replaced.
std::string text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Prints "key: value" lines, nested with two spaces.
void print(const Json& value, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [key, item] : value.items()) {
    const bool flat =
        !item.is_structured() ||
        (item.is_array() && std::none_of(item.begin(), item.end(), [](const Json& i) {
           return i.is_object();
         }));
    if (flat) {
      std::printf("%s%s: %s\n", indent.c_str(), key.c_str(), text(item, -1).c_str());
    } else {
      std::printf("%s%s:\n", indent.c_str(), key.c_str());
      print(item, depth + 1);
    }
  }
}

}  // namespace

Exit run_inspect(const std::filesystem::path& file,
                 const InspectBodyOptions& options,
                 bool json,
                 Console& console) {
  if (options.asks() && !is_body_file(file)) {
    return console.fail(
        bad_input(file.string(),
                  "is not a body; only bodies have a bone map and a picture",
                  "give a body: " + body_extensions()));
  }
  const auto found = inspect(file, options, console);
  if (!found) return console.fail(found.error());
  if (json) {
    std::printf("%s\n", text(*found, 2).c_str());
  } else {
    print(engine_as_lines(jumps_as_lines(bones_as_lines(*found))), 0);
  }
  return Exit::kOk;
}

void add_inspect_command(CLI::App& app,
                         InspectArguments& args,
                         std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("inspect", "Show the content of a file");
  command->add_option("FILE", args.file, "A session, result, motion or body")->required();
  command->add_flag("--json", args.json, "Print the content as JSON on standard output");
  command->add_option("--bones", args.body.bone_map, "Bone map of the body (TOML)");
  command->add_flag(
      "--write-map", args.body.write_map, "Write the bone map next to the body");
  command->add_option("--neutral", args.body.neutral, kNeutralHelp)
      ->check(neutral_mistake);
  command->add_option(
      "--picture", args.body.picture, "Draw the body's bones: .svg or .png");
  command->callback([&] {
    chosen = [&args](Console& console) {
      return run_inspect(args.file, args.body, args.json, console);
    };
  });
}

}  // namespace marey::app
