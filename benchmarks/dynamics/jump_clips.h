// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/retarget/contact_trials.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/human/body_track.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey {

/// Time without load on any force plate, between two loads.
struct PlateFlight {
  double takeoff_s = 0.0;  ///< On the clock of the motion: its first pose is at 0.
  double landing_s = 0.0;
};

/// A captured motion with all that dynamics needs.
struct JumpClip {
  std::string name;
  std::string kind;  ///< "jump", "run", "walk" or "clip".
  Motion motion;
  retarget::BodyMap map;
  std::vector<PointMass> masses;  ///< de Leva, 70 kg.
  BodyTrack track;
  std::vector<PlateFlight> plate_flights;  ///< Empty without plates.
  std::vector<PlateLoad> loads;            ///< Vertical force of each foot or plate.
  /// Instants at which the sum of the loads begins to exceed kLoaded_N.
  std::vector<double> plate_touchdowns_s;
  /// plate_clock(): delay of the plates after the motion. Not applied to the times above.
  std::optional<double> plate_delay_s;

  /// Rate of a frame, number of frames, duration.
  [[nodiscard]] double hz() const { return motion.rate.hz; }
  [[nodiscard]] std::size_t frames() const { return motion.poses.size(); }
};

/// Sum of the vertical forces of all plates at a time; 0 outside of the recording. [N]
[[nodiscard]] double plate_force_N(const JumpClip& clip, double time_s);

/// Completes a clip from its motion: map, masses, track. Errors: map_body()'s and
/// place_masses()'s.
[[nodiscard]] Result<JumpClip> jump_clip_of(std::string name,
                                            std::string kind,
                                            Motion motion);

/// Reads a .bvh or .amc in the same way as `marey`.
[[nodiscard]] Result<JumpClip> read_jump_clip(const std::filesystem::path& file,
                                              const std::string& kind);

/// Reads a recording with markers and plates, and fits the person to the markers.
[[nodiscard]] Result<JumpClip> read_plate_clip(const std::filesystem::path& mocap,
                                               const ContactSource& source);

/// Reads drop jump DJ1, Rajagopal's run and walk, and Hamner's run, with their plates,
/// as far as `mocap` holds them. Ends the program, with a message, if a file cannot be
/// read. Fitting takes seconds.
[[nodiscard]] std::vector<JumpClip> plate_clips(const std::filesystem::path& mocap);

/// Reads DJ2's markers, without its plates: a second jump of the person of DJ1.
[[nodiscard]] std::optional<JumpClip> read_second_drop_jump(
    const std::filesystem::path& mocap);

/// Reads the true motion of the rendered jump at 120 Hz from `data`/blender/dev.
[[nodiscard]] std::optional<JumpClip> read_rendered_jump(
    const std::filesystem::path& data);

/// Reads the clips that jump or run: DJ1, DJ2, CMU 02_03 and 02_04, the rendered jump,
/// Rajagopal's run and walk, Hamner's run. `data` is the shared data.
[[nodiscard]] std::vector<JumpClip> jump_clips(const std::filesystem::path& data);

}  // namespace marey
