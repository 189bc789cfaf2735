// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::retarget {

/// Standing parts of one foot.
struct StandingFoot {
  bool heel = false;
  bool ball = false;
};

struct LiveStanceOptions {
  /// Thresholds of stance detection. Its times and its tolerance for uneven floors need
  /// future postures and are not used.
  DetectContactsOptions contacts;
  /// Time constant of the filter on speeds: noise stays under the thresholds. [s]
  double speed_filter_s = 0.02;
};

/// Detects when the feet of a body stand, posture after posture, without future postures:
/// the online counterpart of detect_contacts(). Uses speed and height with hysteresis in
/// both. The height of a foot's floor relative to that of the rest pose is estimated,
/// since bodies that were fitted to markers stand some centimetres off it.
///
/// Same postures and time steps, same results, to the bit. The floor is about Y = 0.
/// Allocates nothing.
class LiveStance {
 public:
  explicit LiveStance(const LiveStanceOptions& options = {}) : options_(options) {}

  /// Processes the next posture.
  /// Preconditions: `map` is of the posture's body, the same from call to call;
  /// since_last_s > 0.
  void step(const BodyMap& map,
            std::span<const RigidTransform> world_from_joint,
            double since_last_s);
  /// Resets: the next posture is treated as the first one.
  void reset() { *this = LiveStance(options_); }

  /// Result of the last step(). Left, right.
  [[nodiscard]] const std::array<StandingFoot, 2>& standing() const { return standing_; }
  /// Height of the floor under this foot above that of its rest pose. [legs]
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
  void estimate_floor(std::size_t side,
                      double height_legs,
                      double speed_legs_per_s,
                      double since_last_s);

  LiveStanceOptions options_;
  std::array<Contact, 4> contacts_{};  // Left and right ankle, left and right ball.
  std::array<double, 2> floor_offsets_legs_{};
  std::array<StandingFoot, 2> standing_{};
};

}  // namespace marey::retarget
