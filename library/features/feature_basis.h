// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "library/features/body_features.h"

namespace marey::library {

/// Dimensions that the features of one instant are projected to.
inline constexpr int kBasisCount = 16;

/// Rows of a window of 2 s, both ends included.
inline constexpr int kWindowRows = 21;
/// Rows between the starts of consecutive windows: 0.3 s.
inline constexpr int kWindowStep = 3;
/// Key instants of a window, and floats of its row.
inline constexpr int kWindowKeys = 4;
inline constexpr int kWindowFloats = kWindowKeys * kBasisCount;
/// Key instants of a whole clip, and floats of its row.
inline constexpr int kWholeKeys = 8;
inline constexpr int kWholeFloats = kWholeKeys * kBasisCount;

/// The fixed projection of features, [dimension][column]. Its rows are orthonormal.
/// Constants of the program, the same for all libraries: a basis learnt from a library
/// would change with every added clip. Source:
/// benchmarks/library/derive_feature_basis.cpp.
using FeatureBasis = std::array<std::array<float, kFeatureCount>, kBasisCount>;
[[nodiscard]] const FeatureBasis& feature_basis();

/// Projects one row of features. Sums are made column by column, in float: the same
/// result on every processor.
/// Precondition: `row` has kFeatureCount floats or more.
[[nodiscard]] std::array<float, kBasisCount> project_features(std::span<const float> row);

/// Writes the projected key instants of a part of a motion: `keys` of them, of the rows
/// floor((k + 1/2) rows / keys). Fewer rows than keys are repeated.
/// Precondition: at least one row of kFeatureStride; `out` has keys * kBasisCount floats.
void project_keys(std::span<const float> rows, int keys, std::span<float> out);

/// Returns the number of windows of a clip of this many rows: one per 0.3 s as long as
/// 2 s remain, and one, compressed, for a clip shorter than that; 0 without rows.
[[nodiscard]] int window_count(int rows);

/// Returns the windows of a clip: kWindowFloats each, window k of the rows from
/// k * kWindowStep on. Linear in rows.
[[nodiscard]] std::vector<float> feature_windows(std::span<const float> rows);

/// Returns the row of a whole clip: kWholeFloats, or none for a clip without rows.
[[nodiscard]] std::vector<float> whole_clip_row(std::span<const float> rows);

}  // namespace marey::library
