// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_calibration.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"

namespace marey::recordings {
namespace {

// Longer than starting one camera after the other by hand.
constexpr Limits kApart{0.1, 60.0, "s"};
constexpr Limits kHeight{0.0, 2.0, "m"};

constexpr std::array<std::pair<std::string_view, ClockChoice>, 4> kClocks{{
    {"auto", ClockChoice::kAuto},
    {"shared", ClockChoice::kShared},
    {"offsets", ClockChoice::kOffsets},
    {"drifts", ClockChoice::kDrifts},
}};

/// Returns the value of the word of `key`; the first value if the word is unknown.
template <class Value, std::size_t kCount>
Value read_word(TomlReader& reader,
                std::string_view key,
                const std::array<std::pair<std::string_view, Value>, kCount>& known) {
  const std::string word = reader.text(key);
  std::vector<std::string_view> words;
  for (const auto& [name, value] : known) {
    if (name == word) return value;
    words.push_back(name);
  }
  reader.fail(key,
              "unknown " + std::string(key) + " " + in_quotes(word),
              suggestion(word, words));
  return known.front().second;
}

void read_flag(TomlReader& reader, std::string_view key, bool& value) {
  if (reader.has(key)) value = reader.boolean(key);
}

/// Rejects options that only a board can determine.
void refuse_for_wand(TomlReader& reader, const CalibrationChoices& choices) {
  if (!choices.warp) return;
  reader.fail("warp",
              "a wand cannot determine the board's \"warp\"",
              "calibrate with a board, or leave it out");
}

}  // namespace

CalibrationChoices read_calibration_choices(TomlReader& root,
                                            const std::filesystem::path& folder) {
  CalibrationChoices choices;
  if (!root.has("calibration")) return choices;
  TomlReader reader = root.table("calibration");
  reader.allow({"lens",
                "clocks",
                "most_offset_s",
                "line_delays",
                "warp",
                "cross_validate",
                "lenses",
                "lowest_corner_m"});
  if (reader.has("lens")) choices.lens = read_word(reader, "lens", kLensWords);
  if (reader.has("clocks")) choices.clocks = read_word(reader, "clocks", kClocks);
  if (reader.has("most_offset_s")) {
    choices.max_offset_s = reader.number("most_offset_s", kApart);
  }
  read_flag(reader, "line_delays", choices.line_delays);
  read_flag(reader, "warp", choices.warp);
  read_flag(reader, "cross_validate", choices.cross_validate);
  if (reader.has("lenses")) {
    choices.lenses = (folder / reader.text("lenses")).lexically_normal();
    choices.lenses_line = reader.line("lenses");
  }
  if (reader.has("lowest_corner_m")) {
    choices.lowest_corner_m = reader.number("lowest_corner_m", kHeight);
  }
  if (root.has("wand")) refuse_for_wand(reader, choices);
  return choices;
}

}  // namespace marey::recordings
