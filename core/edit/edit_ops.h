// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/edit/annotation.h"
#include "core/edit/body_group.h"
#include "core/edit/contact_edit.h"
#include "core/edit/moment.h"
#include "core/humanoid.h"

namespace marey {

// The operations of a recipe (docs/formats/edit_recipe.md). Each is plain data: what it
// does is in edit/ops/. Span, groups and fades are EditOp's.

/// Keeps the span and drops the rest.
struct CutOp {};

/// Keeps several spans: each becomes a motion of its own.
struct KeepOp {
  std::vector<EditSpan> spans{};
};

/// Divides the motion at these instants: each part becomes a motion of its own.
struct SplitOp {
  std::vector<Moment> at{};
};

/// Joins another source to the end of the motion.
struct SpliceOp {
  std::string source{};        ///< Id of the source that follows.
  std::optional<Moment> at{};  ///< Leaves this motion here; nullopt: the best frame.
  std::optional<Moment> enter_at{};  ///< Enters the other here; nullopt: the best frame.
  /// Time that both overlap. 0: none; both are displaced towards each other. nullopt: 0.3
  /// s, or longer where a joint would accelerate more than in both motions. [s]
  std::optional<double> overlap_s{};
  /// The other source is turned and moved about the vertical so that it fits.
  bool align = true;
};

enum class FilterMethod { kGcvSpline, kButterworth };
enum class CutoffRule { kGiven, kYu, kWinter };

/// Removes noise.
struct FilterOp {
  FilterMethod method = FilterMethod::kGcvSpline;
  int order = 2;  ///< Order of the spline: 2 is cubic, 3 is quintic.
  CutoffRule cutoff = CutoffRule::kWinter;  ///< For kButterworth.
  double cutoff_hz = 0.0;                   ///< For kGiven.
  bool keep_contacts = true;                ///< Standing feet stay where they stood.
};

/// Makes the floor under the feet level, and moves it to `floor_height_m`.
struct LevelOp {
  bool tilt = true;  ///< False: moves the motion only, without rotating it.
  double floor_height_m = 0.0;
};

/// Moves and turns the whole motion about the vertical.
struct PlaceOp {
  std::optional<glm::dvec2>
      position_xz_m{};  ///< Place of the root at `at`. World X and Z.
  /// Direction of travel over the span, or of the pelvis if the motion stays in place: 0
  /// is +Z, a quarter turn is +X.
  std::optional<double> heading_rad{};
  Moment at = AtFrame{};
};

/// Bends the path of the root, with its footprints.
struct PathOp {
  std::vector<glm::dvec2>
      points_xz_m{};      ///< The new path; empty: `turn_rad` and `length`.
  double turn_rad = 0.0;  ///< Turn of the end against the start; positive to the left.
  double length = 1.0;    ///< Factor of the length.
  bool straight = false;  ///< Removes the turn of the path first.
};

/// Exchanges left and right.
struct MirrorOp {};

struct RetimeKnot {
  Moment at{};          ///< In the motion as it is.
  double time_s = 0.0;  ///< In the result.
  bool operator==(const RetimeKnot&) const = default;
};
/// Changes the time of the motion by a smooth monotone map.
struct RetimeOp {
  std::vector<RetimeKnot> knots{};     ///< Ascending in both times.
  std::optional<double> speed{};       ///< 2 is twice as fast.
  std::optional<double> duration_s{};  ///< Duration of the result.
  std::optional<double> rate_hz{};     ///< Rate of the result; nullopt: as before.
};

enum class CycleDrift {
  kStraight,  ///< The travel of a cycle is kept, its turn is removed.
  kKeep,      ///< Travel and turn are kept.
  kNone,      ///< The motion stays in place.
};
/// Makes a loop of the best cycle of the motion.
struct CyclifyOp {
  std::optional<double> min_period_s{};
  std::optional<double> max_period_s{};
  std::optional<Moment> from{};  ///< nullopt: the best pair of frames.
  std::optional<Moment> to{};
  CycleDrift drift = CycleDrift::kStraight;
  int cycles = 1;      ///< Number of copies in the result.
  bool force = false;  ///< Accepts a motion that is not cyclic.
};

/// Makes the feet stand still during their contacts.
struct PlantOp {};

/// Detects the contacts of the feet again, or changes them by hand.
struct ContactsOp {
  bool detect = false;
  std::vector<ContactEdit> edits{};
};

enum class DetectConstraints { kSupports, kTouches };
/// An object of the scene that hands can touch: a box along the world's axes.
struct EditObject {
  std::string name{};
  glm::dvec3 min_in_world{0.0};
  glm::dvec3 max_in_world{0.0};
};
/// A change by hand of a constraint that the motion has, such as a detected one. Members
/// without a value keep those of the constraint.
struct ConstraintChange {
  std::string name{};  ///< Its id.
  std::optional<Moment>
      start{};                   ///< AtTime: Activation::start_s; else fully active from.
  std::optional<Moment> stop{};  ///< Activation::stop_s.
  std::optional<double> start_duration_s{};
  std::optional<double> stop_duration_s{};
  /// New place of its goal: a point, a footprint, or the middle of a box.
  std::optional<glm::dvec3> p_in_world{};
};
/// Adds a constraint, or the constraints that are detected in the motion, or changes
/// them.
struct ConstrainOp {
  std::optional<Constraint> constraint{};
  std::optional<Moment>
      from{};  ///< Start of the constraint, by an annotation or a frame.
  std::optional<Moment> to{};
  std::optional<DetectConstraints> detect{};
  std::vector<EditObject> objects{};        ///< For kTouches.
  std::vector<ConstraintChange> changes{};  ///< Applied after the detection.
  bool adapt = false;  ///< The motion is adapted to its constraints now.
};

/// Sets a part of the body at one instant, with a smooth displacement around it.
struct PoseOp {
  Moment at = AtFrame{};
  HumanBone bone = HumanBone::kHips;
  /// Rotation that is added to the bone, in the frame of its parent.
  std::optional<glm::dquat> rotation{};
  /// Displacement of a hand, a foot or the hips in the world; the limb follows. [m]
  std::optional<glm::dvec3> moved_m{};
  double width_s = 0.5;  ///< Time before and after the instant in which it fades.
};

/// Adds a constant displacement.
struct OffsetOp {
  HumanBone bone = HumanBone::kHips;
  std::optional<glm::dquat> rotation{};  ///< In the frame of the bone's parent.
  std::optional<glm::dvec3> moved_m{};   ///< Translation of the root in the world. [m]
};

/// Changes the speed by a constant factor: 2 is twice as fast.
struct ScaleTimeOp {
  double speed = 1.0;
};

/// Amplifies the movement between two frequencies.
struct ExaggerateOp {
  double gain = 1.5;
  double low_hz = 0.0;
  double high_hz = 0.0;  ///< 0: no upper limit.
};

enum class EditPushLaw { kForce, kThesis };
/// Lowest point of a push, for EditPushLaw::kThesis.
struct EditLowestPoint {
  double at = 0.5;        ///< Share of the push's duration, within (0, 1).
  double height_m = 0.0;  ///< Height of the centre of mass, world Y.
  bool operator==(const EditLowestPoint&) const = default;
};
/// Makes one jump of the motion higher, longer or different (`marey jump`). Members
/// without a value keep what the captured jump has.
struct JumpOp {
  int jump = 1;  ///< Number of the jump within the span, from 1.
  /// Highest point of the centre of mass above the take-off's floor, or added to the
  /// captured one. At most one of both. [m]
  std::optional<double> apex_m{};
  std::optional<double> apex_by_m{};
  std::optional<double> airtime_s{};
  /// Distance between the middles of the soles at take-off and landing. [m]
  std::optional<double> length_m{};
  /// Middle of the soles at landing. Excludes length_m and box_m.
  std::optional<glm::dvec3> landing_in_world{};
  /// Height of the landing's floor above the take-off's. [m]
  std::optional<double> box_m{};
  std::optional<double> push_s{};      ///< Duration of the push.
  std::optional<Moment> push_start{};  ///< Start of the push; nullopt: found.
  EditPushLaw law = EditPushLaw::kForce;
  std::optional<EditLowestPoint> lowest{};  ///< For kThesis; nullopt: the captured one.
  std::optional<double> strength_g{};       ///< Largest push, in g.
  double gravity_m_s2 = 9.81;               ///< 0.5 to 30.
  bool ballistic = false;                   ///< The captured flight becomes a parabola.
  bool keep_momentum = true;                ///< Constant angular momentum in flight.
};

enum class EditBalance {
  kHorizontal,  ///< The centre of mass, while the body stands still.
  kZmp,         ///< The zero moment point, of the whole motion.
};
/// Keeps the centre of mass over the feet.
struct BalanceOp {
  EditBalance mode = EditBalance::kHorizontal;
};

/// Adds an annotation over the span ("tag").
struct TagOp {
  std::string text{};
};
/// Adds an annotation at an instant ("event").
struct EventOp {
  std::string text{};
  Moment at = AtFrame{};
};
struct CurveKey {
  Moment at{};
  double value = 0.0;
  bool operator==(const CurveKey&) const = default;
};
/// Adds a number per frame, linear between keys ("curve").
struct CurveOp {
  std::string name{};
  std::vector<CurveKey> keys{};
};

/// Puts the motion on an avatar. No operation that needs the first body may follow.
struct RetargetOp {
  std::string avatar{};     ///< Path of the avatar's file, relative to the recipe.
  bool keep_world = false;  ///< Metres of the path are kept instead of scaled.
};

using EditOpParameters = std::variant<CutOp,
                                      KeepOp,
                                      SplitOp,
                                      SpliceOp,
                                      FilterOp,
                                      LevelOp,
                                      PlaceOp,
                                      PathOp,
                                      MirrorOp,
                                      RetimeOp,
                                      CyclifyOp,
                                      PlantOp,
                                      ContactsOp,
                                      ConstrainOp,
                                      PoseOp,
                                      OffsetOp,
                                      ScaleTimeOp,
                                      ExaggerateOp,
                                      JumpOp,
                                      BalanceOp,
                                      TagOp,
                                      EventOp,
                                      CurveOp,
                                      RetargetOp>;

/// The version of every operation so far.
inline constexpr int kEditOpVersion = 1;

/// One operation of a recipe.
struct EditOp {
  EditOpParameters parameters;
  int version = 1;  ///< The results of a version never change.
  bool off = false;
  EditSpan span{};  ///< Part of the motion that is changed.
  /// Fades of the effect before and after the span, with continuous speed and
  /// acceleration. [s]
  double blend_s = 0.0;
  std::vector<EditGroup> groups{};  ///< Empty: the whole body.
  std::string why{};                ///< Free text.
  int line = 0;                     ///< In the recipe's file; 0: unknown.
};

/// Returns the name of an operation in recipes, without its version: "scale_time".
[[nodiscard]] std::string_view name(const EditOpParameters& parameters);
/// Returns an operation with default parameters; nullopt: no operation has this name.
[[nodiscard]] std::optional<EditOpParameters> edit_op(std::string_view op_name);
/// Returns the names of all operations, in the order of the variant.
[[nodiscard]] std::vector<std::string_view> edit_op_names();

}  // namespace marey
