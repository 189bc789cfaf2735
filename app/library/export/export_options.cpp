// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

constexpr std::array kExportFormats{ExportFormat::kNpz,
                                    ExportFormat::kBvh,
                                    ExportFormat::kGlb,
                                    ExportFormat::kVrma,
                                    ExportFormat::kAmass,
                                    ExportFormat::kJoints22,
                                    ExportFormat::kShards,
                                    ExportFormat::kPack,
                                    ExportFormat::kMatching,
                                    ExportFormat::kTable};

constexpr std::array<std::string_view, kExportFormats.size()> kExportWords{"npz",
                                                                           "bvh",
                                                                           "glb",
                                                                           "vrma",
                                                                           "amass",
                                                                           "joints22",
                                                                           "shards",
                                                                           "pack",
                                                                           "matching",
                                                                           "table"};

Error no_split(const std::string& text, const std::string& cause) {
  return bad_usage("--split",
                   in_quotes(text) + " " + cause,
                   "give percentages of train, val and test, such as 80/10/10");
}

}  // namespace

std::span<const ExportFormat> export_formats() {
  return kExportFormats;
}

std::string_view name(ExportFormat format) {
  return kExportWords[static_cast<std::size_t>(format)];
}

std::optional<ExportFormat> export_format(std::string_view name) {
  for (std::size_t i = 0; i < kExportWords.size(); ++i) {
    if (kExportWords[i] == name) return kExportFormats[i];
  }
  return std::nullopt;
}

std::string skeleton_of_export(ExportFormat format,
                               const std::string& given,
                               const LibrarySettings& settings) {
  if (!given.empty()) return given;
  if (format == ExportFormat::kAmass || format == ExportFormat::kJoints22) {
    return "smpl22";
  }
  const bool needs_one =
      format == ExportFormat::kPack || format == ExportFormat::kMatching;
  return needs_one && settings.skeleton == "own" ? "marey" : settings.skeleton;
}

Result<SplitShares> parse_split(const std::string& text) {
  std::vector<double> shares;
  double sum = 0.0;
  const char* at = text.data();
  const char* end = at + text.size();
  while (true) {
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(at, end, value);
    if (problem != std::errc{} || !std::isfinite(value) || value < 0.0) {
      return no_split(text, "is no list of percentages");
    }
    shares.push_back(value / 100.0);
    sum += value;
    if (stop == end) break;
    if (*stop != '/') return no_split(text, "is no list of percentages");
    at = stop + 1;
  }
  if (shares.size() > 3) return no_split(text, "has more than three percentages");
  if (std::abs(sum - 100.0) > 1e-6) return no_split(text, "does not add up to 100");
  SplitShares out;
  out.emplace_back("train", shares[0]);
  if (shares.size() == 3) out.emplace_back("val", shares[1]);
  if (shares.size() >= 2) out.emplace_back("test", shares.back());
  return out;
}

bool changes_clip(const ExportOptions& options, double clip_rate_hz) {
  if (options.format == ExportFormat::kTable) return false;
  return options.skeleton != "own" || options.adds_mirrored || options.starts_at_origin ||
         options.format == ExportFormat::kMatching ||
         options.format == ExportFormat::kJoints22 ||
         options.format == ExportFormat::kAmass ||
         (options.rate_hz && *options.rate_hz != clip_rate_hz);
}

}  // namespace marey::app
