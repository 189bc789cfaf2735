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

/// Reads one clip: a .bvh in centimetres, or an .amc with its .asf in the same folder.
/// Errors: the file cannot be read, or is no human's.
[[nodiscard]] Result<CapturedClip> read_clip(const std::filesystem::path& file,
                                             std::string name);

enum class ClipSet {
  kReaches,  ///< Reaches of hands and feet: punch, scoop, kick, dance, walk.
  kAll,      ///< Also CMU's run and jump (02_03, 02_04).
};

/// Reads CMU's punches (02_05) and scoops (02_06), Bandai Namco's kick, CMU's and
/// Bandai's walk and dance, as far as `mocap` holds them, in the same way as `marey`.
/// Errors: a file that exists cannot be read.
[[nodiscard]] Result<std::vector<CapturedClip>> read_clips(
    const std::filesystem::path& mocap, ClipSet set);

/// A start posture and an end posture of one clip, and the feet that stand in both.
struct CapturedPair {
  std::size_t near_frame = 0;
  std::size_t far_frame = 0;
  bool left_stands = false;
  bool right_stands = false;
};

/// Finds one pair per stance of a foot. In a stance the ankle is low and within 3 cm of
/// its position at the start; a stance lasts at most two seconds. The pair is the frame
/// in which the wrists and the other ankle are nearest to the body, and the frame in
/// which they are furthest. The measure is the sum of the wrists' distances from the hips
/// and of the other ankle's distance from the standing one. Pairs with a difference of
/// less than 0.15 m are left out. The other foot also stands if its ankle is low and
/// moves less than 3 cm between the two frames. Returns at most `max_pairs` pairs with
/// the largest differences, in order of time.
[[nodiscard]] std::vector<CapturedPair> choose_pairs(const CapturedClip& clip,
                                                     std::size_t max_pairs);

}  // namespace marey
