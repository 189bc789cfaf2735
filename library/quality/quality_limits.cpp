// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/quality_limits.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr FigureRule reported(std::string_view figure, std::string_view kind) {
  FigureRule out{figure, kind};
  out.is_judged = false;
  return out;
}

constexpr std::array kRules{
    FigureRule{"scale_sigma", "scale", 4.0, 7.0},
    FigureRule{"sides_share", "sides", 0.6, 0.85},
    FigureRule{"rate_stated_ratio", "rate", 1.02, 1.2, true},
    FigureRule{"rate_ratio", "rate", 1.33, 2.0},
    FigureRule{"swap_frames", "swap", 1.0, 5.0},
    FigureRule{"flip_count", "flip", 0.5, 2.5},
    FigureRule{"cut", "cut", 1.65, 4.0},
    FigureRule{"frozen_s", "frozen", 0.25, 1.0},
    FigureRule{"spike", "spike", 2.3, 4.0},
    FigureRule{"jitter_mm", "jitter", 0.6, 2.0},
    FigureRule{"tilt_deg", "tilt", 0.9, 3.0},
    FigureRule{"float_mm", "float", 20.0, 50.0},
    FigureRule{"slide_cm_s", "slide", 6.0, 12.0},
    FigureRule{"drift_mm", "slide", 60.0, 120.0},
    FigureRule{"sink_mm", "sink", 20.0, 50.0},
    FigureRule{"limits_deg", "limits", 30.0, 60.0},
    FigureRule{"self_mm", "self", 40.0, 80.0},
    FigureRule{"gap_share", "gap", 0.02, 0.1},
    FigureRule{"longest_gap_s", "gap", 0.5, 2.0},
    FigureRule{"sigma_p95_mm", "sigma", 20.0, 50.0},
    FigureRule{"residual_mm", "residual", 15.0, 30.0, true},
    FigureRule{"bones_mm", "bones", 3.0, 15.0, true},
    reported("flights", "flights"),
    reported("proportions", "proportions"),
    reported("seconds", "seconds"),
    reported("sparc", "sparc"),
    reported("speed_m_s", "speed"),
    reported("stature_m", "stature"),
    reported("still_share", "still"),
    reported("tpose_share", "tpose"),
};

}  // namespace

std::span<const FigureRule> figure_rules() {
  return kRules;
}

QualityLimits::QualityLimits(std::span<const QualityLimit> own)
    : rules_(kRules.begin(), kRules.end()) {
  for (const QualityLimit& limit : own) {
    for (FigureRule& rule : rules_) {
      if (rule.figure != limit.figure) continue;
      rule.warn = limit.warn;
      rule.fail = limit.fail;
      rule.is_judged = true;
    }
  }
}

const FigureRule& QualityLimits::operator[](std::string_view figure) const {
  const auto found = std::find_if(rules_.begin(), rules_.end(), [&](const auto& rule) {
    return rule.figure == figure;
  });
  MAREY_ASSERT(found != rules_.end());
  return *found;
}

std::optional<Verdict> QualityLimits::verdict(std::string_view figure,
                                              double value) const {
  const FigureRule& rule = (*this)[figure];
  if (!rule.is_judged) return std::nullopt;
  if (value > rule.fail) return Verdict::kFail;
  return value > rule.warn ? Verdict::kWarn : Verdict::kPass;
}

}  // namespace marey::library
