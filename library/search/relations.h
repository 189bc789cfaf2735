// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/frame_range.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Relations between parts of a body, or of the body and the world, that hold or do not
/// hold in a frame (Müller, Röder and Clausen, "Efficient content-based retrieval of
/// motion capture data", 2005).
enum class Relation : int {
  kLeftHandAboveHead,
  kRightHandAboveHead,
  kLeftHandAboveShoulder,
  kRightHandAboveShoulder,
  kLeftHandBeforeBody,
  kRightHandBeforeBody,
  kLeftHandBehindBody,
  kRightHandBehindBody,
  kLeftHandRaised,
  kRightHandRaised,
  kHandsTogether,
  kLeftInFront,
  kRightInFront,
  kLeftKneeBent,
  kRightKneeBent,
  kLeftFootBears,
  kRightFootBears,
  kFlight,
  kCrouched,
  kLying,
  kMoving,
  kTurningLeft,
  kTurningRight,
};

inline constexpr int kRelationCount = 23;

/// Returns the words of a relation, as queries use them: "hand_left above head".
[[nodiscard]] std::string_view name(Relation relation);

/// Returns the relation with these words, if there is one.
[[nodiscard]] std::optional<Relation> relation(std::string_view words);

/// Returns the relation that holds in the mirrored motion.
[[nodiscard]] Relation mirrored(Relation relation);

/// Frames in which a relation holds without interruption.
struct RelationRun {
  Relation relation{};
  FrameRange frames;  ///< Poses of the motion, counted from 0.
};

/// Finds all runs of all relations, ascending by first frame, then by relation.
///
/// Each relation has one or two measures with two levels. It begins in the first frame in
/// which all measures are at their first level or beyond it, and lasts through the frames
/// in which no measure is short of its second level, so that noise between the levels
/// does not divide a run. Before the first frame it does not hold. Lengths are in leg
/// lengths L (BodyMap::leg_length_m), coordinates (across, up, forward) in the body's
/// level frame, and the floor is at world height 0:
///
/// | relation | measure | begins | lasts |
/// |---|---|---|---|
/// | hand_X above head | height of the hand minus that of the head's joint | 0.15 L |
/// 0.10 L | | hand_X above shoulder | height of the hand minus that of the upper arm |
/// 0.05 L | 0 | | hand_X before body | hand before the trunk's plane | 0.30 L | 0.25 L |
/// | hand_X behind body | hand behind the trunk's plane | 0.10 L | 0.05 L |
/// | hand_X raised | height of the hand minus that of the elbow | 0.10 L | 0.05 L |
/// | hands together | distance of the hands, at most | 0.20 L | 0.25 L |
/// | X in front | forward coordinate of the ankle minus the hips' | 0.12 L | 0.08 L |
/// | knee_X bent | angle of hip, knee and ankle, at most | 120 deg | 125 deg |
/// | foot_X bears | stance of detect_contacts() | | |
/// | flight | neither foot bears, and height of the lower foot over its rest | 0.04 L |
/// 0.02 L | | crouched | not lying, and height of the hip centres, at most | 0.70 L |
/// 0.75 L | | lying | height of the hip centres, at most | 0.45 L | 0.50 L | | | and
/// elevation of the trunk, at most | 30 deg | 40 deg | | moving | level speed of the hips
/// over 0.2 s | 0.40 L/s | 0.25 L/s | | turning_left, turning_right | turn rate over 0.5
/// s | 30 deg/s | 20 deg/s |
///
/// The trunk's plane contains the hip centres' middle, the shoulders' middle and the
/// direction from right to left; its normal points forward. The head's joint is at the
/// base of the skull. Speeds are differences over the stated time around the frame, less
/// at both ends; 0 for a single frame. Relations of hands need that arm's bones
/// (upper arm, lower arm, hand or the tip of the lower arm), `above head` a head;
/// `before`, `behind` and `lying` both upper arms. Without these they never hold.
///
/// Linear in frames times joints. Preconditions: `map` was made from the motion's
/// skeleton; `contacts` are of this motion; the rate is positive.
[[nodiscard]] std::vector<RelationRun> find_relations(const Motion& motion,
                                                      const retarget::BodyMap& map,
                                                      const Contacts& contacts);

}  // namespace marey::library
