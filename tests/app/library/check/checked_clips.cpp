// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/library/check/checked_clips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "library/quality/quality_limits.h"

#include "recordings/library/clip_record_file.h"

namespace marey::testing {
namespace {

constexpr std::array<const char*, 4> kBadFigures = {
    "spike", "slide_cm_s", "swap_frames", "jitter_mm"};
constexpr std::array<const char*, 4> kJoints = {"head", "leftFoot", "", "rightHand"};

/// Draws numbers of [0, 1) that are the same with every standard library.
class CheckDice {
 public:
  double next() { return static_cast<double>(bits_() >> 11U) * 0x1p-53; }

 private:
  std::mt19937_64 bits_{7};
};

}  // namespace

std::vector<ClipRecord> checked_clips(int count) {
  CheckDice dice;
  const library::QualityLimits limits({});
  std::vector<ClipRecord> out;
  for (int i = 0; i < count; ++i) {
    ClipRecord& clip = out.emplace_back();
    clip.provenance.path =
        "walks/set" + std::to_string(i % 7) + "/take_" + std::to_string(i) + ".bvh";
    clip.provenance.licence = "CC0-1.0";
    clip.name = "take_" + std::to_string(i);
    clip.rate_hz = i % 3 == 0 ? 120.0 : 30.0;
    clip.last_frame = 40 + static_cast<int>(400.0 * dice.next());
    clip.object_key = std::string(64, 'a');
    clip.clip_id = recordings::clip_id_of(clip.name, "", 0, clip.last_frame);
    const bool is_bad = dice.next() < 0.1;
    const auto bad = static_cast<std::size_t>(4.0 * dice.next());
    for (const library::FigureRule& rule : limits.rules()) {
      ClipFigure figure;
      figure.name = rule.figure;
      figure.value = (rule.is_judged ? 0.5 * rule.warn : 1.0) * std::pow(dice.next(), 3);
      if (is_bad && figure.name == kBadFigures[bad]) {
        figure.value = rule.warn * (1.01 + 2.0 * dice.next());
        const int first = static_cast<int>((clip.last_frame - 10) * dice.next());
        figure.frames = FrameRange{first, first + static_cast<int>(10.0 * dice.next())};
        figure.joint = kJoints[bad];
        clip.problems.push_back(
            {*figure.frames, std::string(rule.kind), figure.joint, figure.value});
      }
      figure.verdict = limits.verdict(rule.figure, figure.value);
      clip.quality = std::max(clip.quality, figure.verdict.value_or(Verdict::kPass));
      clip.figures.push_back(std::move(figure));
    }
    std::ranges::sort(clip.figures, {}, &ClipFigure::name);
  }
  return out;
}

}  // namespace marey::testing
