// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/shard_plan.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/shell/program_name.h"
#include "core/base/assert.h"
#include "core/base/format_text.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using ShardJson = nlohmann::ordered_json;
using recordings::OnDisk;

constexpr const char* kPlanFile = "plan.json";
constexpr std::uint64_t kMaxShards = 9999;

fs::path shard_file(const fs::path& library, int shard, const char* extension) {
  return recordings::LibraryPaths(library).shards() /
         (format_text("%04d", shard) + extension);
}

Error damaged_plan(const fs::path& file, std::string cause) {
  return bad_input(
      file.string(), std::move(cause), "plan again: marey library plan LIB --shards N");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

Result<std::string> source_line(const SourceFile& file) {
  const ShardJson json = {{"path", file.path.string()},
                          {"name", file.name},
                          {"kind", file.kind},
                          {"source", file.source},
                          {"bytes", file.bytes}};
  std::string line = json.dump(-1, ' ', false, ShardJson::error_handler_t::replace);
  // A path with replaced bytes names no file.
  const ShardJson again = ShardJson::parse(line, nullptr, false);
  if (again.at("path") != ShardJson(file.path.string())) {
    return bad_input(printable(file.path.string()),
                     "the path is not UTF-8, and cannot be a part of a plan",
                     "rename the file or its folder, or use marey library build");
  }
  return line + "\n";
}

bool read_source_line(const std::string& line, SourceFile& out) {
  const ShardJson root = ShardJson::parse(line, nullptr, false);
  const auto is_text = [&](const char* key) {
    return root.contains(key) && root.at(key).is_string();
  };
  const auto is_count = [&](const char* key) {
    return root.contains(key) && root.at(key).is_number_unsigned();
  };
  if (!root.is_object() || !is_text("path") || !is_text("name") || !is_text("kind") ||
      !is_count("source") || !is_count("bytes")) {
    return false;
  }
  out.path = root.at("path").get<std::string>();
  out.name = root.at("name").get<std::string>();
  out.kind = root.at("kind").get<std::string>();
  out.source = root.at("source").get<std::size_t>();
  out.bytes = root.at("bytes").get<std::uintmax_t>();
  return true;
}

}  // namespace

std::vector<std::vector<SourceFile>> divide_sources(std::vector<SourceFile> sources,
                                                    int shards) {
  MAREY_ASSERT(shards >= 1);
  std::ranges::sort(sources, [](const SourceFile& a, const SourceFile& b) {
    return a.bytes != b.bytes ? a.bytes > b.bytes : a.name < b.name;
  });
  std::vector<std::vector<SourceFile>> out(static_cast<std::size_t>(shards));
  std::vector<std::uintmax_t> bytes(out.size(), 0);
  for (SourceFile& source : sources) {
    const auto least =
        static_cast<std::size_t>(std::ranges::min_element(bytes) - bytes.begin());
    bytes[least] += source.bytes + 1;
    out[least].push_back(std::move(source));
  }
  return out;
}

Status write_shard_plan(const fs::path& library,
                        const ShardPlan& plan,
                        const std::vector<std::vector<SourceFile>>& lists) {
  std::vector<std::string> texts;
  std::string all = plan.inputs + "\n";
  for (const auto& list : lists) {
    std::string& text = texts.emplace_back();
    for (const SourceFile& file : list) {
      const auto line = source_line(file);
      if (!line) return line.error();
      text += *line;
    }
    all += text + "\n";
  }
  const std::string id = recordings::sha256(all);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const fs::path path = shard_file(library, static_cast<int>(i) + 1, ".todo");
    const Status ok = recordings::write_file(path, id + "\n" + texts[i], OnDisk::kNow);
    if (!ok) return ok;
  }
  const ShardJson json = {{"inputs", plan.inputs}, {"shards", plan.shards}, {"id", id}};
  return recordings::write_file(recordings::LibraryPaths(library).shards() / kPlanFile,
                                json.dump(1) + "\n",
                                OnDisk::kNow);
}

Result<ShardPlan> read_shard_plan(const fs::path& library) {
  const fs::path file = recordings::LibraryPaths(library).shards() / kPlanFile;
  std::error_code failed;
  if (!fs::exists(file, failed)) {
    return bad_input(
        library.string(),
        "the work on this library is not divided into shards",
        "call marey library plan LIB --shards N, or marey library build LIB");
  }
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  const ShardJson root = ShardJson::parse(*text, nullptr, false);
  const auto is_text = [&](const char* key) {
    return root.contains(key) && root.at(key).is_string();
  };
  const bool is_plan = root.is_object() && is_text("inputs") && is_text("id") &&
                       root.contains("shards") && root.at("shards").is_number_unsigned();
  const auto shards = is_plan ? root.at("shards").get<std::uint64_t>() : 0;
  if (shards < 1 || shards > kMaxShards) {
    return damaged_plan(file, "the plan is damaged");
  }
  return ShardPlan{root.at("inputs").get<std::string>(),
                   static_cast<int>(shards),
                   root.at("id").get<std::string>()};
}

Result<std::vector<SourceFile>> read_shard_list(const fs::path& library,
                                                const ShardPlan& plan,
                                                int shard,
                                                std::size_t source_count) {
  const fs::path file = shard_file(library, shard, ".todo");
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  const std::vector<std::string> lines = lines_of(*text);
  if (lines.empty() || lines.front() != plan.id) {
    return damaged_plan(file, "the list belongs to another plan");
  }
  std::vector<SourceFile> out;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    SourceFile& source = out.emplace_back();
    if (!read_source_line(lines[i], source) || source.source >= source_count) {
      return damaged_plan(file, "the list of the shard is damaged");
    }
  }
  return out;
}

Status write_shard_outcomes(const fs::path& library,
                            const ShardPlan& plan,
                            int shard,
                            const std::vector<SourceOutcome>& outcomes) {
  const auto current = read_shard_plan(library);
  if (!current || current->id != plan.id) {
    return bad_input(library.string(),
                     "the work was divided again while this shard was worked on",
                     "work on the shards of the new plan; finished objects are kept");
  }
  std::string text = plan.id + "\n";
  for (const SourceOutcome& outcome : outcomes) text += outcome_text(outcome) + "\n";
  return recordings::write_file(shard_file(library, shard, ".jsonl"), text, OnDisk::kNow);
}

Result<std::vector<SourceOutcome>> read_shard_outcomes(const fs::path& library,
                                                       const ShardPlan& plan,
                                                       int shard) {
  const fs::path file = shard_file(library, shard, ".jsonl");
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  const auto damaged = [&](const char* cause) {
    return bad_input(file.string(),
                     cause,
                     "delete the file, then call marey library work LIB --shard " +
                         std::to_string(shard));
  };
  const std::vector<std::string> lines = lines_of(*text);
  if (lines.empty() || lines.front() != plan.id) {
    return damaged("the outcomes belong to another plan");
  }
  std::vector<SourceOutcome> out;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    auto outcome = parse_outcome(lines[i]);
    if (!outcome) return damaged("the outcomes of the shard are damaged");
    out.push_back(std::move(*outcome));
  }
  return out;
}

std::vector<int> unfinished_shards(const fs::path& library, const ShardPlan& plan) {
  std::vector<int> out;
  for (int shard = 1; shard <= plan.shards; ++shard) {
    std::error_code failed;
    if (!fs::exists(shard_file(library, shard, ".jsonl"), failed)) out.push_back(shard);
  }
  return out;
}

void remove_shards(const fs::path& library) {
  const fs::path folder = recordings::LibraryPaths(library).shards();
  std::error_code ignored;
  fs::remove(folder / kPlanFile, ignored);
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end;
       at.increment(ignored)) {
    const std::string extension = at->path().extension().string();
    const bool is_ours =
        extension == ".todo" || extension == ".jsonl" || extension == ".log";
    if (is_ours) files.push_back(at->path());
  }
  for (const fs::path& file : files) fs::remove(file, ignored);
  fs::remove(folder, ignored);  // Stays if a user keeps files in it.
}

std::string slurm_script(const std::string& program,
                         const fs::path& library,
                         int shards) {
  const std::string folder = library.string();
  const std::string log =
      (recordings::LibraryPaths(library).shards() / "%a.log").string();
  // The number of the shard comes from Slurm, when the task runs.
  const std::string work = shell_command({program, "library", "work", folder}) +
                           " --shard $SLURM_ARRAY_TASK_ID --jobs 1";
  const std::string merge = shell_command({program, "library", "merge", folder});
  return "#!/bin/sh\n"
         "# Builds a library with Slurm: one task per shard, then the merge.\n"
         "# Add the options of your cluster (partition, time, memory) to both lines.\n"
         "set -e\n"
         "job=$(sbatch --parsable --requeue --array=1-" +
         std::to_string(shards) + " --output=" + shell_command({log}) +
         " --wrap=" + shell_command({work}) +
         ")\n"
         "sbatch --dependency=afterany:\"${job%%;*}\" --output=" +
         shell_command({folder + "/merge.log"}) + " --wrap=" + shell_command({merge}) +
         "\n";
}

}  // namespace marey::app
