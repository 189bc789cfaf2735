// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// A recorded motion of a character that can be adapted: its hips are the root.
struct CapturedClip {
  std::string name;
  Character character;
  double rate_hz = 0.0;
  std::vector<Pose> poses;
};

/// Reads one clip: a .bvh in centimetres, or an .amc with its .asf beside it.
/// Errors: the file cannot be read, or is no human's.
[[nodiscard]] Result<CapturedClip> read_clip(const std::filesystem::path& file,
                                             std::string name);

enum class ClipSet {
  kReaches,  ///< Of hands and feet: punch, scoop, kick, dance, walk.
  kAll,      ///< And CMU's run and jump (02_03, 02_04).
};

/// CMU's punches (02_05) and scoops (02_06), Bandai Namco's kick, CMU's and Bandai's walk
/// and dance, as far as `mocap` holds them, read as `marey` reads them.
/// Errors: a file that exists cannot be read.
[[nodiscard]] Result<std::vector<CapturedClip>> read_clips(
    const std::filesystem::path& mocap, ClipSet set);

/// A posture to start from and one to arrive at, of one clip, and who stands in both.
struct CapturedPair {
  std::size_t near_frame = 0;
  std::size_t far_frame = 0;
  bool left_stands = false;
  bool right_stands = false;
};

/// While a foot stands (its ankle low, and within 3 cm of where the stance began; at most
/// two seconds at a time), the frame in which the wrists and the other ankle are nearest
/// to the body, and that in which they are furthest: wrists from the hips, the ankle from
/// the standing one, distances added. Pairs less than 0.15 m apart in this are left out;
/// the other foot stands, too, if its ankle is low and has moved less than 3 cm from the
/// one frame to the other. At most `most` pairs, those furthest apart; in order of time.
[[nodiscard]] std::vector<CapturedPair> choose_pairs(const CapturedClip& clip,
                                                     std::size_t most);

}  // namespace marey
