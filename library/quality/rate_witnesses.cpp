// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/rate_witnesses.h"

#include <algorithm>
#include <array>
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

const ClipFigure* figure_named(std::span<const ClipFigure> figures,
                               std::string_view name) {
  const auto found = std::find_if(
      figures.begin(), figures.end(), [&](const auto& one) { return one.name == name; });
  return found == figures.end() ? nullptr : &*found;
}

bool is_warned(const ClipFigure* figure) {
  return figure != nullptr && figure->verdict && *figure->verdict != Verdict::kPass;
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
  if (is_resampled_copy(witnesses)) stated.table_hz = witnesses.file_hz;
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

std::string_view name(RateTrust trust) {
  constexpr std::array<std::string_view, 4> kNames{
      "stated", "proven", "implausible", "contradicted"};
  return kNames[static_cast<std::size_t>(trust)];
}

RateTrust rate_trust(std::span<const ClipFigure> figures) {
  if (is_warned(figure_named(figures, "rate_stated_ratio")))
    return RateTrust::kContradicted;
  const ClipFigure* flights = figure_named(figures, "flights");
  const ClipFigure* ratio = figure_named(figures, "rate_ratio");
  if (flights == nullptr || ratio == nullptr || flights->value < 2.0) {
    return RateTrust::kStated;
  }
  return is_warned(ratio) ? RateTrust::kImplausible : RateTrust::kProven;
}

}  // namespace marey::library
