// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/marker_tracks.h"
#include "reconstruct/markers/fit_markers.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/motion/mot.h"

namespace marey {

/// Ends the program with a message.
[[noreturn]] void stop(const std::string& text);

/// The recordings of one person, and the fit of the person to them.
struct MarkerPerson {
  std::vector<MarkerTracks> trials;
  reconstruct::MarkersFit fit;
};

/// Ends the program when the file cannot be read.
[[nodiscard]] MarkerTracks read_tracks(const std::filesystem::path& file);

/// Names the labels and fits the person, with only the tracks as input. Ends the program
/// when there is no fit.
[[nodiscard]] reconstruct::MarkersFit fit_person(std::span<const MarkerTracks> trials);

/// Reads the tracks of the files and fits the person.
[[nodiscard]] MarkerPerson read_person(std::span<const std::filesystem::path> files);

/// Ends the program when there is no motion.
[[nodiscard]] reconstruct::SolvedMarkers solve(const Body& body,
                                               const MarkerTracks& tracks);

/// The joint angles of a solved trial at the times of its tracks.
[[nodiscard]] recordings::MotTable angles_of(const reconstruct::SolvedMarkers& solved,
                                             const MarkerTracks& tracks);

/// Every joint of every frame. [m]
[[nodiscard]] std::vector<std::vector<glm::dvec3>> joints_of(const Motion& motion);

/// Distances, pooled. [m]
class Distances {
 public:
  void add(double distance_m);
  void add(const Distances& others);
  [[nodiscard]] bool empty() const { return all_m_.empty(); }
  [[nodiscard]] std::size_t size() const { return all_m_.size(); }
  [[nodiscard]] double rms_mm() const;
  [[nodiscard]] double mean_mm() const;
  /// As quantile().
  [[nodiscard]] double quantile_mm(double share) const;

 private:
  std::vector<double> all_m_;
};

// One function per benchmark; `mocap` is the folder ../shared/data/mocap.
int measure_running(const std::filesystem::path& mocap);
int measure_flexion(const std::filesystem::path& mocap);
int measure_studio(const std::filesystem::path& mocap);
int measure_dropouts(const std::filesystem::path& mocap);
int measure_speed(const std::filesystem::path& mocap);
int measure_flight(const std::filesystem::path& mocap);

}  // namespace marey
