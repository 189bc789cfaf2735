// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/version_file.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <system_error>
#include <utility>

#include "core/base/format_text.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_paths.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kVersionHead = "marey library version 1\n";
constexpr std::size_t kDigestDigits = 16;
constexpr std::size_t kValues = 8;

std::string digest(const ClipRecord& record) {
  return sha256(clip_record_text(record)).substr(0, kDigestDigits);
}

std::string in_one_line(std::string text) {
  for (char& c : text) {
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::vector<std::string> values_of(std::string_view line) {
  std::vector<std::string> out;
  for (;;) {
    const std::size_t tab = line.find('\t');
    out.emplace_back(line.substr(0, tab));
    if (tab == std::string_view::npos) return out;
    line.remove_prefix(tab + 1);
  }
}

ClipChange change_of(const VersionLine* before, const VersionLine* after) {
  ClipChange out;
  out.clip_id = after ? after->clip_id : before->clip_id;
  out.name = after ? after->name : before->name;
  if (before) out.quality_before = before->quality;
  if (after) out.quality_after = after->quality;
  if (!before || !after) return out;
  out.has_new_source = before->source_id != after->source_id;
  out.has_new_motion = before->object_key != after->object_key && !out.has_new_source;
  out.has_new_labels = before->labels != after->labels;
  out.has_new_licence = before->licence != after->licence;
  out.has_new_name = before->name != after->name;
  out.has_new_state = before->state != after->state;
  return out;
}

bool is_same(const VersionLine& a, const VersionLine& b) {
  return a.object_key == b.object_key && a.quality == b.quality && a.labels == b.labels &&
         a.state == b.state && a.licence == b.licence && a.name == b.name;
}

/// Joins a clip that went with one of the same name that came.
void join_by_name(std::vector<const VersionLine*>& went,
                  std::vector<const VersionLine*>& came,
                  std::vector<ClipChange>& out) {
  std::multimap<std::string, const VersionLine*> by_name;
  for (const VersionLine* line : came) by_name.emplace(line->name, line);
  for (const VersionLine* line : went) {
    const auto found = by_name.find(line->name);
    if (found == by_name.end()) {
      out.push_back(change_of(line, nullptr));
      continue;
    }
    out.push_back(change_of(line, found->second));
    by_name.erase(found);
  }
  for (const auto& [name, line] : by_name) out.push_back(change_of(nullptr, line));
}

}  // namespace

VersionLine version_line(const ClipRecord& record) {
  VersionLine out;
  out.clip_id = record.clip_id;
  out.object_key = record.object_key;
  out.quality = name(record.quality);
  out.source_id = record.provenance.source_id;
  out.licence = in_one_line(record.provenance.licence);
  out.name = in_one_line(record.name);
  ClipRecord labels;
  labels.labels = record.labels;
  out.labels = digest(labels);
  ClipRecord rest = record;
  rest.labels.clear();
  // Paths are no part of a version: a moved source is the same.
  rest.provenance.path.clear();
  out.state = digest(rest);
  return out;
}

std::string version_text(std::vector<VersionLine> lines) {
  std::ranges::sort(lines, {}, &VersionLine::clip_id);
  std::string out(kVersionHead);
  for (const VersionLine& line : lines) {
    const std::string* values[] = {&line.clip_id,
                                   &line.object_key,
                                   &line.quality,
                                   &line.labels,
                                   &line.state,
                                   &line.source_id,
                                   &line.licence,
                                   &line.name};
    static_assert(std::size(values) == kValues);
    for (std::size_t i = 0; i < kValues; ++i) {
      out += *values[i];
      out += i + 1 < kValues ? '\t' : '\n';
    }
  }
  return out;
}

Result<std::vector<VersionLine>> parse_version(std::string_view text,
                                               const std::string& file) {
  const std::string next = "restore the file, or leave this version out";
  if (!text.starts_with(kVersionHead)) {
    return bad_input(file, "it is no version of a library that this marey reads", next);
  }
  text.remove_prefix(kVersionHead.size());
  std::vector<VersionLine> out;
  int number = 1;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    const std::vector<std::string> v = values_of(text.substr(0, end));
    if (v.size() != kValues || end == std::string_view::npos) {
      return bad_input(file + ":" + std::to_string(number), "the line is damaged", next);
    }
    out.push_back({v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]});
    text.remove_prefix(end + 1);
  }
  std::ranges::sort(out, {}, &VersionLine::clip_id);
  return out;
}

std::vector<LibraryVersion> list_versions(const fs::path& library) {
  std::vector<LibraryVersion> out;
  std::error_code failed;
  for (fs::directory_iterator at(LibraryPaths(library).versions(), failed), end;
       !failed && at != end;
       at.increment(failed)) {
    if (at->path().extension() != ".txt") continue;
    const std::string stem = at->path().stem().string();
    int number = 0;
    const auto read = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    const bool is_number =
        read.ec == std::errc() && read.ptr == stem.data() + stem.size();
    if (!is_number || version_path(library, number).filename() != at->path().filename()) {
      continue;
    }
    out.push_back({number, at->path()});
  }
  std::ranges::sort(out, {}, &LibraryVersion::number);
  return out;
}

fs::path version_path(const fs::path& library, int number) {
  return LibraryPaths(library).versions() / format_text("%04d.txt", number);
}

std::vector<ClipChange> compare_versions(std::span<const VersionLine> before,
                                         std::span<const VersionLine> after) {
  std::vector<ClipChange> out;
  std::vector<const VersionLine*> went;
  std::vector<const VersionLine*> came;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < before.size() || j < after.size()) {
    const bool is_old =
        j == after.size() || (i < before.size() && before[i].clip_id < after[j].clip_id);
    const bool is_new =
        i == before.size() || (j < after.size() && after[j].clip_id < before[i].clip_id);
    if (is_old) {
      went.push_back(&before[i++]);
    } else if (is_new) {
      came.push_back(&after[j++]);
    } else {
      if (!is_same(before[i], after[j])) out.push_back(change_of(&before[i], &after[j]));
      ++i;
      ++j;
    }
  }
  join_by_name(went, came, out);
  std::ranges::sort(out, [](const ClipChange& a, const ClipChange& b) {
    return std::tie(a.name, a.clip_id) < std::tie(b.name, b.clip_id);
  });
  return out;
}

}  // namespace marey::recordings
