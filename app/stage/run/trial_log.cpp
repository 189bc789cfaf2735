// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/trial_log.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include "recordings/base/csv_line.h"
#include "recordings/base/number_text.h"

namespace marey::app {
namespace {

constexpr std::array<std::string_view, 7> kValueColumns{"place_left_m",
                                                        "place_up_m",
                                                        "place_forward_m",
                                                        "azimuth_deg",
                                                        "elevation_deg",
                                                        "speed_m_s",
                                                        "release_s"};

void add_value_columns(std::string& text, std::string_view prefix) {
  for (const std::string_view column : kValueColumns) {
    text.append(",").append(prefix).append(column);
  }
}

void add_cell(std::string& line, double value) {
  line += ',';
  recordings::append_exact(line, value);
}

void add_cells(std::string& line, const glm::dvec3& values) {
  for (int k = 0; k < 3; ++k) add_cell(line, values[k]);
}

void add_cell(std::string& line, const std::optional<double>& value) {
  if (value) {
    add_cell(line, *value);
  } else {
    line += ',';
  }
}

void add_cells(std::string& line, const TrialValues& values) {
  add_cells(line, values.place_m);
  add_cell(line, values.azimuth_deg);
  add_cell(line, values.elevation_deg);
  add_cell(line, values.speed_m_s);
  add_cell(line, values.release_s);
}

TrialValues read_values(recordings::CsvFields& fields) {
  TrialValues values;
  for (int k = 0; k < 3; ++k) values.place_m[k] = fields.number<double>();
  values.azimuth_deg = fields.number<double>();
  values.elevation_deg = fields.number<double>();
  values.speed_m_s = fields.number<double>();
  values.release_s = fields.number<double>();
  return values;
}

/// Reads a cell that may be empty; `good` becomes false at another content.
std::optional<double> read_optional(recordings::CsvFields& fields, bool& good) {
  const std::string_view cell = fields.text();
  if (cell.empty()) return std::nullopt;
  double value = 0.0;
  const char* end = cell.data() + cell.size();
  const auto [stop, problem] = std::from_chars(cell.data(), end, value);
  good = good && problem == std::errc{} && stop == end && std::isfinite(value);
  return value;
}

std::optional<TrialArrival> read_arrival(recordings::CsvFields& fields, bool& good) {
  const std::optional<double> time_s = read_optional(fields, good);
  TrialArrival arrival{time_s.value_or(0.0), glm::dvec3(0.0)};
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> place_m = read_optional(fields, good);
    good = good && place_m.has_value() == time_s.has_value();
    arrival.p_in_world[k] = place_m.value_or(0.0);
  }
  return time_s ? std::optional(arrival) : std::nullopt;
}

std::optional<KeeperResponse> read_keeper(recordings::CsvFields& fields, bool& good) {
  const std::string_view hand = fields.text();
  good = good && (hand.empty() || hand == "left" || hand == "right");
  KeeperResponse keeper;
  keeper.hand = hand == "right" ? 1 : 0;
  keeper.hand_moves_s = read_optional(fields, good);
  keeper.hips_move_s = read_optional(fields, good);
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> place_m = read_optional(fields, good);
    good = good && place_m.has_value() == !hand.empty();
    keeper.hand_at_arrival_in_world[k] = place_m.value_or(0.0);
  }
  return hand.empty() ? std::nullopt : std::optional(keeper);
}

}  // namespace

std::string trial_header() {
  std::string text = "trial,parameter,value,repetition,start_s";
  add_value_columns(text, "asked_");
  add_value_columns(text, "measured_");
  text += ",release_s,arrival_s,arrival_x_m,arrival_y_m,arrival_z_m";
  text += ",hand,hand_moves_s,hips_move_s,hand_x_m,hand_y_m,hand_z_m";
  return text;
}

std::string trial_line(const TrialRow& row) {
  std::string line;
  recordings::append_exact(line, row.number);
  line.append(",").append(row.parameter);
  add_cell(line, row.value);
  line += ',';
  recordings::append_exact(line, row.repetition);
  add_cell(line, row.start_s);
  add_cells(line, row.asked);
  add_cells(line, row.measured);
  add_cell(line, row.release_s);
  if (row.arrival) {
    add_cell(line, row.arrival->time_s);
    add_cells(line, row.arrival->p_in_world);
  } else {
    line += ",,,,";
  }
  if (row.keeper) {
    line += row.keeper->hand == 1 ? ",right" : ",left";
    add_cell(line, row.keeper->hand_moves_s);
    add_cell(line, row.keeper->hips_move_s);
    add_cells(line, row.keeper->hand_at_arrival_in_world);
  } else {
    line += ",,,,,,";
  }
  return line;
}

std::optional<TrialRow> read_trial_line(std::string_view line) {
  recordings::CsvFields fields(line);
  bool good = true;
  TrialRow row;
  row.number = fields.number<int>();
  row.parameter = fields.text();
  row.value = fields.number<double>();
  row.repetition = fields.number<int>();
  row.start_s = fields.number<double>();
  row.asked = read_values(fields);
  row.measured = read_values(fields);
  row.release_s = fields.number<double>();
  row.arrival = read_arrival(fields, good);
  row.keeper = read_keeper(fields, good);
  if (!good || !fields.good() || !fields.ended()) return std::nullopt;
  return row;
}

Result<TrialLog> TrialLog::open(const std::filesystem::path& path) {
  Result<recordings::LineJournal> lines = recordings::LineJournal::open(path);
  if (!lines) return lines.error();
  TrialLog log(*std::move(lines));
  const std::vector<std::string> texts = log.lines_.take_lines();
  if (texts.empty()) {
    if (const Status added = log.lines_.append(trial_header()); !added) {
      return added.error();
    }
    return log;
  }
  if (texts.front() != trial_header()) {
    return bad_input(path.string(), "this is not a table of trials", "name a new file");
  }
  for (std::size_t i = 1; i < texts.size(); ++i) {
    std::optional<TrialRow> row = read_trial_line(texts[i]);
    if (!row) {
      return bad_input(path.string() + ": line " + std::to_string(i + 1),
                       "the row is damaged",
                       "correct it, or name a new file");
    }
    log.earlier_.push_back(*std::move(row));
  }
  return log;
}

Status TrialLog::sync_if_due() {
  return lines_.sync_older_than(std::chrono::milliseconds(500));
}

}  // namespace marey::app
