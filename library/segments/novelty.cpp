// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/novelty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "library/features/body_features.h"
#include "library/search/row_kernel.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr double kMinSigmas = 2.0;
constexpr double kTaperRows = 5.0;

}  // namespace

std::vector<double> novelty(std::span<const float> rows) {
  MAREY_ASSERT(rows.size() % kFeatureStride == 0);
  constexpr auto kStride = static_cast<std::size_t>(kFeatureStride);
  constexpr auto kSide = static_cast<std::size_t>(kNoveltyRows);
  constexpr std::size_t kBand = 2 * kSide;
  const std::size_t count = rows.size() / kStride;
  std::vector<double> out(count, 0.0);
  if (count < kBand) return out;
  // Distances of row t from the rows t to t + kBand - 1.
  const SquaredDistances distances_of = squared_distances();
  std::vector<float> band(count * kBand, 0.0F);
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t size = std::min(kBand, count - t);
    float* to = band.data() + t * kBand;
    distances_of(rows.data() + t * kStride, size, kStride, rows.data() + t * kStride, to);
    for (std::size_t k = 0; k < size; ++k) to[k] = std::sqrt(to[k]);
  }
  // Weight of a row by its distance from the boundary.
  std::array<double, kBand> weights{};
  for (std::size_t k = 0; k < kBand; ++k) {
    const double rows_off = static_cast<double>(k) + 0.5 - kNoveltyRows;
    weights[k] = std::exp(-0.5 * rows_off * rows_off / (kTaperRows * kTaperRows));
  }
  for (std::size_t t = kSide; t + kSide <= count; ++t) {
    double across = 0.0;
    double within = 0.0;
    double across_weights = 0.0;
    double within_weights = 0.0;
    for (std::size_t i = 0; i < kBand; ++i) {
      for (std::size_t j = i + 1; j < kBand; ++j) {
        const double weight = weights[i] * weights[j];
        const double distance = weight * band[(t - kSide + i) * kBand + (j - i)];
        const bool is_across = i < kSide && j >= kSide;
        (is_across ? across : within) += distance;
        (is_across ? across_weights : within_weights) += weight;
      }
    }
    out[t] = across / across_weights - within / within_weights;
  }
  return out;
}

std::vector<int> find_changes(std::span<const float> rows) {
  const std::vector<double> values = novelty(rows);
  const auto count = static_cast<int>(values.size());
  const int defined = count - 2 * kNoveltyRows + 1;
  if (defined < 1) return {};
  const auto first = values.begin() + kNoveltyRows;
  const auto last = first + defined;
  double mean = 0.0;
  double squares = 0.0;
  for (auto v = first; v != last; ++v) mean += *v / defined;
  for (auto v = first; v != last; ++v) squares += (*v - mean) * (*v - mean) / defined;
  const double limit = mean + kMinSigmas * std::sqrt(squares);
  std::vector<int> peaks;
  for (int t = kNoveltyRows; t + kNoveltyRows <= count; ++t) {
    const auto at = [&](int k) { return values[static_cast<std::size_t>(k)]; };
    const bool rises = t == kNoveltyRows || at(t) > at(t - 1);
    const bool falls = t + kNoveltyRows == count || at(t) >= at(t + 1);
    if (rises && falls && at(t) > limit) peaks.push_back(t);
  }
  std::stable_sort(peaks.begin(), peaks.end(), [&](int a, int b) {
    return values[static_cast<std::size_t>(a)] > values[static_cast<std::size_t>(b)];
  });
  std::vector<int> out;
  for (const int peak : peaks) {
    if (std::all_of(out.begin(), out.end(), [&](int other) {
          return std::abs(other - peak) >= kNoveltyRows;
        })) {
      out.push_back(peak);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace marey::library
