// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/adapt/crowd_scenes.h"

#include <array>
#include <cstring>
#include <utility>
#include <variant>

#include "tests/retarget/adapter_bodies.h"

namespace marey::retarget {
namespace {

/// Corresponding segments of a human and a quadruped.
struct Places {
  const char* hand;
  const char* other_hand;
  const char* foot;
  const char* other_foot;
  const char* elbow;
  const char* head;
  const char* back;
};
constexpr Places kHuman{
    "leftHand", "rightHand", "leftFoot", "rightFoot", "leftLowerArm", "head", "chest"};
constexpr Places kQuadruped{"front left paw",
                            "front right paw",
                            "hind left paw",
                            "hind right paw",
                            "front left lower",
                            "head",
                            "back3"};

const Places& places_of(const Character& body) {
  return body.skeleton.find(HumanBone::kHips) ? kHuman : kQuadruped;
}

Character like(const Character& body, Dice& dice) {
  Character out = body;
  const double size = dice.between(0.6, 1.3);
  for (Joint& joint : out.skeleton.joints) {
    joint.parent_from_joint.translation *= size * dice.between(0.9, 1.1);
  }
  for (PointMass& mass : out.masses) {
    mass.mass_kg *= dice.between(0.7, 1.4);
    mass.p_in_joint *= size * dice.between(0.9, 1.1);
  }
  for (JointLimit& limit : out.limits) {
    limit.min_rad *= dice.between(0.8, 1.0);
    limit.max_rad *= dice.between(0.8, 1.0);
  }
  return out;
}

/// Targets of one body at one moment.
class Asker {
 public:
  Asker(const Character& body, const Pose& reference, Dice& dice)
      : body_(body), at_(places_of(body)), reference_(reference), dice_(dice) {}

  ConstraintSet ask(CrowdTargets wishes, std::size_t number) {
    switch (wishes) {
      case CrowdTargets::kHands:
        return {hands(), {}};
      case CrowdTargets::kSupports:
        return {supports(), {}};
      case CrowdTargets::kRelations:
        return {relations(), {}};
      case CrowdTargets::kFading:
        return {fading(number), {}};
      case CrowdTargets::kInactive:
        return {met(number), {}};
    }
    return {};
  }

 private:
  [[nodiscard]] glm::dvec3 place(const char* segment) const {
    return place_of(body_, reference_, {segment});
  }
  // From within reach to far beyond.
  glm::dvec3 near(const char* segment) {
    constexpr std::array<double, 4> kFar_m{0.02, 0.15, 0.5, 2.0};
    const auto n = static_cast<std::size_t>(dice_.between(0.0, 3.999));
    return place(segment) + dice_.between(0.3, 1.0) * kFar_m[n] * dice_.direction();
  }

  std::vector<Constraint> hands() {
    Constraint elbow =
        contact("elbow", at_.elbow, near(at_.elbow), {0.0, 0.0, 0.03}, 1.0);
    elbow.range = 3;
    return {contact("hand", at_.hand, near(at_.hand), {0.05, 0.0, 0.02}, 3.0),
            contact("other hand", at_.other_hand, near(at_.other_hand), {}, 2.0),
            contact("foot", at_.foot, near(at_.foot), {}, 2.0),
            elbow};
  }

  std::vector<Constraint> supports() {
    Constraint placed = standing("placed", at_.foot);
    placed.goal = Support{place(at_.foot) + 0.2 * dice_.direction(), std::nullopt, false};
    return {placed,
            standing("begun", at_.other_foot),
            contact("hand", at_.hand, near(at_.hand), {}, 2.0),
            contact("other hand", at_.other_hand, near(at_.other_hand), {}, 1.0)};
  }

  std::vector<Constraint> relations() {
    Constraint apart = contact("apart", at_.hand, {}, {}, 2.0);
    apart.goal = DistanceToConstraint{dice_.between(0.1, 0.6), "other hand"};
    Constraint from_head = contact("from head", at_.elbow, {}, {0.0, 0.0, 0.02});
    from_head.goal = DistanceToBody{dice_.between(0.2, 0.5), {at_.head, {}}};
    Constraint around = contact("other hand", at_.other_hand, {});
    around.goal = DistanceToPoint{dice_.between(0.05, 0.4), near(at_.other_hand)};
    Constraint within = contact("within", at_.foot, {}, {}, 3.0);
    const glm::dvec3 corner = near(at_.foot);
    within.goal = AllowedSpace{corner, corner + glm::dvec3(0.1, 0.2, 0.3)};
    Constraint without = contact("without", at_.other_foot, {});
    const glm::dvec3 low = place(at_.other_foot) - glm::dvec3(0.1, 0.1, 0.05);
    without.goal = ForbiddenSpace{low, low + glm::dvec3(0.15, 0.3, 0.1)};
    return {apart,
            from_head,
            around,
            within,
            without,
            turned("foot turned", at_.foot),
            turned("head turned", at_.head),
            turned("back turned", at_.back)};
  }

  Constraint turned(const char* id, const char* segment) {
    Constraint out = contact(id, segment, {});
    out.goal =
        SegmentOrientation{dice_.turn(0.6) * rotation_of(body_, reference_, segment)};
    return out;
  }

  // Moments are whole seconds.
  std::vector<Constraint> fading(std::size_t number) {
    std::vector<Constraint> out = hands();
    if (number % 3 == 1) out[0].activation = {0.4, std::nullopt, 2.0, 0.0};
    if (number % 6 == 4) out[2].activation = {-9.0, 0.5, 1.0, 1.1};
    return out;
  }

  std::vector<Constraint> met(std::size_t number) {
    std::vector<Constraint> out{contact("hand", at_.hand, place(at_.hand), {}, 2.0),
                                contact("other", at_.other_hand, near(at_.other_hand)),
                                standing("stands", at_.foot)};
    out[1].activation.start_s = number % 2 == 0 ? 1e6 : 1.0;
    if (number % 3 == 0) out[2].activation.start_s = 1e6;
    return out;
  }

  const Character& body_;
  const Places& at_;
  const Pose& reference_;
  Dice& dice_;
};

bool same(const void* a, const void* b, std::size_t bytes) {
  return std::memcmp(a, b, bytes) == 0;
}

template <class T>
bool same(const T& a, const T& b) {
  return same(&a, &b, sizeof(T));
}

}  // namespace

std::vector<CrowdMember> make_members(const Character& body,
                                      CrowdTargets wishes,
                                      std::size_t count,
                                      std::size_t moments,
                                      Dice& dice) {
  std::vector<CrowdMember> members;
  for (std::size_t i = 0; i < count; ++i) {
    CrowdMember member;
    member.character = like(body, dice);
    member.character.name = "member " + std::to_string(i);
    member.carries = !body.loads.empty() && i % 2 == 1;
    for (std::size_t n = 0; n + 1 < moments; ++n) {
      CrowdQuestion question;
      // Rest poses contain many zeros, of both signs.
      question.reference = (i + n) % 4 == 0 ? rest_pose(member.character.skeleton)
                                            : random_posture(member.character, dice, 0.4);
      question.wishes = Asker(member.character, question.reference, dice).ask(wishes, i);
      if ((i + n) % 3 != 0) {
        question.com_in_world =
            centre_of_mass(member.character, question.reference) + 0.1 * dice.direction();
      }
      member.questions.push_back(std::move(question));
    }
    member.questions.push_back(member.questions.front());
    member.wishes = member.questions.front().wishes;
    members.push_back(std::move(member));
  }
  return members;
}

void ask(const CrowdQuestion& question, Adapter& adapter) {
  for (const Constraint& wish : question.wishes.constraints) {
    Adapter::Handle handle = *adapter.constraint(wish.id);
    if (const auto* point = std::get_if<DistanceToPoint>(&wish.goal)) {
      handle.set_target(point->p_in_world);
    } else if (const auto* support = std::get_if<Support>(&wish.goal)) {
      if (support->footprint_in_world) handle.set_target(*support->footprint_in_world);
    } else if (const auto* turned = std::get_if<SegmentOrientation>(&wish.goal)) {
      handle.set_orientation(turned->world_from_t_pose);
    } else if (const auto* within = std::get_if<AllowedSpace>(&wish.goal)) {
      handle.set_space(within->min_in_world, within->max_in_world);
    } else if (const auto* without = std::get_if<ForbiddenSpace>(&wish.goal)) {
      handle.set_space(without->min_in_world, without->max_in_world);
    }
  }
  adapter.set_balance_target(question.com_in_world);
}

CrowdAnswer answer_of(Adapter& adapter,
                      const ConstraintSet& wishes,
                      const Pose& pose,
                      const AdaptReport& report) {
  const auto frames = adapter.world_from_joint();
  CrowdAnswer out{pose,
                  report,
                  {frames.begin(), frames.end()},
                  adapter.centre_of_mass_in_world(),
                  {}};
  for (const Constraint& wish : wishes.constraints) {
    out.outcomes.push_back(adapter.constraint(wish.id)->outcome());
  }
  return out;
}

std::string difference(const CrowdAnswer& a, const CrowdAnswer& b) {
  if (a.report.iterations != b.report.iterations) {
    return "iterations " + std::to_string(a.report.iterations) + " and " +
           std::to_string(b.report.iterations);
  }
  for (std::size_t j = 0; j < a.pose.parent_from_joint.size(); ++j) {
    const glm::dquat& p = a.pose.parent_from_joint[j];
    const glm::dquat& q = b.pose.parent_from_joint[j];
    if (same(p, q)) continue;
    return "rotations of joint " + std::to_string(j) + ", by " +
           std::to_string(angle_between_rad(p, q)) + " rad";
  }
  if (!same(a.pose.root_in_world, b.pose.root_in_world)) return "roots";
  for (std::size_t j = 0; j < a.world_from_joint.size(); ++j) {
    if (!same(a.world_from_joint[j], b.world_from_joint[j])) {
      return "world place of joint " + std::to_string(j);
    }
  }
  if (!same(a.com_in_world, b.com_in_world)) return "centre of mass";
  if (!same(a.report.constraint_error_m, b.report.constraint_error_m)) {
    return "mean errors";
  }
  if (!same(a.report.worst_error_m, b.report.worst_error_m) ||
      !same(a.report.worst_error_rad, b.report.worst_error_rad)) {
    return "worst errors";
  }
  if (a.report.capped != b.report.capped) return "caps";
  if (!same(a.report.balance_error_m, b.report.balance_error_m)) {
    return "balance errors";
  }
  for (std::size_t k = 0; k < a.outcomes.size(); ++k) {
    if (!same(a.outcomes[k].activation, b.outcomes[k].activation) ||
        !same(a.outcomes[k].error_m, b.outcomes[k].error_m) ||
        !same(a.outcomes[k].error_rad, b.outcomes[k].error_rad) ||
        a.outcomes[k].met != b.outcomes[k].met) {
      return "outcome " + std::to_string(k);
    }
  }
  return {};
}

std::vector<LaneWidth> lane_widths() {
  std::vector<LaneWidth> out;
  for (const LaneWidth width :
       {LaneWidth::kOne, LaneWidth::kFour, LaneWidth::kEight, LaneWidth::kSixteen}) {
    if (width <= max_lanes()) out.push_back(width);
  }
  return out;
}

}  // namespace marey::retarget
