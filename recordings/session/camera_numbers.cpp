// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/camera_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/mat3x3.hpp>

namespace marey::recordings {

std::optional<glm::dquat> rotation_of_rows(std::span<const double, 9> rows) {
  glm::dmat3 r(0.0);  // r[column][row]
  for (std::size_t i = 0; i < rows.size(); ++i) {
    r[static_cast<int>(i % 3)][static_cast<int>(i / 3)] = rows[i];
  }
  const glm::dmat3 product = glm::transpose(r) * r;
  constexpr double kTolerance = 1e-3;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double expected = row == column ? 1.0 : 0.0;
      if (!(std::abs(product[column][row] - expected) < kTolerance)) return std::nullopt;
    }
  }
  if (glm::determinant(r) < 0.0) return std::nullopt;
  return glm::normalize(glm::quat_cast(r));
}

bool set_pinhole(std::span<const double, 9> rows, Intrinsics& intrinsics) {
  const bool is_pinhole = rows[0] > 0 && rows[4] > 0 && rows[1] == 0 && rows[3] == 0 &&
                          rows[6] == 0 && rows[7] == 0 && rows[8] == 1;
  if (!is_pinhole) return false;
  intrinsics.focal_px = {rows[0], rows[4]};
  intrinsics.centre_px = {rows[2], rows[5]};
  return true;
}

bool set_distortion(std::span<const double> terms,
                    bool is_fisheye,
                    Intrinsics& intrinsics) {
  constexpr std::size_t kKept = 8;
  const std::size_t given = terms.size();
  const bool is_known = is_fisheye ? given == 0 || given == 4
                                   : given == 0 || given == 4 || given == 5 ||
                                         given == kKept || given == 12 || given == 14;
  if (!is_known) return false;
  const auto rest = terms.subspan(std::min(given, kKept));
  if (std::any_of(rest.begin(), rest.end(), [](double t) { return t != 0.0; })) {
    return false;
  }
  intrinsics.lens = is_fisheye       ? LensModel::kFisheye
                    : given >= kKept ? LensModel::kRational
                                     : LensModel::kBrownConrady;
  intrinsics.distortion = {};
  std::copy_n(terms.begin(), std::min(given, kKept), intrinsics.distortion.begin());
  return true;
}

}  // namespace marey::recordings
