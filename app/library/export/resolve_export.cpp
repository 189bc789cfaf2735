// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "app/library/export/export_commands.h"
#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

/// Returns the licences of an option: the list, and the whole text, which may be that of
/// a licence with commas.
void add_licences(const std::string& list, std::vector<std::string>& out) {
  out.push_back(list);
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    std::size_t first = begin;
    while (first < end && list[first] == ' ') ++first;
    if (first < end) out.push_back(list.substr(first, end - first));
    begin = end + 1;
  }
}

}  // namespace

Result<ExportOptions> resolve_export(const LibraryExportArguments& args,
                                     const LibrarySettings& settings) {
  ExportOptions out;
  const auto format = export_format(args.format);
  if (!format) {
    return bad_usage("--as",
                     in_quotes(args.format) + " is no layout",
                     "read marey library export --help");
  }
  out.library = args.library;
  out.out = args.out;
  out.format = *format;
  out.query = args.query;
  out.skeleton = skeleton_of_export(*format, args.skeleton, settings);
  out.rate_hz = args.rate_hz ? args.rate_hz : settings.rate_hz;
  out.adds_mirrored = args.mirror;
  out.starts_at_origin = args.start_at_origin;
  out.splits = settings.splits;
  if (!args.split.empty()) {
    auto splits = parse_split(args.split);
    if (!splits) return splits.error();
    out.splits = *std::move(splits);
  }
  out.split_by =
      args.split_by == "clip" ? library::SplitBy::kClip : library::SplitBy::kSubject;
  for (const std::string& list : args.allowed_licences) {
    add_licences(list, out.allowance.licences);
  }
  out.allowance.allows_unknown = args.licence_unknown;
  out.replaces = args.replace;
  return out;
}

}  // namespace marey::app
