// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/figures/body_figures.h"
#include "app/stage/figures/figure_body.h"
#include "app/stage/run/stage_record.h"

namespace marey::app {

/// One body of a record in the form that figures take.
class RecordedBody {
 public:
  /// Precondition: the body exists.
  RecordedBody(const StageRecord& record, std::size_t body);
  /// Valid while this and the record live.
  [[nodiscard]] const FigureBody& view() const { return view_; }
  RecordedBody(const RecordedBody&) = delete;
  RecordedBody& operator=(const RecordedBody&) = delete;

 private:
  void add_floor(const StageRecord& record, std::size_t body);

  std::vector<double> times_s_;
  std::vector<std::array<FigureFloor, 2>> floor_;
  FigureBody view_;
};

/// Returns a target's places for one user, the `member`-th of its figure, in all steps:
/// those of the record, else computed from the target's path. Empty: it has no body
/// point.
[[nodiscard]] std::vector<glm::dvec3> recorded_target(const StageRecord& record,
                                                      const std::string& target,
                                                      std::size_t user,
                                                      std::size_t member);

/// Returns the clips that a body plays and their times, its idle clip in the rest.
[[nodiscard]] std::vector<PlayedClip> played_clips(const StageRecord& record,
                                                   std::size_t body);

}  // namespace marey::app
