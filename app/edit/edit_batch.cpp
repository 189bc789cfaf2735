// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_batch.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include <fnmatch.h>

#include "app/edit/marker_edit_run.h"
#include "app/shell/findings.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/base/parallel.h"
#include "recordings/base/atomic_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

bool has_wildcard(const std::string& name) {
  return name.find_first_of("*?") != std::string::npos;
}

/// Returns true if a name has the pattern. Only * and ? stand for other characters.
bool has_pattern(const std::string& pattern, const std::string& name) {
  std::string plain;
  for (const char c : pattern) plain += c == '[' ? std::string("[[]") : std::string(1, c);
  return fnmatch(plain.c_str(), name.c_str(), FNM_PERIOD | FNM_NOESCAPE) == 0;
}

/// Adds what the parts of a pattern from `part` on name below `folder`.
void expand(const fs::path& folder,
            const std::vector<std::string>& parts,
            std::size_t part,
            std::vector<fs::path>& out) {
  std::error_code failed;
  const bool is_last = part + 1 == parts.size();
  const auto add = [&](const fs::path& path) {
    if (is_last) {
      if (fs::is_regular_file(path, failed)) out.push_back(path);
    } else if (fs::is_directory(path, failed)) {
      expand(path, parts, part + 1, out);
    }
  };
  if (!has_wildcard(parts[part])) return add(folder / parts[part]);
  const fs::path listed = folder.empty() ? fs::path(".") : folder;
  for (const auto& entry : fs::directory_iterator(listed, failed)) {
    const std::string name = entry.path().filename().string();
    if (has_pattern(parts[part], name)) add(folder / name);
  }
}

/// Result of one motion or of the markers of one file.
struct BatchRow {
  std::vector<EditFigures> figures;
  std::vector<Finding> findings;  ///< Figures above their limit.
  std::vector<Finding> lost;      ///< Content of a source that the results lack.
  std::optional<Error> error;
  bool has_markers = false;
};

BatchRow edit_one_marker_file(EditRecipe recipe,
                              const MarkerEditRunOptions& options,
                              const EditOutput& output,
                              bool writes) {
  BatchRow row;
  row.has_markers = true;
  auto run = run_marker_edit(std::move(recipe), options);
  if (!run) {
    row.error = run.error();
    return row;
  }
  row.figures = run->figures;
  row.findings = assess_edit(run->recipe, run->figures);
  row.lost = assess_marker_content(run->recipe, run->files, run->rendered, output);
  if (!writes) return row;
  const auto written =
      write_marker_edit(run->recipe, run->files, run->rendered, run->figures, output);
  if (!written) row.error = written.error();
  return row;
}

BatchRow edit_one(EditRecipe recipe,
                  const fs::path& recipe_file,
                  const fs::path& motion,
                  const EditOutput& output,
                  const EditBatchOptions& batch) {
  std::error_code failed;
  recipe.sources.front().path = fs::absolute(motion, failed).string();
  recipe.sources.front().sha256.clear();
  BatchRow row;
  const ReadEditOptions read = options_of_reading(recipe_file, batch.run);
  const bool has_markers = edits_markers(recipe, read);
  if (const Status ok = check_output_formats(output, has_markers); !ok) {
    row.error = ok.error();
    return row;
  }
  if (has_markers) {
    return edit_one_marker_file(
        std::move(recipe), {read, batch.run.until}, output, !batch.check);
  }
  auto files = read_edit_files(recipe, read);
  if (!files) {
    row.error = files.error();
    return row;
  }
  edit::RenderOptions options;
  options.recipe_file = recipe_file.string();
  options.until = batch.run.until;
  const auto rendered = edit::render(recipe, std::move(files->inputs), options);
  if (!rendered) {
    row.error = rendered.error();
    return row;
  }
  row.figures = measure_edit(recipe, *files, *rendered);
  row.findings = assess_edit(recipe, row.figures);
  if (batch.check) return row;
  const auto written = write_edit(recipe, *files, *rendered, row.figures, output);
  if (!written) row.error = written.error();
  return row;
}

std::string csv_text(std::string text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

std::string csv_of(const std::vector<fs::path>& motions,
                   const std::vector<std::string>& names,
                   const std::vector<BatchRow>& rows) {
  std::string out =
      "name,source,frames,duration_s,slide_mm,slide_cm_per_s,displaced_mm,"
      "acceleration_ratio,constraint_mm,inferred_frames,error\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string source = csv_text(motions[i].string());
    if (rows[i].error) {
      out += csv_text(names[i]) + "," + source + ",,,,,,,,," +
             csv_text(rows[i].error->message()) + "\n";
      continue;
    }
    for (const EditFigures& f : rows[i].figures) {
      out += csv_text(f.name) + "," + source +
             format_text(",%d,%.6g,", f.frames, f.duration_s);
      // Figures that need a body are empty for markers.
      if (!rows[i].has_markers) {
        out += format_text("%.6g,%.6g", f.slide_mm, f.slide_cm_per_s);
      } else {
        out += ",";
      }
      out += format_text(",%.6g,%.6g,", f.displaced_mm, f.acceleration_ratio);
      if (!rows[i].has_markers) out += format_text("%.6g", f.constraint_mm);
      out += format_text(",%d,", f.inferred_frames);
      if (!rows[i].findings.empty()) out += csv_text(rows[i].findings.front().message());
      out += "\n";
    }
  }
  return out;
}

}  // namespace

Result<std::vector<fs::path>> files_of_pattern(const std::string& pattern) {
  std::vector<std::string> parts;
  fs::path root;
  for (const fs::path& part : fs::path(pattern)) {
    if (part.is_absolute()) {
      root = part;
    } else if (!part.empty()) {
      parts.push_back(part.string());
    }
  }
  std::vector<fs::path> out;
  if (!parts.empty()) expand(root, parts, 0, out);
  std::sort(out.begin(), out.end());
  if (!out.empty()) return out;
  return bad_input("--each",
                   "no file has the pattern " + in_quotes(pattern),
                   "write it in quotation marks, such as 'takes/*/motion.npz'");
}

std::vector<std::string> names_of_files(const std::vector<fs::path>& files) {
  std::vector<std::vector<std::string>> parts;
  for (const fs::path& file : files) {
    std::vector<std::string> path;
    for (const fs::path& part : file.parent_path() / file.stem()) {
      path.push_back(part.string());
    }
    parts.push_back(std::move(path));
  }
  std::size_t common = 0;
  const auto all_share = [&](std::size_t place) {
    return std::all_of(parts.begin(), parts.end(), [&](const auto& path) {
      return place + 1 < path.size() && path[place] == parts.front()[place];
    });
  };
  while (!parts.empty() && all_share(common)) ++common;
  std::vector<std::string> out;
  std::set<std::string> uses;
  for (const auto& path : parts) {
    std::string name;
    for (std::size_t i = common; i < path.size(); ++i) {
      name += (name.empty() ? "" : ".") + path[i];
    }
    // Two files of one name with different extensions. The number may be another's name.
    std::string own = name;
    for (int count = 2; !uses.insert(own).second; ++count) {
      own = name + "." + std::to_string(count);
    }
    out.push_back(std::move(own));
  }
  return out;
}

Exit run_edit_batch(const EditRecipe& recipe,
                    const fs::path& recipe_file,
                    const std::vector<fs::path>& motions,
                    EditOutput output,
                    const EditBatchOptions& options,
                    Console& console) {
  const std::vector<std::string> names = names_of_files(motions);
  std::vector<BatchRow> rows(motions.size());
  std::error_code failed_path;
  for (const fs::path& motion : motions) {
    output.kept.push_back(fs::weakly_canonical(motion, failed_path));
  }
  const Progress progress = console.stage("edit");
  std::mutex mutex;
  int done = 0;
  in_parallel(motions.size(), 0, [&](std::size_t i) {
    EditRecipe own = recipe;
    own.name = names[i];
    rows[i] = edit_one(std::move(own), recipe_file, motions[i], output, options);
    const std::scoped_lock lock(mutex);
    progress(++done, static_cast<int>(motions.size()));
  });
  int failed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].error) {
      Error error = *rows[i].error;
      if (error.where.find(motions[i].string()) == std::string::npos) {
        error.where = motions[i].string() + ": " + error.where;
      }
      console.fail(error);
    }
    for (const Finding& finding : rows[i].findings) console.fail(finding.error());
    print_warnings(console, rows[i].lost);
    if (rows[i].error || !rows[i].findings.empty()) ++failed;
  }
  const auto count = motions.size();
  const std::string succeeded = std::to_string(count - static_cast<std::size_t>(failed)) +
                                " of " + std::to_string(count) + " motions edited; ";
  if (options.check) {
    console.say(succeeded + "nothing was written");
  } else {
    const fs::path table = output.out / "edit.csv";
    const Status ok = recordings::write_file(table, csv_of(motions, names, rows));
    if (!ok) return console.fail(ok.error());
    console.say(succeeded + table.string() + " has their figures");
  }
  return failed == 0 ? Exit::kOk : Exit::kQualityGate;
}

}  // namespace marey::app
