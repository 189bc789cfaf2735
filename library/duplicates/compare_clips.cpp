// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/compare_clips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "library/features/body_features.h"
#include "library/features/level_frame.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr std::size_t kStride = kFeatureStride;
constexpr std::size_t kVelocityColumn = 3 * kBodyPointCount;
constexpr std::size_t kVelocityEnd = kVelocityColumn + 15;
// As in library/features/body_features.cpp: a velocity column is 0.2 s times the
// velocity, the change over two rows.
constexpr float kRowsPerVelocity = 2.0F;
constexpr float kLengthError = 0.002F;
constexpr double kMaxRefined = 0.5;
constexpr double kLastStep = 0.03;
constexpr double kStillChange = 0.01;

float length_between(std::span<const float> row, BodyPoint a, BodyPoint b) {
  float squares = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    const float d = row[3 * index(a) + k] - row[3 * index(b) + k];
    squares += d * d;
  }
  return std::sqrt(squares);
}

// First and last row of `a` that lies within `b`.
struct CommonRows {
  int first = 0;
  int last = -1;

  [[nodiscard]] int count() const { return last - first + 1; }
};

CommonRows common_rows(int a, int b, double shift) {
  return {std::max(0, static_cast<int>(std::ceil(-shift - 1e-9))),
          std::min(a - 1, static_cast<int>(std::floor(b - 1 - shift + 1e-9)))};
}

// Writes the rows of `b` at first + shift, first + 1 + shift..., by Catmull-Rom splines.
void resample_rows(const ComparedClip& b,
                   const CommonRows& rows,
                   double shift,
                   std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(rows.count()) * kStride);
  const int last = b.count() - 1;
  const double start = rows.first + shift;
  const double whole = std::floor(start + 1e-9);
  const auto u = static_cast<float>(std::max(0.0, start - whole));
  const float w[4] = {0.5F * (-u + 2.0F * u * u - u * u * u),
                      0.5F * (2.0F - 5.0F * u * u + 3.0F * u * u * u),
                      0.5F * (u + 4.0F * u * u - 3.0F * u * u * u),
                      0.5F * (-u * u + u * u * u)};
  for (int k = 0; k < rows.count(); ++k) {
    float* to = out.data() + static_cast<std::size_t>(k) * kStride;
    const float* from[4];
    for (int j = 0; j < 4; ++j) {
      const int row = std::clamp(static_cast<int>(whole) + k + j - 1, 0, last);
      from[j] = b.rows.data() + static_cast<std::size_t>(row) * kStride;
    }
    for (std::size_t c = 0; c < kStride; ++c) {
      to[c] =
          w[0] * from[0][c] + w[1] * from[1][c] + w[2] * from[2][c] + w[3] * from[3][c];
    }
  }
}

struct RowSums {
  float xx = 0.0F;
  float yy = 0.0F;
  float xy = 0.0F;
};

// Sums of 16 parts, which are vectorized and have the same order on every processor.
RowSums sums_of(const float* x, const float* y) {
  constexpr std::size_t kParts = 16;
  float xx[kParts] = {};
  float yy[kParts] = {};
  float xy[kParts] = {};
  for (std::size_t c = 0; c < kStride; c += kParts) {
    for (std::size_t k = 0; k < kParts; ++k) {
      xx[k] += x[c + k] * x[c + k];
      yy[k] += y[c + k] * y[c + k];
      xy[k] += x[c + k] * y[c + k];
    }
  }
  for (std::size_t half = kParts / 2; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      xx[k] += xx[k + half];
      yy[k] += yy[k + half];
      xy[k] += xy[k + half];
    }
  }
  return {xx[0], yy[0], xy[0]};
}

// Smaller: a better shift.
double mismatch(const ClipAgreement& agreement) {
  return agreement.course + agreement.distance / (agreement.change + kStillChange);
}

std::optional<ClipAgreement> agreement_at(const ComparedClip& a,
                                          const ComparedClip& b,
                                          double shift,
                                          CompareScratch& scratch) {
  CommonRows rows = common_rows(a.count(), b.count(), shift);
  ClipAgreement out;
  out.shift = shift;
  out.rows = rows.count();
  if (rows.count() > 6) {
    ++rows.first;
    --rows.last;
  }
  if (rows.count() < 3) return std::nullopt;
  resample_rows(b, rows, shift, scratch.second);
  RowSums change;
  const auto count = static_cast<std::size_t>(rows.count());
  float difference[kStride];
  float dx[kStride];
  float dy[kStride];
  for (std::size_t k = 0; k < count; ++k) {
    const float* x = a.rows.data() + (static_cast<std::size_t>(rows.first) + k) * kStride;
    const float* y = scratch.second.data() + k * kStride;
    for (std::size_t c = 0; c < kStride; ++c) difference[c] = x[c] - y[c];
    out.distance += std::sqrt(sums_of(difference, difference).xx);
    if (k == 0) continue;
    for (std::size_t c = 0; c < kStride; ++c) {
      dx[c] = x[c] - x[c - kStride];
      dy[c] = y[c] - y[c - kStride];
    }
    const RowSums sums = sums_of(dx, dy);
    change.xx += sums.xx;
    change.yy += sums.yy;
    change.xy += sums.xy;
    out.change += 0.5 * (std::sqrt(sums.xx) + std::sqrt(sums.yy));
  }
  out.distance /= static_cast<double>(count);
  out.change /= static_cast<double>(count - 1);
  const double lengths = std::sqrt(static_cast<double>(change.xx)) *
                         std::sqrt(static_cast<double>(change.yy));
  const double cosine = lengths > 0.0 ? change.xy / lengths : 0.0;
  out.course = std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine));
  return out;
}

}  // namespace

int ComparedClip::count() const {
  return static_cast<int>(rows.size() / kStride);
}

void prepare_clip(std::span<const float> rows, ComparedClip& out) {
  MAREY_ASSERT(rows.size() % kStride == 0);
  out.rows.assign(rows.begin(), rows.end());
  const std::size_t count = rows.size() / kStride;
  const std::size_t hips = 3 * index(BodyPoint::kHips) + 1;
  for (std::size_t t = 0; t < count; ++t) {
    const float height = rows[t * kStride + hips];
    const std::size_t before = t > 0 ? t - 1 : t;
    const std::size_t after = t + 1 < count ? t + 1 : t;
    const float speed =
        after == before
            ? 0.0F
            : kRowsPerVelocity *
                  (rows[after * kStride + hips] - rows[before * kStride + hips]) /
                  static_cast<float>(after - before);
    float* row = out.rows.data() + t * kStride;
    for (std::size_t c = 1; c < kVelocityColumn; c += 3) row[c] -= height;
    for (std::size_t c = kVelocityColumn + 1; c < kVelocityEnd; c += 3) row[c] -= speed;
  }
}

BodyLengths body_lengths(std::span<const float> rows) {
  if (rows.empty()) return {};
  using P = BodyPoint;
  const std::span<const float> first = rows.first(kStride);
  return {length_between(first, P::kLeftKnee, P::kLeftAnkle),
          length_between(first, P::kRightKnee, P::kRightAnkle),
          length_between(first, P::kLeftElbow, P::kLeftHand),
          length_between(first, P::kRightElbow, P::kRightHand),
          length_between(first, P::kLeftAnkle, P::kLeftToes),
          length_between(first, P::kRightAnkle, P::kRightToes)};
}

bool have_same_lengths(const BodyLengths& a, const BodyLengths& b) {
  bool same = true;
  bool mirrored = true;
  for (std::size_t k = 0; k < a.size(); ++k) {
    same = same && std::abs(a[k] - b[k]) <= kLengthError;
    mirrored = mirrored && std::abs(a[k] - b[k ^ 1U]) <= kLengthError;
  }
  return same || mirrored;
}

double quick_difference(std::span<const float> a,
                        std::span<const float> b,
                        double shift) {
  constexpr std::array kPoints = {BodyPoint::kHead,
                                  BodyPoint::kLeftHand,
                                  BodyPoint::kRightHand,
                                  BodyPoint::kLeftAnkle,
                                  BodyPoint::kRightAnkle};
  constexpr std::size_t kInstants = 4;
  const auto count = [](std::span<const float> rows) {
    return static_cast<int>(rows.size() / kStride);
  };
  const CommonRows rows = common_rows(count(a), count(b), shift);
  std::array<std::array<float, 3 * kPoints.size()>, kInstants> x{};
  std::array<std::array<float, 3 * kPoints.size()>, kInstants> y{};
  for (std::size_t k = 0; k < kInstants; ++k) {
    const int row = rows.first + (rows.count() - 1) * static_cast<int>(k) /
                                     static_cast<int>(kInstants - 1);
    const double at = std::clamp(row + shift, 0.0, count(b) - 1.0);
    const auto whole = static_cast<std::size_t>(at);
    const std::size_t next = std::min(whole + 1, b.size() / kStride - 1);
    const auto u = static_cast<float>(at - static_cast<double>(whole));
    const float* p = a.data() + static_cast<std::size_t>(row) * kStride;
    const float* q = b.data() + whole * kStride;
    const float* r = b.data() + next * kStride;
    for (std::size_t c = 0; c < x[k].size(); ++c) {
      const std::size_t from = 3 * index(kPoints[c / 3]) + c % 3;
      const float hips = c % 3 == 1 ? 1.0F : 0.0F;
      x[k][c] = p[from] - hips * p[1];
      y[k][c] = (1.0F - u) * (q[from] - hips * q[1]) + u * (r[from] - hips * r[1]);
    }
  }
  float difference = 0.0F;
  float change = 0.0F;
  for (std::size_t c = 0; c < x[0].size(); ++c) {
    float mean_x = 0.0F;
    float mean_y = 0.0F;
    for (std::size_t k = 0; k < kInstants; ++k) {
      mean_x += x[k][c] / kInstants;
      mean_y += y[k][c] / kInstants;
    }
    for (std::size_t k = 0; k < kInstants; ++k) {
      const float dx = x[k][c] - mean_x;
      const float dy = y[k][c] - mean_y;
      difference += (dx - dy) * (dx - dy);
      change += 0.5F * (dx * dx + dy * dy);
    }
  }
  return std::sqrt(difference / std::max(change, 1e-6F));
}

std::optional<ClipAgreement> compare_clips(const ComparedClip& a,
                                           const ComparedClip& b,
                                           double shift,
                                           double max_first_mismatch,
                                           CompareScratch& scratch) {
  auto best = agreement_at(a, b, shift, scratch);
  if (!best || mismatch(*best) > max_first_mismatch) return std::nullopt;
  for (double step = kMaxRefined; step > kLastStep; step *= 0.5) {
    const double middle = best->shift;
    for (const double side : {-1.0, 1.0}) {
      const auto other = agreement_at(a, b, middle + side * step, scratch);
      if (other && mismatch(*other) < mismatch(*best)) best = other;
    }
  }
  return best;
}

}  // namespace marey::library
