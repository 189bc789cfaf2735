// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Part of measure_sessions: one row per session, in files whose tables add up.

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/truth/judge_session.h"
#include "tests/support/truth/session_oracle.h"

namespace marey::benchmarks {

/// Result of one session.
struct SessionRow {
  std::uint64_t seed = 0;
  testing::SessionVerdict verdict;
  bool is_sufficient = false;
  std::string lacking;
  std::string refused_by;
  std::string message_class;
  std::string causes;    ///< Persistent gross errors: "leftFoot:fit leftHand:flip".
  std::string left_out;  ///< Hands and feet that the body lacks.
  std::string session;   ///< SimulatedSession::summary().
  int cameras = 0;
  /// Body::joint_centre_sigma_m; not in the table.
  std::array<double, kHumanBoneCount> fit_sigma_m{};
  double fit_s = 0.0;
  double solve_s = 0.0;
};

void write_header(std::ostream& out);
void write_row(std::ostream& out, const SessionRow& row);

/// Reads the rows of such a file. Returns nullopt for any other content.
[[nodiscard]] std::optional<std::vector<SessionRow>> read_rows(std::istream& in);

/// Prints the table of docs/accuracy/simulated_sessions.md.
void print_table(const std::vector<SessionRow>& rows);

}  // namespace marey::benchmarks
