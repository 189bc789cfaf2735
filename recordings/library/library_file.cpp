// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace {

constexpr int kLibraryFormat = 1;
constexpr std::string_view kLibraryPage = "library.md";
constexpr double kMaxLimit = 1e9;
constexpr double kMaxShift_s = 60.0;

constexpr std::array<std::string_view, 5> kSegmentWords = {
    "none", "labels", "stillness", "steps", "change"};
constexpr std::array<std::string_view, 3> kCleanWords = {"none", "repair", "ground"};
constexpr std::array<std::string_view, 5> kSkeletonWords = {
    "own", "marey", "smpl22", "lafan22", "humanoid"};

/// Returns the place of a word in a list. Mistake: it is not in it.
template <std::size_t Count>
std::size_t read_choice(TomlReader& in,
                        std::string_view key,
                        const std::array<std::string_view, Count>& words) {
  const std::string word = in.text(key);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  in.fail(key,
          in_quotes(word) + " is not a value of " + in_quotes(key),
          suggestion(word, std::span<const std::string_view>(words)));
  return 0;
}

std::string read_if(TomlReader& in, std::string_view key) {
  return in.has(key) ? in.text(key) : std::string();
}

LibrarySource read_library_source(TomlReader& in) {
  in.allow({"path",
            "kind",
            "licence",
            "origin",
            "commit",
            "attribution",
            "subject",
            "pattern",
            "index",
            "rate_hz",
            "skip"});
  LibrarySource source;
  source.line = in.line();
  source.path = in.text("path");
  if (source.path.empty()) {
    in.fail("path", "\"path\" is empty", "give a file or a folder");
  }
  source.kind = read_if(in, "kind");
  source.licence = read_if(in, "licence");
  source.origin = read_if(in, "origin");
  source.commit = read_if(in, "commit");
  source.attribution = read_if(in, "attribution");
  source.subject = read_if(in, "subject");
  source.pattern = read_if(in, "pattern");
  source.index = read_if(in, "index");
  if (in.has("rate_hz")) {
    source.rate_hz = in.number("rate_hz", {kMinRateHz, kMaxRateHz, "Hz"});
  }
  if (in.has("skip")) source.skip = in.texts("skip");
  return source;
}

void read_library_sources(TomlReader& root, LibrarySettings& out) {
  std::set<std::string> paths;
  for (TomlReader& table : root.tables("source")) {
    LibrarySource source = read_library_source(table);
    if (!paths.insert(source.path).second) {
      table.fail("path",
                 "the source " + in_quotes(source.path) + " is stated twice",
                 "remove one of them");
    }
    if (!root.ok()) return;
    out.sources.push_back(std::move(source));
  }
}

void read_limits(TomlReader in, LibrarySettings& out) {
  for (const std::string& figure : in.keys()) {
    const std::vector<double> pair = in.numbers(figure, 2);
    if (!in.ok()) return;
    const QualityLimit limit{figure, pair[0], pair[1]};
    if (limit.warn > limit.fail || std::abs(limit.fail) > kMaxLimit) {
      in.fail(figure,
              "the limits of " + in_quotes(figure) + " are not ascending",
              "write " + figure + " = [WARN, FAIL], the smaller one first");
    }
    out.limits.push_back(limit);
  }
  std::ranges::sort(out.limits, {}, &QualityLimit::figure);
}

/// Checks the name of a split: it becomes a part of names of files.
bool is_split_name(std::string_view name) {
  constexpr std::size_t kMaxLetters = 32;
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789_-";
  return !name.empty() && name.size() <= kMaxLetters &&
         name.find_first_not_of(kLetters) == std::string_view::npos;
}

void read_splits(TomlReader in, LibrarySettings& out) {
  out.splits.clear();
  double sum = 0.0;
  for (const std::string& name : in.keys()) {
    if (!is_split_name(name)) {
      in.fail(name,
              in_quotes(name) + " cannot be the name of a split",
              "write 1 to 32 of the characters a to z, 0 to 9, _ and -");
    }
    const double share = in.number(name, {0.0, 1.0, "of all clips"});
    sum += share;
    out.splits.emplace_back(name, share);
  }
  constexpr double kTolerance = 1e-6;
  if (in.ok() && std::abs(sum - 1.0) > kTolerance) {
    in.fail("",
            "the shares of the splits add up to another number than 1",
            "write for example train = 0.8, val = 0.1, test = 0.1");
  }
}

void read_duplicates(TomlReader in, LibrarySettings& out) {
  in.allow({"max_distance", "max_body_distance", "max_shift_s", "min_cover_share"});
  DuplicateRule& rule = out.duplicates;
  if (in.has("max_distance")) {
    rule.max_distance = in.number("max_distance", {0.0, 100.0});
  }
  if (in.has("max_body_distance")) {
    rule.max_body_distance = in.number("max_body_distance", {0.0, 100.0});
  }
  if (in.has("max_shift_s")) {
    rule.max_shift_s = in.number("max_shift_s", {0.0, kMaxShift_s, "s"});
  }
  if (in.has("min_cover_share")) {
    rule.min_cover_share = in.number("min_cover_share", {0.0, 1.0});
  }
}

void read_format(TomlReader& root) {
  const int format = root.integer("format", {1, 1e6});
  if (format <= kLibraryFormat || !root.ok()) return;
  root.fail("format",
            "the library needs format " + std::to_string(format) + ", this marey reads " +
                std::to_string(kLibraryFormat),
            "update marey");
}

void read_tables(TomlReader& root, LibrarySettings& out) {
  if (root.has("quality")) read_limits(root.table("quality"), out);
  if (root.has("duplicates")) read_duplicates(root.table("duplicates"), out);
  if (root.has("splits")) read_splits(root.table("splits"), out);
  if (root.has("segment")) {
    TomlReader segment = root.table("segment");
    segment.allow({"by"});
    out.segment = static_cast<SegmentBy>(read_choice(segment, "by", kSegmentWords));
  }
  if (root.has("clean")) {
    out.clean = static_cast<CleanBy>(read_choice(root, "clean", kCleanWords));
  }
}

}  // namespace

Result<LibrarySettings> parse_library(std::string_view text, const std::string& file) {
  auto document = parse_toml(text, file, kLibraryPage);
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"format",
              "name",
              "skeleton",
              "rate_hz",
              "clean",
              "source",
              "quality",
              "segment",
              "duplicates",
              "splits"});
  LibrarySettings out;
  read_format(root);
  out.name = root.text("name");
  if (root.has("skeleton")) {
    out.skeleton = kSkeletonWords[read_choice(root, "skeleton", kSkeletonWords)];
  }
  if (root.has("rate_hz")) {
    out.rate_hz = root.number("rate_hz", {kMinRateHz, kMaxRateHz, "Hz"});
  }
  read_library_sources(root, out);
  read_tables(root, out);
  if (document->mistake) return *document->mistake;
  return out;
}

Result<LibrarySettings> read_library(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_library(*text, path.string());
}

std::string new_library_text(std::string_view name) {
  TomlWriter out;
  out.comment("A motion library of marey: docs/formats/library.md.");
  out.integer("format", kLibraryFormat);
  out.text("name", name);
  return out.str();
}

std::string with_source(std::string text, const LibrarySource& source) {
  TomlWriter out;
  out.array_table("source");
  out.text("path", source.path);
  const auto text_if = [&](std::string_view key, const std::string& value) {
    if (!value.empty()) out.text(key, value);
  };
  text_if("kind", source.kind);
  text_if("licence", source.licence);
  text_if("origin", source.origin);
  text_if("commit", source.commit);
  text_if("attribution", source.attribution);
  text_if("subject", source.subject);
  text_if("pattern", source.pattern);
  text_if("index", source.index);
  if (source.rate_hz) out.number("rate_hz", *source.rate_hz);
  if (!source.skip.empty()) {
    const std::vector<std::string_view> skip(source.skip.begin(), source.skip.end());
    out.texts("skip", skip);
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  return std::move(text) + out.str();
}

}  // namespace marey::recordings
