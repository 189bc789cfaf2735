// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/simulated_records.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "core/base/format_text.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

constexpr std::array<std::string_view, 8> kContents = {
    "walk", "run", "jump", "dance", "wave-left-hand", "punch", "turn left", "sit"};
constexpr std::array<std::string_view, 5> kStyles = {
    "normal", "tired", "happy", "elderly", "proud"};
constexpr std::array<std::string_view, 8> kRelations = {"foot_left bears",
                                                        "foot_right bears",
                                                        "flight",
                                                        "hand_right above head",
                                                        "hands together",
                                                        "moving",
                                                        "turning_left",
                                                        "left in front"};
constexpr std::array<std::string_view, 20> kFigures = {
    "bones_mm",   "flip",       "float_mm",      "frozen_s",     "gap_share",
    "jitter_mm",  "limits_deg", "longest_gap_s", "rate",         "residual_mm",
    "scale",      "self_mm",    "sides",         "sigma_p95_mm", "sink_mm",
    "slide_cm_s", "sparc",      "speed_m_s",     "spike",        "swap"};
constexpr std::array<std::string_view, 4> kJoints = {"", "leftFoot", "rightHand", "hips"};
constexpr std::array<std::string_view, 3> kLicences = {
    "CC0-1.0", "CC-BY-NC-4.0", "unknown"};
constexpr std::array<std::string_view, 3> kSplits = {"train", "val", "test"};

/// Draws values of records.
class RecordDice {
 public:
  explicit RecordDice(std::uint64_t seed) : dice_(seed) {}

  double between(double low, double high) { return dice_.between(low, high); }
  int below(int count) {
    return std::min(count - 1, static_cast<int>(dice_.between(0.0, count)));
  }
  template <std::size_t N>
  std::string one_of(const std::array<std::string_view, N>& words) {
    return std::string(words[static_cast<std::size_t>(below(static_cast<int>(N)))]);
  }
  std::string digits(int count) {
    std::string out;
    for (; count > 0; --count) out += "0123456789abcdef"[below(16)];
    return out;
  }

 private:
  Dice dice_;
};

void add_figures(int count, RecordDice& dice, ClipRecord& record) {
  const int frames = record.frame_count();
  for (std::size_t k = 0; k < kFigures.size(); ++k) {
    const bool is_speed = kFigures[k] == "speed_m_s";
    if (!is_speed && static_cast<int>(k) >= count - (count <= 17 ? 1 : 0)) continue;
    ClipFigure& figure = record.figures.emplace_back();
    figure.name = kFigures[k];
    figure.value = is_speed ? dice.between(0.0, 3.0) : dice.between(-1.0, 20.0);
    if (!is_speed && figure.name != "sparc") {
      const int roll = dice.below(200);
      figure.verdict = Verdict::kPass;
      if (roll < 2) figure.verdict = roll == 0 ? Verdict::kFail : Verdict::kWarn;
      figure.joint = dice.one_of(kJoints);
      const int first = dice.below(frames);
      figure.frames = FrameRange{first, first + dice.below(frames - first)};
    }
    if (!figure.verdict || *figure.verdict == Verdict::kPass) continue;
    record.quality = std::max(record.quality, *figure.verdict);
    record.problems.push_back({*figure.frames,
                               figure.name.substr(0, figure.name.find('_')),
                               figure.joint,
                               figure.value});
  }
  std::stable_sort(
      record.problems.begin(), record.problems.end(), [](const auto& a, const auto& b) {
        return a.frames.first < b.frames.first;
      });
}

void add_labels(int count, RecordDice& dice, ClipRecord& record) {
  const double end_s = record.duration_s();
  record.labels.push_back(
      {0.0, end_s, "content:" + dice.one_of(kContents), "names", 1.0});
  record.labels.push_back({0.0, end_s, "style:" + dice.one_of(kStyles), "names", 1.0});
  for (int k = 2; k < count; ++k) {
    const double start_s = dice.between(0.0, end_s);
    const bool is_found = k >= count / 2;
    record.labels.push_back({start_s,
                             dice.between(start_s, end_s),
                             is_found ? dice.one_of(kRelations) : dice.one_of(kContents),
                             is_found ? "marey" : "anna",
                             is_found ? 1.0 : 0.5});
  }
  std::sort(record.labels.begin(),
            record.labels.end(),
            [](const ClipLabel& a, const ClipLabel& b) {
              return std::tie(a.start_s, a.text) < std::tie(b.start_s, b.text);
            });
  for (int frame = dice.below(20); frame < record.frame_count();
       frame += 10 + dice.below(60)) {
    record.events.push_back({frame, dice.below(2) == 0 ? "left.strike" : "right.strike"});
  }
}

Provenance draw_source(int number, RecordDice& dice) {
  Provenance out;
  out.source_id = dice.digits(64);
  out.path = format_text("files/take_%05d.bvh", number);
  out.kind = "bvh";
  out.licence = dice.one_of(kLicences);
  out.origin = "https://example.org/motions";
  out.commit = "v1";
  out.subject = dice.below(10) == 0 ? "" : format_text("actor %d", dice.below(10));
  out.attribution = "Example Studio";
  return out;
}

}  // namespace

std::vector<ClipRecord> simulated_records(const SimulatedRecordsOptions& options) {
  RecordDice dice(options.seed);
  std::vector<ClipRecord> out;
  out.reserve(static_cast<std::size_t>(options.clips));
  for (int source = 0; static_cast<int>(out.size()) < options.clips; ++source) {
    const Provenance from = draw_source(source, dice);
    const int parts = 1 + dice.below(5);
    int next_frame = dice.below(100);
    for (int part = 0; part < parts && static_cast<int>(out.size()) < options.clips;
         ++part) {
      ClipRecord& record = out.emplace_back();
      record.clip_id = dice.digits(16);
      record.object_key = from.source_id;
      std::reverse(record.object_key.begin(), record.object_key.end());
      record.provenance = from;
      record.body = dice.below(20) == 0 ? "second" : "";
      record.first_frame = next_frame;
      record.last_frame = next_frame + 29 + dice.below(270);
      next_frame = record.last_frame + 1;
      record.rate_hz = dice.below(2) == 0 ? 30.0 : 119.88;
      record.rate_by = static_cast<RateBasis>(dice.below(3));
      add_figures(options.figures, dice, record);
      add_labels(options.labels, dice, record);
      // "take_00012 walk 3", like a name of a file with words.
      record.name = format_text("take_%05d ", source) +
                    std::string(kContents[static_cast<std::size_t>(dice.below(8))]) +
                    format_text(" %d", part + 1);
      record.split = dice.one_of(kSplits);
      if (out.size() > 1 && dice.below(50) == 0) {
        record.duplicate_of = out.front().clip_id;
      } else if (out.size() > 1 && dice.below(50) == 0) {
        record.mirror_of = out.front().clip_id;
      }
    }
  }
  return out;
}

}  // namespace marey::testing
