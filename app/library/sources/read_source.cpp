// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/read_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "library/quality/rate_witnesses.h"

#include "app/library/sources/clean_motion.h"
#include "app/library/sources/marker_source.h"
#include "app/library/sources/recipe_source.h"
#include "app/library/sources/session_source.h"
#include "app/library/sources/source_kind.h"
#include "app/motion/error_of_file.h"
#include "app/motion/read_body.h"
#include "app/motion/retarget_files.h"
#include "core/base/printable.h"
#include "recordings/base/motion_limits.h"

namespace marey::app {
namespace {

std::string hz_text(double hz) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g Hz", hz);
  return text.data();
}

SourceMotion source_motion_of(ReadMotion read, const std::filesystem::path& path) {
  SourceMotion out;
  out.motion = std::move(read.motion);
  out.uncertainty = std::move(read.uncertainty);
  out.rates.file_hz = out.motion.rate.hz;
  out.rates.file_is_guessed = read.rate_is_guessed;
  out.figures.push_back(
      {"bones_mm", 1000.0 * read.ignored_translation_m, std::nullopt, "", std::nullopt});
  out.remarks = std::move(read.remarks);
  if (const auto note = left_out(read)) out.remarks.push_back(*note);
  if (const auto swapped = assess_exchanged_sides(
          path, read.exchanged, "a .bones.toml file next to the motion")) {
    out.remarks.push_back(swapped->cause + ". Next: " + swapped->next);
    const int last = static_cast<int>(out.motion.poses.size()) - 1;
    out.problems.push_back({{0, last}, "sides", "", 1.0});
  }
  return out;
}

/// Returns names of bodies for the animations of a glTF: their own, where these differ.
std::vector<std::string> names_of_animations(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_unique = std::ranges::count(names, names[i]) == 1;
    out.push_back(is_unique && !names[i].empty() ? printable(names[i])
                                                 : "animation " + std::to_string(i));
  }
  return out;
}

/// Reads a file of a body: its motion, or each animation of a glTF.
Result<std::vector<SourceMotion>> read_motion_file(const SourceFile& file) {
  BodyFile body(file.path);
  auto first = read_motion(body);
  if (!first) return first.error();
  const std::vector<std::string> names = names_of_animations(first->animations);
  std::vector<SourceMotion> all;
  all.push_back(source_motion_of(*std::move(first), file.path));
  if (names.size() < 2) return all;
  all.front().body = names.front();
  for (body.animation = 1; body.animation < names.size(); ++body.animation) {
    auto next = read_motion(body);
    if (!next) {
      all.front().remarks.push_back(names[body.animation] +
                                    " is left out: " + next.error().cause);
      continue;
    }
    all.push_back(source_motion_of(*std::move(next), file.path));
    all.back().body = names[body.animation];
  }
  return all;
}

bool holds_markers(const SourceFile& file) {
  return file.kind == "c3d" || file.kind == "trc";
}

/// Returns true if the motions of a source are solved from markers or tags.
bool is_solved(const SourceFile& file) {
  return holds_markers(file) || file.kind == kSessionKind;
}

Result<std::vector<SourceMotion>> read_by_kind(const SourceFile& file,
                                               std::optional<double> rate_hz,
                                               const std::filesystem::path& scratch) {
  if (file.kind == kSessionKind) return read_session_source(file.path, scratch);
  if (file.kind == kRecipeKind) return read_recipe_source(file.path, {rate_hz});
  if (holds_markers(file)) return read_marker_source(file.path, {rate_hz});
  return read_motion_file(file);
}

void replace_all(std::string& text, const std::string& old, const std::string& by) {
  if (old.empty()) return;
  for (std::size_t at = text.find(old); at != std::string::npos;
       at = text.find(old, at + by.size())) {
    text.replace(at, old.size(), by);
  }
}

/// Removes folders from remarks: the same file gives the same bytes in every folder.
void remove_paths(const SourceFile& file, std::vector<std::string>& remarks) {
  const std::string path = file.path.string();
  for (std::string& remark : remarks) {
    replace_all(remark, path + ": ", "");
    replace_all(remark, path, file.path.filename().string());
    if (!file.path.has_parent_path()) continue;
    replace_all(remark, file.path.parent_path().string() + "/", "");
  }
}

/// Returns the statement that differs most from the rate in use, as a sentence; nullopt:
/// none differs by the rule of choose_rate().
std::optional<std::string> contradiction(const library::RateWitnesses& witnesses,
                                         const library::StatedRate& used,
                                         const std::string& table_evidence) {
  if (used.figure.value <= 1.0) return std::nullopt;
  const std::string place = table_evidence.empty() ? "" : " (" + table_evidence + ")";
  struct Statement {
    RateBasis basis = RateBasis::kFile;
    std::string by;
    std::optional<double> hz = std::nullopt;
  };
  const std::array<Statement, 3> statements = {{
      {RateBasis::kOption, "library.toml", witnesses.option_hz},
      {RateBasis::kTable, "the index table" + place, witnesses.table_hz},
      {RateBasis::kFile, "the file", witnesses.file_hz},
  }};
  const auto off = [&](const Statement& one) {
    return one.hz ? std::abs(std::log(*one.hz / used.hz)) : 0.0;
  };
  const auto& counts = *std::ranges::find(statements, used.basis, &Statement::basis);
  const auto& differs = *std::ranges::max_element(statements, {}, off);
  return counts.by + " states " + hz_text(used.hz) + ", but " + differs.by + " states " +
         hz_text(*differs.hz);
}

/// Sets the rate that counts, and adds a remark and a figure on rates that differ.
void set_rate(const LibrarySource& source,
              const ReadSourceOptions& options,
              SourceMotion& out) {
  library::RateWitnesses witnesses;
  if (!out.rates.file_is_guessed) witnesses.file_hz = out.rates.file_hz;
  witnesses.table_hz = options.table_rate_hz;
  witnesses.option_hz = source.rate_hz;
  witnesses.table_duration_s = options.table_duration_s;
  witnesses.frames = static_cast<int>(out.motion.poses.size());
  if (library::is_resampled_copy(witnesses)) witnesses.table_hz.reset();
  const auto chosen = library::choose_rate(witnesses);
  library::StatedRate& used = out.rates.used;
  used.hz = out.rates.file_hz;
  if (chosen) used = *chosen;
  out.motion.rate.hz = used.hz;
  // Times in the source count by its own rate.
  const double longer = out.rates.file_hz / used.hz;
  for (ClipLabel& label : out.labels) {
    label.start_s *= longer;
    label.end_s *= longer;
  }
  if (!chosen) return;
  if (const auto differs = contradiction(witnesses, used, options.table_evidence)) {
    out.remarks.push_back(*differs);
  }
  out.figures.push_back(
      {std::string(used.figure.name), used.figure.value, std::nullopt, "", std::nullopt});
}

}  // namespace

void number_equal_bodies(std::vector<SourceMotion>& all) {
  std::set<std::string> names;
  for (const SourceMotion& motion : all) names.insert(motion.body);
  std::set<std::string> used;
  for (SourceMotion& motion : all) {
    if (used.insert(motion.body).second) continue;
    const std::string name = motion.body.empty() ? "body" : motion.body;
    for (std::size_t k = 2; names.contains(motion.body); ++k) {
      motion.body = name + " (" + std::to_string(k) + ")";
    }
    names.insert(motion.body);
    used.insert(motion.body);
  }
}

Result<std::vector<SourceMotion>> read_source(const SourceFile& file,
                                              const LibrarySource& source,
                                              const ReadSourceOptions& options) {
  const std::optional<double> stated_hz =
      source.rate_hz ? source.rate_hz : options.table_rate_hz;
  if (stated_hz &&
      !(*stated_hz >= recordings::kMinRateHz && *stated_hz <= recordings::kMaxRateHz)) {
    return bad_input(file.path.string(),
                     hz_text(*stated_hz) + " is no frame rate",
                     "state a rate from 0.1 to 2000 Hz in library.toml or its table");
  }
  auto all = read_by_kind(file, stated_hz, options.scratch);
  if (!all) return all;
  number_equal_bodies(*all);
  for (SourceMotion& motion : *all) {
    set_rate(source, options, motion);
    const Status ok = clean_motion(options.clean, is_solved(file), motion);
    if (!ok) return of_file(file.path, ok.error());
    std::ranges::sort(motion.figures, {}, &ClipFigure::name);
    remove_paths(file, motion.remarks);
  }
  return all;
}

}  // namespace marey::app
