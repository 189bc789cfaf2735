// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/base_sources.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "edit/state/edit_state.h"

#include "app/engine/base_recipe.h"
#include "app/library/find/clip_motions.h"
#include "app/library/find/query_clips.h"
#include "core/base/extension.h"
#include "core/base/in_quotes.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/library_records.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRecipeEnding = ".edit.toml";

constexpr std::array<std::string_view, 7> kMotionEndings{
    ".amc", ".bvh", ".glb", ".gltf", ".npz", ".vrm", ".vrma"};

bool is_recipe(const fs::path& file) {
  return file.string().ends_with(kRecipeEnding);
}

bool is_motion(const fs::path& file) {
  const std::string ending = kind_by_extension(file);
  return std::find(kMotionEndings.begin(), kMotionEndings.end(), ending) !=
         kMotionEndings.end();
}

/// Returns the name of a recipe's or motion's file without its ending.
std::string base_name_of(const fs::path& file) {
  const std::string name = file.filename().string();
  return is_recipe(file) ? name.substr(0, name.size() - kRecipeEnding.size())
                         : file.stem().string();
}

using BaseSources = Result<std::vector<engine::ClipSource>>;

Result<engine::ClipSource> read_library_clip(ClipMotions& motions,
                                             const ClipRecord& record) {
  auto read = motions.read(record);
  if (!read) return read.error();
  auto state =
      edit::make_edit_state(std::move(read->motion), std::move(read->uncertainty));
  if (!state) return state.error();
  std::vector<std::string> tags;
  for (const ClipLabel& label : record.labels) {
    if (label.by != "marey") tags.push_back(label.text);
    state->annotations.notes.push_back({label.text, label.start_s, label.end_s});
  }
  std::vector<Annotation>& notes = state->annotations.notes;
  std::sort(notes.begin(), notes.end(), [](const Annotation& a, const Annotation& b) {
    return a.start_s != b.start_s ? a.start_s < b.start_s : a.text < b.text;
  });
  engine::ClipSource source = clip_source_of(*std::move(state));
  source.tags = tags_of(source.annotations, std::move(tags));
  source.name = record.name;
  source.body = record.body;
  source.document_sha256 = record.provenance.source_id;
  return source;
}

BaseSources read_library_clips(const fs::path& library,
                               const std::string& query,
                               Console& console) {
  const auto found = run_clip_query(library, query);
  if (!found) return found.error();
  for (const std::string& remark : found->remarks) console.warn(remark);
  if (found->numbers.empty()) {
    return bad_input(library.string(),
                     "no clip of the library matches the query",
                     "try the expression with marey library query");
  }
  const auto records = recordings::read_library_records(
      recordings::LibraryPaths(library).index(), found->numbers);
  if (!records) return records.error();
  ClipMotions motions(library, OuterLinks::kRefuse);
  const Progress progress = console.stage("clips");
  std::vector<engine::ClipSource> out;
  for (const ClipRecord& record : *records) {
    auto source = read_library_clip(motions, record);
    if (!source) return source.error();
    out.push_back(*std::move(source));
    if (progress) {
      progress(static_cast<int>(out.size()), static_cast<int>(records->size()));
    }
  }
  return out;
}

BaseSources read_base_files(const std::vector<fs::path>& files, Console& console) {
  std::vector<engine::ClipSource> out;
  for (const fs::path& file : files) {
    auto sources = is_recipe(file) ? render_base_recipe(file, console)
                                   : read_base_motion(file, console);
    if (!sources) return sources.error();
    std::move(sources->begin(), sources->end(), std::back_inserter(out));
  }
  return out;
}

BaseSources read_base_path(const fs::path& path,
                           const BaseInputs& inputs,
                           Console& console) {
  std::error_code ignored;
  if (inputs.query || is_library(path)) {
    return read_library_clips(path, inputs.query.value_or(""), console);
  }
  if (!fs::is_directory(path, ignored)) return read_base_files({path}, console);
  const auto files = base_files_of(path);
  if (!files) return files.error();
  return read_base_files(*files, console);
}

/// Checks that names are all different, and marks the clips that loop.
Status name_clips(const BaseInputs& inputs,
                  const std::map<std::string, fs::path>& origins,
                  std::vector<engine::ClipSource>& sources) {
  for (const std::string& wanted : inputs.loops) {
    if (origins.contains(wanted)) continue;
    return bad_usage(
        "--loops",
        "no clip has the name " + in_quotes(wanted),
        "give the name of a clip, such as " + in_quotes(sources.front().name));
  }
  for (engine::ClipSource& source : sources) {
    const auto& loops = inputs.loops;
    if (std::find(loops.begin(), loops.end(), source.name) != loops.end()) {
      source.loops = true;
    }
  }
  return Done{};
}

}  // namespace

bool is_library(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(recordings::LibraryPaths(folder).index(), ignored);
}

Result<std::vector<fs::path>> base_files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::set<std::string> recipes;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    std::error_code ignored;
    if (!at->is_regular_file(ignored)) continue;
    if (is_recipe(at->path())) recipes.insert(base_name_of(at->path()));
    if (is_recipe(at->path()) || is_motion(at->path())) files.push_back(at->path());
  }
  if (problem) {
    return bad_input(
        folder.string(), "the folder cannot be read", "check its permissions");
  }
  std::erase_if(files, [&](const fs::path& file) {
    return !is_recipe(file) && recipes.contains(base_name_of(file));
  });
  std::sort(files.begin(), files.end());
  if (!files.empty()) return files;
  return bad_input(folder.string(),
                   "the folder holds no motion and no recipe",
                   "name a folder with .bvh, .amc, .npz, .glb, .gltf, .vrm, .vrma or "
                   ".edit.toml files, or a library");
}

Result<std::vector<engine::ClipSource>> read_base_sources(const BaseInputs& inputs,
                                                          Console& console) {
  std::vector<engine::ClipSource> out;
  std::map<std::string, fs::path> origins;
  for (const fs::path& path : inputs.paths) {
    auto sources = read_base_path(path, inputs, console);
    if (!sources) return sources.error();
    for (engine::ClipSource& source : *sources) {
      const auto [first, is_new] = origins.try_emplace(source.name, path);
      if (!is_new) {
        return bad_input(path.string(),
                         "a second clip has the name " + in_quotes(source.name) +
                             "; the first one is from " + first->second.string(),
                         "rename one of the files, or give the recipe another name");
      }
      out.push_back(std::move(source));
    }
  }
  if (const Status ok = name_clips(inputs, origins, out); !ok) return ok.error();
  return out;
}

}  // namespace marey::app
