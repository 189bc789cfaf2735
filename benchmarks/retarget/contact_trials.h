// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey {

/// Force above which a plate counts as loaded. [N]
inline constexpr double kLoaded_N = 20.0;

/// An edge of a contact as the force plates saw it.
struct PlateEdge {
  double time_s = 0.0;  ///< On the clock of the motion: its first pose is at 0.
  int side = 0;         ///< 0 left, 1 right.
  bool is_strike = false;
};

/// Time in which a plate is loaded, on the clock of the motion.
struct LoadInterval {
  double first_s = 0.0;
  double last_s = 0.0;
};

/// Vertical force on a plate, or on a foot, without the plate's offset.
struct PlateLoad {
  std::vector<double> time_s;  ///< On the clock of the motion.
  std::vector<double> force_N;
  std::vector<LoadInterval> intervals;  ///< Above kLoaded_N.
};

/// A recording with markers and force plates. The motion is fitted to the markers.
struct ContactTrial {
  std::string name;
  std::string kind;       ///< "run", "walk" or "jump".
  bool is_tuned = false;  ///< The rules were chosen with this recording in view.
  Motion motion;
  retarget::BodyMap map;
  std::vector<PlateEdge> edges;  ///< In the order of time.
  std::vector<PlateLoad> loads;
  /// Marker on the heel of the left and of the right foot per frame, in the world; empty
  /// if there is none.
  std::array<std::vector<std::optional<glm::dvec3>>, 2> heel_markers;
};

/// Location of a recording below the folder `mocap` of the shared data.
struct ContactSource {
  std::string name;
  std::string kind;
  bool is_tuned = false;
  std::string markers;               ///< C3D or TRC.
  std::vector<std::string> support;  ///< Other recordings of the same person.
  /// Table of forces; empty: the plates are those of the C3D.
  std::string forces;
  /// Vertical force of the left and of the right foot.
  std::array<std::string, 2> columns;
};

/// Returns all recordings that have plates and markers of both feet.
[[nodiscard]] std::vector<ContactSource> contact_sources();

/// Reads a recording and fits the person to its markers. The edges are the instants at
/// which the vertical force of a foot, interpolated between samples, passes kLoaded_N.
/// A load shorter than 50 ms is none. Edges of a C3D's plate are assigned to the foot
/// nearest to the centre of pressure; an edge of a foot that was not wholly on the plate
/// is left out.
[[nodiscard]] Result<ContactTrial> read_contact_trial(const std::filesystem::path& mocap,
                                                      const ContactSource& source);

}  // namespace marey
