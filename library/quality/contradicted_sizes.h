// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/library/clip_record.h"

namespace marey::library {

/// The body of one clip, by its figures.
struct ClipBody {
  std::string subject;       ///< Provenance::subject; empty: unknown.
  double stature_m = 0.0;    ///< Figure "stature_m"; 0: unknown.
  double proportions = 0.0;  ///< Figure "proportions"; 0: unknown.
};

/// A clip whose body has another size than in the other clips of the same person.
struct ContradictedSize {
  std::size_t clip = 0;    ///< Index in the clips.
  double ratio = 0.0;      ///< Its stature over the usual one: 1.1 is 10 % too large.
  double usual_m = 0.0;    ///< Median stature of the person's other clips. [m]
  std::size_t others = 0;  ///< Clips with the usual stature.
};

/// Limit of ContradictedSize::ratio, upwards and downwards.
inline constexpr double kMaxSizeRatio = 1.04;

/// Returns the body of a record, from its figures and its subject.
[[nodiscard]] ClipBody body_of(const ClipRecord& record);

/// Finds clips of a wrong scale by comparison. One clip alone does not show it: a person
/// 10 % taller may exist. Clips are of one person if they have the same subject, or,
/// without subjects, the same proportions within 0.1 %: a scaled body has the proportions
/// of the original, another person has not. In a group of three or more, a clip is
/// contradicted if its stature differs by more than kMaxSizeRatio from the median of the
/// group, and more than half of the group agrees with the median within 1 %.
///
/// The result is ascending by clip, and does not depend on the order of the others.
/// n log n in clips.
[[nodiscard]] std::vector<ContradictedSize> find_contradicted_sizes(
    std::span<const ClipBody> clips);

/// Returns the problem of kind "scale" of a contradicted clip: all frames, with the
/// ratio, or its inverse if that is larger.
[[nodiscard]] ClipProblem problem_of(const ContradictedSize& size, int frame_count);

}  // namespace marey::library
