// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/read_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/motion/read_body.h"
#include "app/motion/retarget_files.h"

namespace marey::app {
namespace {

std::string hz_text(double hz) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g Hz", hz);
  return text.data();
}

/// Reads a file of a body and its motion.
Result<std::vector<SourceMotion>> read_motion_file(const SourceFile& file) {
  auto read = read_motion(BodyFile(file.path));
  if (!read) return read.error();
  SourceMotion out;
  out.motion = std::move(read->motion);
  out.uncertainty = std::move(read->uncertainty);
  out.rates.file_hz = out.motion.rate.hz;
  out.rates.file_is_guessed = read->rate_is_guessed;
  out.figures.push_back(
      {"bones_mm", 1000.0 * read->ignored_translation_m, std::nullopt, "", std::nullopt});
  out.remarks = std::move(read->remarks);
  if (const auto note = left_out(*read)) out.remarks.push_back(*note);
  if (const auto swapped = assess_exchanged_sides(
          file.path, read->exchanged, "a .bones.toml file next to the motion")) {
    out.remarks.push_back(swapped->cause + ": " + swapped->next);
    const int last = static_cast<int>(out.motion.poses.size()) - 1;
    out.problems.push_back({{0, last}, "sides", "", 1.0});
  }
  std::vector<SourceMotion> all;
  all.push_back(std::move(out));
  return all;
}

/// Sets the rate that counts, and adds a problem where stated rates differ.
void set_rate(const LibrarySource& source,
              const ReadSourceOptions& options,
              SourceMotion& out) {
  out.rates.option_hz = source.rate_hz;
  out.rates.table_hz = options.table_rate_hz;
  out.motion.rate.hz = out.rates.used_hz();
  if (const auto differs = out.rates.contradiction()) {
    out.remarks.push_back(*differs);
    const int last = static_cast<int>(out.motion.poses.size()) - 1;
    out.problems.push_back({{0, last}, "rate", "", out.rates.file_hz});
  }
}

}  // namespace

std::optional<std::string> SourceRates::contradiction() const {
  constexpr double kSame = 0.005;
  const auto differ = [](double a, double b) {
    return std::abs(a - b) > kSame * std::max(a, b);
  };
  std::vector<std::pair<std::string, double>> stated;
  if (option_hz) stated.emplace_back("library.toml", *option_hz);
  if (table_hz) stated.emplace_back("the index table", *table_hz);
  if (!file_is_guessed) stated.emplace_back("the file", file_hz);
  for (std::size_t i = 1; i < stated.size(); ++i) {
    if (!differ(stated[0].second, stated[i].second)) continue;
    return stated[0].first + " states " + hz_text(stated[0].second) + ", but " +
           stated[i].first + " states " + hz_text(stated[i].second);
  }
  return std::nullopt;
}

Result<std::vector<SourceMotion>> read_source(const SourceFile& file,
                                              const LibrarySource& source,
                                              const ReadSourceOptions& options) {
  if (options.clean != CleanBy::kNone) {
    return bad_input(file.path.string(),
                     "motions of this kind cannot be cleaned",
                     "set clean = \"none\" in library.toml");
  }
  auto all = read_motion_file(file);
  if (!all) return all;
  for (SourceMotion& motion : *all) set_rate(source, options, motion);
  return all;
}

}  // namespace marey::app
