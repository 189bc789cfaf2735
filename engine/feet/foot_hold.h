// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/signal/quintic.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

struct FootHoldOptions {
  double land_s = 0.20;     ///< A landing that is expected is prepared for this long.
  double brake_s = 0.06;    ///< Time in which a foot stops that bears unexpectedly.
  double release_s = 0.20;  ///< Time in which a leaving foot returns to its own path.
  /// A foot that would have to stay this far from its own path is released. [legs]
  double slip_legs = 0.3;
  /// Feet whose soles are higher than this do not bear. [legs]
  double max_height_legs = 0.08;
};

/// A foot of the posture before its contacts: the reference.
struct FootReference {
  glm::dvec3 ankle_in_world{0.0};
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
  bool heel_bears = false;
  bool ball_bears = false;
  /// Turn of the root in this step that is not the clips': a steered walk's. A foot that
  /// bears on heel or ball does not take part in it. [rad]
  double steered_rad = 0.0;
  /// The next landing, if it is within FootHoldOptions::land_s.
  struct Landing {
    double in_s = 0.0;  ///< Time until it.
    /// Ankle of the reference then, and its velocity. Only the height is used.
    glm::dvec3 ankle_in_world{0.0};
    glm::dvec3 velocity_m_s{0.0};
    /// Place in which the foot will stand, from the reference then: horizontal.
    glm::dvec3 shift_in_world{0.0};
    bool is_flat = false;  ///< Heel and ball bear: the foot stops turning.
    /// Rotation in which it will stand from that of the reference then, as a rotation
    /// vector in the world, and the reference's angular velocity.
    glm::dvec3 turn_rad{0.0};
    glm::dvec3 spin_rad_s{0.0};
  };
  std::optional<Landing> landing{};
};

/// Keeps one foot where it stands while it bears: on its ankle with the whole foot or the
/// heel, on its ball when the heel is raised. The ankle's displacement from the reference
/// has continuous speed and acceleration, except in a landing that was not expected,
/// where the acceleration jumps. Allocates nothing.
class FootHold {
 public:
  void reset() { *this = FootHold(); }

  /// The ankle's place and the foot's rotation from the T-pose.
  struct Place {
    glm::dvec3 ankle_in_world{0.0};
    glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
  };
  /// Precondition: step_s > 0; finite.
  Place step(const FootReference& reference,
             const retarget::FootMap& foot,
             double leg_length_m,
             double step_s,
             const FootHoldOptions& options);

  /// True if the foot stands now.
  [[nodiscard]] bool holds() const { return mode_ != Mode::kFree; }

 private:
  enum class Mode { kFree, kHeel, kFlat, kBall };
  [[nodiscard]] Mode mode_of(const FootReference& reference,
                             const retarget::FootMap& foot,
                             double leg_length_m,
                             const FootHoldOptions& options);
  void change(Mode mode, const retarget::FootMap& foot, const FootHoldOptions& options);
  void release(const FootHoldOptions& options);
  void stand(const glm::dvec3& p_in_world,
             const glm::dvec3& velocity_m_s,
             double height_m,
             const FootHoldOptions& options);
  void fade_turn(const FootReference& reference, double step_s);
  [[nodiscard]] glm::dvec3 free_ankle(const FootReference& reference,
                                      const retarget::FootMap& foot,
                                      double step_s);
  void observe(const FootReference& reference, const Place& place, double step_s);

  bool is_known_ = false;
  Mode mode_ = Mode::kFree;
  bool slipped_ = false;  ///< Not to bear again before the reference leaves the floor.
  double since_change_s_ = 0.0;
  double fade_s_ = 0.1;  ///< Duration of the fade that began with the last change.
  /// Free: the ankle's displacement from the reference. Standing: that of the standing
  /// point from its place. [m]
  Motion2<glm::dvec3> displacement_;
  /// Rotation vector in the world: from the reference, or in kFlat from the standing
  /// rotation. [rad]
  Motion2<glm::dvec3> turn_;
  double steered_rad_s_ = 0.0;
  double held_yaw_rad_ = 0.0;  ///< In kHeel and kBall: from the reference, before turn_.
  glm::dvec3 stands_in_world_{0.0};  ///< Ankle, or ball in kBall.
  glm::dquat stands_rotation_{1.0, 0.0, 0.0, 0.0};
  // Reference and result of the last step, with their velocities by differences.
  Place last_reference_;
  Place last_place_;
  Motion2<glm::dvec3> reference_motion_;
  Motion2<glm::dvec3> place_motion_;
  glm::dvec3 reference_spin_rad_s_{0.0};
  glm::dvec3 place_spin_rad_s_{0.0};
};

}  // namespace marey::engine
