// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/prepare_member.h"

#include <algorithm>

#include "core/base/smooth_step.h"

namespace marey::retarget {
namespace {

glm::dvec3 plain(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

glm::dquat plain(const Quat<float>& q) {
  return unit_rotation(q.w, q.x, q.y, q.z);
}

/// Frame of a joint in the reference, in units from the reference's root.
struct ReferenceFrame {
  Quat<float> rotation;
  Vec3<float> place;
};

// Returns the frame of joint `j`, equal to the bit to that of stand_reference().
ReferenceFrame reference_frame(const Plan& plan,
                               const PackedProblem& problem,
                               std::span<const float> body,
                               int j) {
  const auto i = static_cast<std::size_t>(j);
  const float* q = &problem.posture[4 * i];
  const Quat<float> own{q[0], q[1], q[2], q[3]};
  if (plan.parent[i] < 0) return {own, {0.0F, 0.0F, 0.0F}};
  const ReferenceFrame parent = reference_frame(plan, problem, body, plan.parent[i]);
  const Vec3<float> offset{body[3 * i], body[3 * i + 1], body[3 * i + 2]};
  return {parent.rotation * own, parent.place + rotate(parent.rotation, offset)};
}

// Stores the place of a support in the reference when it begins, until it ends.
void follow_support(const Plan& plan,
                    const PackedProblem& problem,
                    const Member& member,
                    int joint,
                    bool active,
                    MemberTarget& target) {
  if (!active) target.has_begun = false;
  if (!active || target.has_begun) return;
  const double unit_m = member.head().unit_m;
  const ReferenceFrame frame = reference_frame(plan, problem, member.numbers(), joint);
  const Vec3<float> at =
      frame.place +
      rotate(frame.rotation, lanes<float>(target.numbers.in_joint / unit_m));
  target.begun_in_world = member.head().origin_in_world + plain(at) * unit_m;
  target.begun_rotation = plain(frame.rotation);
  target.has_begun = true;
}

void read_support(const Plan& plan,
                  const PackedProblem& problem,
                  const Member& member,
                  int joint,
                  MemberTarget& target,
                  TargetNumbers& numbers) {
  follow_support(plan, problem, member, joint, numbers.active, target);
  if (!target.is_placed) {
    numbers.a_in_world =
        target.has_begun ? target.begun_in_world : member.head().origin_in_world;
  }
  if (target.is_turned) return;
  if (target.is_placed && !target.turns) {
    // The position is given, the rotation is that of the current reference.
    numbers.world_from_joint =
        plain(reference_frame(plan, problem, member.numbers(), joint).rotation);
  } else {
    numbers.world_from_joint =
        target.has_begun ? target.begun_rotation : glm::dquat(1, 0, 0, 0);
  }
}

void read_targets(const Plan& plan,
                  const Member& member,
                  double time_s,
                  PackedProblem& problem) {
  std::vector<double>& activations = problem.activations;
  std::vector<double>& ramps = problem.ramps;
  const std::span<MemberTarget> targets = member.targets();
  double max_weight = 0.0;
  ramps.clear();
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const double activation = member.activations()[c].at(time_s);
    activations[k] = activation;
    member.outcomes()[c].activation = activation;
    TargetNumbers& numbers = problem.numbers[k];
    numbers = targets[c].numbers;
    numbers.active = activation > 0.0;
    if (targets[c].other >= 0) {
      numbers.b = targets[static_cast<std::size_t>(targets[c].other)].numbers.in_joint;
    }
    if (point.goal == GoalKind::kSupport) {
      read_support(plan, problem, member, point.joint, targets[c], numbers);
    }
    if (activation > 0.0 && point.level > 0) {
      max_weight = std::max(max_weight, numbers.weight);
    }
    const bool fades = activation > 0.0 && activation < 1.0;
    if (fades && std::find(ramps.begin(), ramps.end(), activation) == ramps.end()) {
      ramps.push_back(activation);
    }
  }
  std::sort(ramps.begin(), ramps.end(), [](double a, double b) { return a > b; });
  problem.max_weight = max_weight;
}

BalanceNumbers balance_of(const MemberHead& head) {
  const AdaptOptions& options = head.options;
  BalanceNumbers out;
  out.wanted = options.balance != BalanceMode::kOff;
  out.vertical = options.balance == BalanceMode::k3d;
  out.precision_m = options.balance_precision_m;
  out.constraint_threshold_m = options.constraint_threshold_m;
  out.balance_threshold_m = options.balance_threshold_m;
  out.from_reference = !head.com_in_world;
  out.com_in_world = head.com_in_world.value_or(glm::dvec3(0.0));
  // Balance uses the root completely along its axes (thesis 5.3.2).
  out.root_weight =
      out.vertical ? options.root_for_balance : options.root_for_constraints;
  out.root_weight_on_floor =
      out.wanted ? options.root_for_balance : options.root_for_constraints;
  return out;
}

// Updates the progress of the fade from one control to the other.
void pass_over(double time_s, MemberHead& head) {
  head.control = head.options.control;
  head.left_share = 0.0;
  const double duration_s = head.options.control_change_s;
  if (duration_s <= 0.0) head.passed = 1.0;
  if (head.passed >= 1.0) return;
  if (!head.passes_since_s) head.passes_since_s = time_s - head.passed * duration_s;
  head.passed = std::clamp((time_s - *head.passes_since_s) / duration_s, 0.0, 1.0);
  head.left_share = 1.0 - smooth_step(head.passed);
}

/// Prefetches memory into the cache where the compiler supports it.
void prefetch(const void* memory, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  const auto* at = static_cast<const char*>(memory);
  for (std::size_t n = 0; n < bytes; n += kLine) {
#if defined(__GNUC__)
    __builtin_prefetch(at + n);
#endif
  }
}

}  // namespace

PackedProblem::PackedProblem(const Plan& plan)
    : posture(4 * plan.parent.size()),
      targets(kNumbersPerTarget * plan.points.size()),
      numbers(plan.points.size()),
      activations(plan.points.size()),
      firmness(plan.points.size()) {
  ramps.reserve(plan.points.size() + 1);
}

bool prepare_member(const Plan& plan,
                    const Member& member,
                    const Pose& reference,
                    double time_s,
                    PackedProblem& problem) {
  MemberHead& head = member.head();
  head.origin_in_world = reference.root_in_world;
  pack_posture(reference, problem.posture);
  pack_balance(head.unit_m, head.origin_in_world, balance_of(head), problem.balance);
  read_targets(plan, member, time_s, problem);
  pass_over(time_s, head);
  if (!problem.ramps.empty() || head.left_share > 0.0) return false;
  pack_pass(plan, member, {head.control, 1.0, 1.0F}, problem);
  return true;
}

bool is_fading(const Member& member, double time_s) {
  for (const LiveActivation& live : member.activations()) {
    const double activation = live.at(time_s);
    if (activation > 0.0 && activation < 1.0) return true;
  }
  return false;
}

int fade_pass_count(const MemberHead& head, const PackedProblem& problem) {
  const int each = static_cast<int>(problem.ramps.size()) + 1;
  return head.left_share > 0.0 ? 2 * each : each;
}

// With activations 1 = a0 > a1 > ... > an > an+1 = 0 the posture for all constraints with
// an activation of at least ai has the weight ai - ai+1.
FadePass fade_pass(const MemberHead& head, const PackedProblem& problem, int number) {
  const std::vector<double>& ramps = problem.ramps;
  auto n = static_cast<std::size_t>(number);
  const bool is_left = head.left_share > 0.0 && n <= ramps.size();
  if (head.left_share > 0.0 && !is_left) n -= ramps.size() + 1;
  const double weight = is_left ? head.left_share : 1.0 - head.left_share;
  const double above = n == 0 ? 1.0 : ramps[n - 1];
  const double next = n < ramps.size() ? ramps[n] : 0.0;
  return {is_left ? head.left_control : head.options.control,
          above,
          static_cast<float>(weight * (above - next))};
}

void pack_pass(const Plan& plan,
               const Member& member,
               const FadePass& pass,
               PackedProblem& problem) {
  const MemberHead& head = member.head();
  // The thesis weights errors by importance in both modes (equation 4.2).
  const bool blends =
      pass.control == Control::kBlend || head.options.method == Method::kThesis;
  for (std::size_t k = 0; k < problem.numbers.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const bool weighs = blends && point.level > 0 && problem.max_weight > 0.0;
    problem.numbers[k].weight =
        weighs ? member.targets()[c].numbers.weight / problem.max_weight : 1.0;
    const double activation = problem.activations[k];
    problem.numbers[k].active = activation >= pass.min_activation && activation > 0.0;
  }
  pack_targets(plan, head.unit_m, head.origin_in_world, problem.numbers, problem.targets);
}

void pack_mean(const Plan& plan, const Member& member, PackedProblem& problem) {
  const MemberHead& head = member.head();
  for (std::size_t k = 0; k < problem.numbers.size(); ++k) {
    const double activation = problem.activations[k];
    problem.numbers[k].active = activation > kFirmActivation;
    problem.firmness[k] = static_cast<float>(
        smooth_step((activation - kFirmActivation) / (1.0 - kFirmActivation)));
  }
  pack_targets(plan, head.unit_m, head.origin_in_world, problem.numbers, problem.targets);
}

LaneTask task_of(const SharedPlan& shared, const AdaptOptions& options, Control control) {
  LaneTask out;
  out.plan = &shared.plan;
  out.shape.rows.balance = options.balance != BalanceMode::kOff;
  for (const PointPlan& point : shared.plan.points) {
    if (point.goal == GoalKind::kSupport) ++out.shape.rows.supports;
  }
  // A blend solves all levels together, by their weights.
  out.shape.by_level = control == Control::kPriority;
  out.shape.last_level = std::max(1, shared.plan.level_count);
  out.settings.blend = control == Control::kBlend;
  out.settings.keeps_orientation = options.extremities_keep_orientation;
  out.settings.max_iterations = options.max_iterations;
  out.by_thesis = options.method == Method::kThesis;
  out.thesis = &shared.thesis;
  return out;
}

void prefetch_member(const Member& member) {
  prefetch(member.block(), member.hot_bytes());
}

void prefetch_address(const Pose& pose) {
  prefetch(&pose, sizeof(Pose));
}

void prefetch_pose(const Pose& pose) {
  prefetch(pose.parent_from_joint.data(),
           pose.parent_from_joint.size() * sizeof(pose.parent_from_joint[0]));
}

}  // namespace marey::retarget
