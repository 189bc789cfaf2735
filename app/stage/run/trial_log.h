// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/run/keeper_response.h"
#include "core/base/result.h"
#include "recordings/base/line_journal.h"

namespace marey::app {

/// The seven parameters of a throw, in the units of a trial list
/// (docs/formats/trials.md).
struct TrialValues {
  glm::dvec3 place_m{0.0};  ///< Wrist at release: left, up, forward of the hips.
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
  double speed_m_s = 0.0;
  double release_s = 0.0;  ///< Since the start of the throw.
};

/// Arrival of a ball in the plane of the goal.
struct TrialArrival {
  double time_s = 0.0;  ///< On the clock of the scene.
  glm::dvec3 p_in_world{0.0};
};

/// One throw of a study, and the keeper's response to it.
struct TrialRow {
  int number = 1;         ///< Place in the order of the study, from 1.
  std::string parameter;  ///< Word of a trial list: "speed_m_s".
  double value = 0.0;     ///< In the unit of the word; 0 for "captured".
  int repetition = 1;     ///< From 1.
  double start_s = 0.0;   ///< On the clock of the scene.
  TrialValues asked;
  TrialValues measured;
  double release_s = 0.0;  ///< On the clock of the scene.
  std::optional<TrialArrival> arrival;
  std::optional<KeeperResponse> keeper;
};

/// Returns the names of the columns, separated by commas.
[[nodiscard]] std::string trial_header();
/// Returns a row as a line of the table; absent values are empty cells. Numbers read back
/// as the same values. Precondition: no comma or line end in `parameter`.
[[nodiscard]] std::string trial_line(const TrialRow& row);
/// Reads trial_line(); nullopt: it is damaged.
[[nodiscard]] std::optional<TrialRow> read_trial_line(std::string_view line);

/// The table of a study (trials.csv): a row for each throw, appended when the ball has
/// arrived. A row is in the file when add() returns, so it survives the death of the
/// process; sync_if_due() bounds the loss by a power cut to one second.
class TrialLog {
 public:
  /// Opens or creates the table. Rows of a study that was interrupted are kept, without a
  /// row that is incomplete. Errors: LineJournal::open()'s; (kBadInput) another table; a
  /// damaged row, with its line.
  [[nodiscard]] static Result<TrialLog> open(const std::filesystem::path& path);

  /// Rows that were in the file when it was opened.
  [[nodiscard]] const std::vector<TrialRow>& earlier_rows() const { return earlier_; }
  /// Errors (kDevice): the disk is full or failed; then the table is as before.
  [[nodiscard]] Status add(const TrialRow& row) { return lines_.append(trial_line(row)); }
  /// Writes rows to the disk that have waited for half a second. To be called several
  /// times a second.
  [[nodiscard]] Status sync_if_due();

 private:
  explicit TrialLog(recordings::LineJournal lines) : lines_(std::move(lines)) {}

  recordings::LineJournal lines_;
  std::vector<TrialRow> earlier_;
};

}  // namespace marey::app
