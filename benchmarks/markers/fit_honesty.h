// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "reconstruct/markers/solve_markers.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::benchmarks {

/// Counts errors against the standard deviations that they come with, in fits to labelled
/// markers of simulated people.
class FitHonesty {
 public:
  /// Adds every fifth frame's limb joints that are called measured, by joint.
  void add_joints(const Body& person,
                  const testing::Movement& movement,
                  const reconstruct::SolvedMarkers& solved);

  /// Hides two markers of a trial for half of it, one after the other, and adds where the
  /// skeleton has them, and where the repair of gaps has them.
  void add_hidden_markers(int seed, const Body& body, const MarkerTracks& tracks);

  /// Prints a row for each kind: samples, shares within the ball of 95 % and of 99 %.
  void print() const;

 private:
  /// Squared errors over squared standard deviations per coordinate.
  std::map<std::string, std::vector<double>> squares_;
};

}  // namespace marey::benchmarks
