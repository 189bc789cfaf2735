// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace marey {

/// One request to an engine, between two of its steps. The engine defines numbers and
/// texts of each kind (engine/record/request_fields.h).
struct EngineRequest {
  std::int64_t step = 0;  ///< Number of steps that were done before it.
  int character = 0;
  std::string kind;  ///< "play", "push".
  std::vector<double> numbers;
  std::vector<std::string> texts;
  bool operator==(const EngineRequest&) const = default;
};

/// All requests of a run of an engine, from which it can be repeated to the byte with the
/// same characters and motion base.
struct EngineLog {
  double step_hz = 0.0;
  std::int64_t steps = 0;               ///< Length of the run.
  std::vector<std::string> characters;  ///< Names, by character.
  std::vector<std::string> clips;       ///< Names and sums, by clip of the base.
  std::vector<EngineRequest> requests;  ///< Ascending by step; in their order.
  bool operator==(const EngineLog&) const = default;
};

}  // namespace marey
