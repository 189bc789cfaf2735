// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/time.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::retarget {

/// Part of the foot that touches the floor first.
enum class FootPart : unsigned char { kHeel, kBall };

/// Rule that gave the time of an edge.
enum class EdgeRule : unsigned char {
  kHeight,   ///< Strike after a flight: the foot comes down to its lowest height.
  kArrest,   ///< Strike while the other foot bears: the foot's descent is arrested.
  kSlowing,  ///< The same if the foot lands softly: its advance ends.
  kLeaving,  ///< Toe-off: the ball leaves its place.
};

/// Start or end of a stance, between frames.
struct ContactEdge {
  double time_s = 0.0;  ///< Since the motion's first pose.
  FootPart part = FootPart::kHeel;
  EdgeRule rule = EdgeRule::kSlowing;
};

/// Edges of one stance. An edge is absent if the motion begins or ends within the stance,
/// or before the rule applies.
struct StanceEdges {
  FrameRange stance;  ///< The stance as detected.
  std::optional<ContactEdge> strike;
  std::optional<ContactEdge> toe_off;
};

struct ContactEdges {
  std::array<std::vector<StanceEdges>, 2> feet;  ///< Left, right; ascending.
  /// Velocity of the floor, horizontal: 0, or that of a treadmill's belt. [m/s]
  glm::dvec3 floor_velocity_in_world{0.0};
};

/// Lengths and speeds are in leg lengths.
struct ContactEdgeOptions {
  /// Height of a part above its lowest height of the stance at a strike after a flight.
  double strike_height_legs = 0.0135;
  /// Horizontal speed of the part relative to the floor at any other strike, as a share
  /// of its maximum in the swing before.
  double strike_speed_share = 0.1;
  /// Minimum step of the ball's vertical acceleration at such a strike. Softer strikes
  /// are timed by the speed alone.
  double arrest_legs_per_s2 = 12.0;
  /// The foot's descent is arrested this long after the force passes 20 N.
  double arrest_delay_s = 0.006;
  /// Speed of the ball relative to the floor at toe-off. The vertical speed counts half.
  double toe_off_speed_legs_per_s = 1.2;
  /// The body is in flight if the other foot is higher than this above its lowest height.
  double flight_height_legs = 0.035;
  double smoothing_s = 0.04;  ///< Span of the line fits that give the speeds.
  double search_s = 0.15;     ///< Maximum distance of an edge from the detected one.
};

/// Finds when the foot of each stance strikes the floor and leaves it, as force plates
/// would record it, between frames. detect_contacts() finds the frames in which a foot is
/// at rest, which begin some 50 ms after the strike and end some 50 ms before toe-off.
///
/// - Strike after a flight (run, landing): the first instant at which the back of the
///   heel, the ball or the toe tip is within `strike_height_legs` of its lowest height of
///   the next 0.15 s.
/// - Strike while the other foot bears (walk): the instant at which the descent of the
///   ball is arrested (find_descent_arrest()), less `arrest_delay_s`. It is searched near
///   the instant from which the horizontal speed of the heel (or of the ball, if it slows
///   down first) remains below `strike_speed_share`. If the ball's acceleration steps by
///   less than `arrest_legs_per_s2`, that instant is the strike. A walking heel hovers
///   just above the floor long before the strike, so heights do not give this edge.
/// - Toe-off: the first instant at which the ball is faster than
///   `toe_off_speed_legs_per_s`. A walking toe leaves low and rises late, a running one
///   rises first, so that both directions count.
///
/// Heights are relative to those of the same stance: a floor that is uneven or off Y = 0
/// does not matter. docs/accuracy/contact_edges.md has errors against force plates.
///
/// This function uses `contacts` as they are, on a floor at rest. Linear in frames.
/// Precondition: `map` and `contacts` were made from the motion; the rate is positive.
[[nodiscard]] ContactEdges find_contact_edges(const Motion& motion,
                                              const BodyMap& map,
                                              const Contacts& contacts,
                                              const ContactEdgeOptions& options = {});

/// Detects the contacts, then finds their edges. If no foot is ever at rest, the subject
/// may be on a treadmill: the belt's velocity is the commonest velocity of the balls
/// while low, and the contacts are those relative to the belt. A motion without contacts
/// (all flight) has no edges. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton; the rate is positive.
[[nodiscard]] ContactEdges find_contact_edges(const Motion& motion,
                                              const BodyMap& map,
                                              const ContactEdgeOptions& options = {});

/// Moves the edges of the stances to these: the first frame at or after the strike, the
/// last frame at or before toe-off. The heel or ball contact that begins or ends the
/// stance moves with it. A stance keeps at least one of its frames, and a frame between
/// two stances.
/// Precondition: `edges` are those of `contacts`, which are of a motion at that rate.
void move_to_edges(const ContactEdges& edges, FrameRate rate, Contacts& contacts);

/// Detects contacts that last from the strike to toe-off, on a floor at rest: applies
/// move_to_edges() to those of detect_contacts(). A foot still moves in the first and the
/// last frames of such a contact. To plant feet, use the contacts of detect_contacts().
/// Linear in frames.
/// Precondition: as detect_contacts().
[[nodiscard]] Contacts detect_loaded_contacts(
    const Motion& motion,
    const BodyMap& map,
    const DetectContactsOptions& options = {},
    const ContactEdgeOptions& edge_options = {});

}  // namespace marey::retarget
