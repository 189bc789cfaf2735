// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/jump/jump_report.h"

#include <array>
#include <span>

#include "core/base/format_text.h"

namespace marey::app {
namespace {

/// One figure of a line: "rise 0.42 m (captured 0.32 m)".
struct LineFigure {
  const char* figure;  ///< Its captured value is in "captured_FIGURE".
  const char* words;   ///< In front of the number.
  const char* format;  ///< printf() format of the number, with its unit.
};

constexpr std::array<LineFigure, 6> kTimes{{{"start_s", "push", "%.3f s"},
                                            {"lowest_s", "lowest point", "%.3f s"},
                                            {"takeoff_s", "take-off", "%.3f s"},
                                            {"apex_s", "highest point", "%.3f s"},
                                            {"touchdown_s", "touch-down", "%.3f s"},
                                            {"rest_s", "rest", "%.3f s"}}};
constexpr std::array<LineFigure, 5> kFlight{
    {{"rise_m", "rise", "%.3f m"},
     {"airtime_s", "airtime", "%.3f s"},
     {"takeoff_m_s", "take-off speed", "%.2f m/s"},
     {"length_m", "length", "%.3f m"},
     {"fall_m_s2", "fall", "%.2f m/s^2"}}};
constexpr std::array<LineFigure, 2> kPush{
    {{"lowest_m", "lowest point", "%.3f m"}, {"push_g", "peak push", "%.2f g"}}};
constexpr std::array<LineFigure, 7> kBody{
    {{"com_error_mm", "centre of mass off its plan in flight by at most", "%.3f mm"},
     {"com_error_push_mm", "in the whole jump", "%.3f mm"},
     {"slide_mm", "standing feet slide by at most", "%.3f mm"},
     {"raised_heel_mm", "heels rise by at most", "%.0f mm"},
     {"short_leg_mm", "legs too short by at most", "%.1f mm"},
     {"momentum_kg_m2_s", "sd of the angular momentum in flight", "%.3f kg m^2/s"},
     {"turn_deg", "body turned by at most", "%.2f degrees"}}};

std::string formatted(const char* format, double value) {
  // The formats are the constants above.
  return format_text(format, value);  // NOLINT
}

std::string line_of(const edit::OpReport& report,
                    const std::string& title,
                    std::span<const LineFigure> figures) {
  std::string line;
  for (const LineFigure& of_line : figures) {
    const auto value = figure(report, of_line.figure);
    const auto captured = figure(report, std::string("captured_") + of_line.figure);
    if (!value && !captured) continue;
    line += (line.empty() ? title + ": " : ", ") + std::string(of_line.words) + " ";
    if (value) line += formatted(of_line.format, *value);
    if (!captured) continue;
    const std::string text = "captured " + formatted(of_line.format, *captured);
    line += value ? " (" + text + ")" : text;
  }
  return line;
}

}  // namespace

std::optional<double> figure(const edit::OpReport& report, std::string_view figure_name) {
  for (const auto& [name, value] : report.figures) {
    if (name == figure_name) return value;
  }
  return std::nullopt;
}

std::vector<std::string> jump_lines(const edit::OpReport& report) {
  std::vector<std::string> out;
  for (const std::string& line : {line_of(report, "times", kTimes),
                                  line_of(report, "flight", kFlight),
                                  line_of(report, "push", kPush),
                                  line_of(report, "body", kBody)}) {
    if (!line.empty()) out.push_back(line);
  }
  return out;
}

}  // namespace marey::app
