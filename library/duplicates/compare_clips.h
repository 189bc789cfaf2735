// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace marey::library {

/// Lengths of shanks, forearms and feet, left and right, in leg lengths. They are
/// constant for a skeleton, whatever it does.
using BodyLengths = std::array<float, 6>;

/// Returns the lengths by the first row of a clip's features; zeros without rows.
[[nodiscard]] BodyLengths body_lengths(std::span<const float> rows);

/// Returns true if the lengths of both bodies, or of one and the mirror image of the
/// other, agree within 0.002 leg lengths.
[[nodiscard]] bool have_same_lengths(const BodyLengths& a, const BodyLengths& b);

/// Features of a clip without the height of the hips.
struct ComparedClip {
  /// kFeatureStride floats per instant: body_features() with all heights and vertical
  /// velocities relative to the hips. A floor at another height and a lost vertical
  /// motion of the root have no influence.
  std::vector<float> rows;

  [[nodiscard]] int count() const;
};

/// Prepares a clip; `out` is used again. Linear in rows.
/// Precondition: body_features() rows of kFeatureStride floats.
void prepare_clip(std::span<const float> rows, ComparedClip& out);

/// Agreement of two clips at their best time shift.
struct ClipAgreement {
  /// Row t of the first clip is at row t + shift of the second one.
  double shift = 0.0;
  int rows = 0;  ///< Rows of the first clip within the second one.
  /// Mean distance of the features.
  double distance = 0.0;
  /// Mean change of the features within 0.1 s, mean of both clips.
  double change = 0.0;
  /// Distance of the changes within 0.1 s, both scaled to unit length over all rows: 0
  /// for the same motion, sqrt(2) for unrelated ones. Constant differences between bodies
  /// have no influence.
  double course = 0.0;
};

/// Memory of compare_clips() that is used again.
struct CompareScratch {
  std::vector<float> second;
};

/// Returns a fast estimate of the difference of two clips at a time shift: the distance
/// of the positions of head, hands and ankles relative to the hips at four instants, less
/// its mean, over the change between these instants. 0 for the same motion, about 1.4 for
/// unrelated ones. Constant time. Precondition: there are common rows.
[[nodiscard]] double quick_difference(std::span<const float> a,
                                      std::span<const float> b,
                                      double shift);

/// Compares two clips near a time shift: the shift is refined within 0.6 rows, to 0.03
/// rows, with cubic interpolation of the second clip. The first and last common row are
/// left out if there are more than six, because velocities are one-sided at the ends of
/// clips. nullopt: fewer than three common rows remain, or at `shift` itself
/// course + distance / (change + 0.01) is above `max_first_mismatch`.
/// Cost: 12 times the common rows.
[[nodiscard]] std::optional<ClipAgreement> compare_clips(const ComparedClip& a,
                                                         const ComparedClip& b,
                                                         double shift,
                                                         double max_first_mismatch,
                                                         CompareScratch& scratch);

}  // namespace marey::library
