// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/features/feature_span.h"
#include <gtest/gtest.h>

#include "core/library/clip_record.h"
#include "recordings/library/library_index.h"
#include "recordings/library/rows_file.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {

/// A clip of a library without motions: its record and its features.
struct SearchClip {
  ClipRecord record;
  std::vector<float> rows;
};

/// Returns `count` rows that change smoothly: three waves in every column.
inline std::vector<float> smooth_rows(std::uint64_t seed, int count) {
  Dice dice(seed);
  std::vector<float> out(static_cast<std::size_t>(count) * library::kFeatureStride);
  for (std::size_t column = 0; column < library::kFeatureCount; ++column) {
    for (int wave = 1; wave <= 3; ++wave) {
      const double phase = dice.between(0.0, 6.28);
      const double rate = dice.between(0.1, 0.4) * wave;
      for (int row = 0; row < count; ++row) {
        out[static_cast<std::size_t>(row) * library::kFeatureStride + column] +=
            static_cast<float>(0.3 * std::sin(phase + rate * row));
      }
    }
  }
  return out;
}

/// Returns a clip of frames `first` to `last` at 30 Hz with smooth rows.
inline SearchClip search_clip(int number, int first, int last) {
  SearchClip out;
  ClipRecord& record = out.record;
  record.clip_id = "c1f0" + std::string(11, '0') + static_cast<char>('0' + number);
  record.object_key = std::string(64, 'a');
  record.name = "clip " + std::to_string(number);
  record.provenance.licence = number % 2 == 0 ? "CC0-1.0" : "unknown";
  record.first_frame = first;
  record.last_frame = last;
  record.rate_hz = 30.0;
  record.labels = {{0.0, 1.0, number % 2 == 0 ? "even" : "odd", "anna", 1.0}};
  out.rows = smooth_rows(static_cast<std::uint64_t>(number) + 1,
                         library::feature_span(first, last, 30.0).count);
  return out;
}

/// Writes index and rows of a library.
inline void write_search_library(const std::filesystem::path& place,
                                 std::span<const SearchClip> clips) {
  const std::filesystem::path folder = place / "search" / "rows";
  auto features = recordings::RowsFileWriter::create(folder / "features.f32",
                                                     library::kFeatureStride);
  auto windows =
      recordings::RowsFileWriter::create(folder / "windows.f32", library::kWindowFloats);
  auto wholes =
      recordings::RowsFileWriter::create(folder / "wholes.f32", library::kWholeFloats);
  ASSERT_TRUE(features && windows && wholes);
  std::vector<ClipRecord> records;
  for (const SearchClip& clip : clips) {
    records.push_back(clip.record);
    features->add_clip(clip.rows);
    windows->add_clip(library::feature_windows(clip.rows));
    wholes->add_clip(library::whole_clip_row(clip.rows));
  }
  ASSERT_TRUE(features->commit() && windows->commit() && wholes->commit());
  recordings::IndexHead head;
  head.search = "rows";
  ASSERT_TRUE(recordings::write_library_index(place / "library.sqlite", records, head));
}

}  // namespace marey::testing
