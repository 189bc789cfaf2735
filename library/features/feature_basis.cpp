// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/feature_basis.h"

#include <algorithm>
#include <cstddef>

#include "core/base/assert.h"

namespace marey::library {
namespace {

// Numbers of rows and floats of a span of features.
int rows_of(std::span<const float> rows) {
  MAREY_ASSERT(rows.size() % kFeatureStride == 0);
  return static_cast<int>(rows.size() / kFeatureStride);
}

}  // namespace

std::array<float, kBasisCount> project_features(std::span<const float> row) {
  MAREY_ASSERT(row.size() >= kFeatureCount);
  const FeatureBasis& basis = feature_basis();
  std::array<float, kBasisCount> out{};
  for (std::size_t d = 0; d < out.size(); ++d) {
    float sum = 0.0F;
    for (std::size_t c = 0; c < basis[d].size(); ++c) sum += basis[d][c] * row[c];
    out[d] = sum;
  }
  return out;
}

void project_keys(std::span<const float> rows, int keys, std::span<float> out) {
  const int count = rows_of(rows);
  MAREY_ASSERT(count > 0 && out.size() == static_cast<std::size_t>(keys * kBasisCount));
  for (int k = 0; k < keys; ++k) {
    const auto row = static_cast<std::size_t>(((2 * k + 1) * count) / (2 * keys));
    const auto key = project_features(rows.subspan(row * kFeatureStride, kFeatureCount));
    std::copy(key.begin(), key.end(), out.begin() + k * kBasisCount);
  }
}

int window_count(int rows) {
  if (rows <= 0) return 0;
  return rows < kWindowRows ? 1 : (rows - kWindowRows) / kWindowStep + 1;
}

std::vector<float> feature_windows(std::span<const float> rows) {
  const int count = rows_of(rows);
  const int windows = window_count(count);
  std::vector<float> out(static_cast<std::size_t>(windows) * kWindowFloats);
  for (int w = 0; w < windows; ++w) {
    const auto first = static_cast<std::size_t>(w) * kWindowStep;
    const auto length = static_cast<std::size_t>(std::min(count, kWindowRows));
    project_keys(rows.subspan(first * kFeatureStride, length * kFeatureStride),
                 kWindowKeys,
                 std::span(out).subspan(static_cast<std::size_t>(w) * kWindowFloats,
                                        kWindowFloats));
  }
  return out;
}

std::vector<float> whole_clip_row(std::span<const float> rows) {
  if (rows_of(rows) == 0) return {};
  std::vector<float> out(kWholeFloats);
  project_keys(rows, kWholeKeys, out);
  return out;
}

}  // namespace marey::library
