// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"

namespace marey::retarget {

/// Which parts of one foot stand.
struct StandingFoot {
  bool heel = false;
  bool ball = false;
};

struct LiveStanceOptions {
  /// When a foot stands; its times and its uneven floors need the future and do not
  /// count.
  DetectContactsOptions contacts;
  /// Time constant of the filter on speeds: noise stays under the thresholds. [s]
  double speed_filter_s = 0.02;
};

/// When the feet of a body stand, posture after posture, knowing nothing of the future:
/// what detect_contacts() is for whole motions. By speed and height with hysteresis in
/// both; how much higher than its rest pose's floor a foot stands is learned: bodies that
/// were fitted to markers stand some centimetres off it.
///
/// Same postures and time steps, same answers, to the bit. The floor is about Y = 0.
/// Allocates nothing.
class LiveStance {
 public:
  explicit LiveStance(const LiveStanceOptions& options = {}) : options_(options) {}

  /// The next posture. Preconditions: `map` is of the posture's body, the same from call
  /// to call; since_last_s > 0.
  void step(const BodyMap& map,
            std::span<const RigidTransform> world_from_joint,
            double since_last_s);
  /// The next posture is taken as a first one.
  void forget() { *this = LiveStance(options_); }

  /// Of the last step(). Left, right.
  [[nodiscard]] const std::array<StandingFoot, 2>& standing() const { return standing_; }
  /// How much higher than its rest pose's floor this foot stands. [legs]
  [[nodiscard]] double floor_offset_legs(std::size_t side) const {
    return floor_offsets_legs_[side];
  }

 private:
  /// One joint of a foot. Lengths in leg lengths.
  struct Contact {
    double speed_legs_per_s(const glm::dvec3& p_legs,
                            double since_last_s,
                            const LiveStanceOptions& options);
    bool rests(double height_legs, const DetectContactsOptions& o);

    bool is_known = false;
    bool is_resting = false;
    glm::dvec3 before_legs{0.0};
    glm::dvec3 velocity_legs_per_s{0.0};
  };
  void learn_floor(std::size_t side,
                   double height_legs,
                   double speed_legs_per_s,
                   double since_last_s);

  LiveStanceOptions options_;
  std::array<Contact, 4> contacts_{};  // Left and right ankle, left and right ball.
  std::array<double, 2> floor_offsets_legs_{};
  std::array<StandingFoot, 2> standing_{};
};

}  // namespace marey::retarget
