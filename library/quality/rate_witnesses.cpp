// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/rate_witnesses.h"

#include <algorithm>
#include <cmath>

namespace marey::library {
namespace {

// Files round frame times: 0.016667 s, 29.97 and 30 Hz.
constexpr double kSameRate = 1.01;
constexpr double kSameDuration = 0.02;

double ratio_of_rates(double a, double b) {
  return std::max(a / b, b / a);
}

bool is_stated(const std::optional<double>& hz) {
  return hz && *hz > 0.0 && std::isfinite(*hz);
}

}  // namespace

bool is_resampled_copy(const RateWitnesses& witnesses) {
  if (!is_stated(witnesses.file_hz) || !is_stated(witnesses.table_duration_s)) {
    return false;
  }
  const double off_s =
      witnesses.frames / *witnesses.file_hz - *witnesses.table_duration_s;
  return std::abs(off_s) <=
         std::max(kSameDuration * *witnesses.table_duration_s, 2.0 / *witnesses.file_hz);
}

std::optional<StatedRate> choose_rate(const RateWitnesses& witnesses) {
  RateWitnesses stated = witnesses;
  if (is_resampled_copy(witnesses)) stated.table_hz.reset();
  StatedRate out;
  if (is_stated(stated.option_hz)) {
    out.hz = *stated.option_hz;
    out.basis = RateBasis::kOption;
  } else if (is_stated(stated.table_hz)) {
    out.hz = *stated.table_hz;
    out.basis = RateBasis::kTable;
  } else if (is_stated(stated.file_hz)) {
    out.hz = *stated.file_hz;
  } else {
    return std::nullopt;
  }
  out.figure.value = 1.0;
  int agreeing = 0;
  for (const auto& hz : {stated.file_hz, stated.table_hz, stated.option_hz}) {
    if (!is_stated(hz)) continue;
    const double ratio = ratio_of_rates(*hz, out.hz);
    if (ratio <= kSameRate) {
      ++agreeing;
    } else {
      out.figure.value = std::max(out.figure.value, ratio);
    }
  }
  if (agreeing > 1) out.figure.value = 1.0;
  return out;
}

}  // namespace marey::library
