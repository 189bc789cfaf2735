// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/add_sources.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/library/sources/index_table.h"
#include "app/library/sources/licence.h"
#include "app/library/sources/list_sources.h"
#include "core/base/in_quotes.h"
#include "core/library/library_settings.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/library/library_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns a path as library.toml has it: relative to the library if it is below it.
std::string stored_path(const fs::path& library, const fs::path& path) {
  std::error_code failed;
  const fs::path full = fs::absolute(path, failed).lexically_normal();
  const fs::path folder = fs::absolute(library, failed).lexically_normal();
  fs::path below = full.lexically_relative(folder);
  if (below.empty() || *below.begin() == "..") below = full;
  std::string text = below.generic_string();
  while (text.size() > 1 && text.ends_with('/')) text.pop_back();
  return text;
}

Result<std::string> licence_of(const AddSourcesArguments& args) {
  if (args.licence.empty()) {
    return bad_input("--licence",
                     "the licence of the sources is not given",
                     "give it as an SPDX expression such as CC-BY-4.0, or \"unknown\"");
  }
  std::error_code failed;
  if (fs::is_regular_file(args.licence, failed)) {
    return stored_path(args.library, args.licence);
  }
  return spdx_licence(args.licence);
}

/// Makes the [[source]] of a path.
Result<LibrarySource> make_source(const AddSourcesArguments& args, const fs::path& path) {
  LibrarySource source;
  source.path = stored_path(args.library, path);
  auto licence = licence_of(args);
  if (!licence) return licence.error();
  source.licence = *std::move(licence);
  source.origin = args.origin;
  source.commit = args.commit;
  source.attribution = args.attribution;
  source.kind = args.kind;
  source.rate_hz = args.rate_hz;
  source.subject = args.subject;
  source.pattern = args.pattern;
  source.skip = args.skip;
  if (!args.index.empty()) source.index = stored_path(args.library, args.index);
  return source;
}

Status check_rate_and_index(const AddSourcesArguments& args) {
  const bool is_rate = !args.rate_hz || (*args.rate_hz >= recordings::kMinRateHz &&
                                         *args.rate_hz <= recordings::kMaxRateHz);
  if (!is_rate) {
    return bad_input("--rate", "the rate is not 0.1 to 2000 Hz", "correct it");
  }
  if (args.index.empty()) return Done{};
  const auto table = IndexTable::read(args.index);
  return table ? Status(Done{}) : Status(table.error());
}

/// Checks that patterns fit at least one file.
Status check_patterns(const LibrarySource& source, const std::vector<SourceFile>& files) {
  const bool has_subject = source.subject.find('{') != std::string::npos;
  const auto fits_any = [&](const auto& fits) {
    return std::ranges::any_of(files, fits);
  };
  if (has_subject && !fits_any([&](const SourceFile& file) {
        return !subject_of(file, source).empty();
      })) {
    return bad_input("--subject",
                     in_quotes(source.subject) + " fits no file of " +
                         in_quotes(source.path) + ", such as " +
                         in_quotes(files.front().name),
                     "give a name, or a pattern with {subject} and *");
  }
  LibrarySource labels = source;
  labels.subject.clear();
  if (!source.pattern.empty() && !fits_any([&](const SourceFile& file) {
        return !labels_of_name(file, labels, 1.0).empty() ||
               !subject_of(file, labels).empty();
      })) {
    return bad_input("--pattern",
                     in_quotes(source.pattern) + " fits no file of " +
                         in_quotes(source.path) + ", such as " +
                         in_quotes(files.front().name),
                     "write words in braces for the parts that differ, and * for any "
                     "text: {subject}_{content}_*");
  }
  return Done{};
}

/// Checks a source against the sources before it, and adds it to the settings.
Status adopt_source(const AddSourcesArguments& args,
                    const LibrarySource& source,
                    LibrarySettings& settings) {
  const auto known =
      std::ranges::find(settings.sources, source.path, &LibrarySource::path);
  const std::string file = (args.library / "library.toml").string();
  if (known != settings.sources.end()) {
    return bad_input(known->line > 0 ? file + ":" + std::to_string(known->line) : file,
                     "the source " + in_quotes(source.path) + " is stated already",
                     "change its entry in library.toml, or name other files");
  }
  LibrarySettings alone;
  alone.sources = {source};
  auto listing = list_sources(args.library, alone);
  if (!listing) {
    Error error = listing.error();
    error.where = source.path;
    return error;
  }
  if (const Status ok = check_patterns(source, listing->files); !ok) return ok;
  settings.sources.push_back(source);
  const auto all = list_sources(args.library, settings);
  if (!all) return all.error();
  const std::size_t place = settings.sources.size() - 1;
  if (std::ranges::find(all->files, place, &SourceFile::source) != all->files.end()) {
    return Done{};
  }
  return bad_input(source.path,
                   "all its files belong to sources that " + file + " states already",
                   "change the entry of these sources, or name other files");
}

}  // namespace

Status add_sources(const AddSourcesArguments& args) {
  std::error_code failed;
  if (fs::exists(args.library, failed) && !fs::is_directory(args.library, failed)) {
    return bad_input(args.library.string(),
                     "is a file, but a library is a folder",
                     "give a folder that exists, or a new one");
  }
  if (args.paths.empty()) {
    return bad_input("FILE", "no source is given", "name files or folders");
  }
  if (const Status ok = check_rate_and_index(args); !ok) return ok;
  const fs::path file = args.library / "library.toml";
  const fs::path full = fs::absolute(args.library, failed).lexically_normal();
  const fs::path folder = full.has_filename() ? full : full.parent_path();
  std::string text = recordings::new_library_text(folder.filename().string());
  if (fs::exists(file, failed)) {
    auto known = recordings::read_file(file);
    if (!known) return known.error();
    text = *std::move(known);
  }
  auto settings = recordings::parse_library(text, file.string());
  if (!settings) return settings.error();
  for (const fs::path& path : args.paths) {
    const auto source = make_source(args, path);
    if (!source) return source.error();
    if (const Status ok = adopt_source(args, *source, *settings); !ok) return ok;
    text = recordings::with_source(std::move(text), *source);
  }
  // A file that could not be read again must not replace one that can.
  if (const auto check = recordings::parse_library(text, file.string()); !check) {
    return check.error();
  }
  return recordings::write_file(file, text);
}

}  // namespace marey::app
