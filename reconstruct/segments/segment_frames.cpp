// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/segment_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "reconstruct/clusters/find_joint_centres.h"
#include "reconstruct/segments/cluster_geometry.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

class FrameFinder {
 public:
  FrameFinder(std::span<const TagCluster> clusters,
              std::span<const ClusterPoses> standing,
              std::span<const ClusterPoses> moving,
              const Proportions& average)
      : average_(average), standing_(medoid_poses(standing)) {
    for (const TagCluster& cluster : clusters) {
      inside_[cluster.segment] = place_inside(cluster);
      clusters_[cluster.segment] = &cluster;
    }
    frames_.assign(standing.begin(), standing.end());
    frames_.insert(frames_.end(), moving.begin(), moving.end());
    out_.lengths = lengths_of(average);
    out_.body = body_constants(average);
  }

  Result<SegmentFrames> run() {
    for (const B bone : {B::kHips, B::kUpperChest}) {
      if (!standing_.contains(bone)) return unseen(bone);
    }
    for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
      if (const Status ok = find_limb_centres(limb); !ok) return ok.error();
      slide_along_hinge(limb);
    }
    set_hips();
    set_thorax();
    set_trunk_lengths();
    for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) set_limb(limb);
    set_head();
    for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) set_extremity(limb);
    return out_;
  }

 private:
  // Minimum root mean square sine of the flexion of a limb that bends.
  static constexpr double kBendsAtAll = 0.1;

  struct LimbCentres {
    glm::dvec3 root_in_trunk{0.0};
    glm::dvec3 root_in_upper{0.0};
    glm::dvec3 mid_in_upper{0.0};
    glm::dvec3 mid_in_lower{0.0};
    glm::dvec3 end_in_lower{0.0};
    std::optional<glm::dvec3> end_in_extremity;
  };

  static Error unseen(B bone) {
    return bad_input("",
                     "no tag of segment \"" + std::string(name(bone)) +
                         "\" is seen well enough in the static and range-of-motion "
                         "trials",
                     "glue a tag to that segment, list it under [[tags.tag]], and let "
                     "two cameras see it while standing and moving");
  }

  std::vector<SegmentPair> pairs(B a, B b) const {
    std::vector<SegmentPair> out;
    for (const ClusterPoses& frame : frames_) {
      const auto in_a = frame.find(a);
      const auto in_b = frame.find(b);
      if (in_a != frame.end() && in_b != frame.end()) {
        out.push_back({in_a->second, in_b->second});
      }
    }
    return out;
  }

  std::optional<JointCentre> centre(B a, B b) const {
    if (!inside_.contains(a) || !inside_.contains(b)) return std::nullopt;
    return find_joint_centre(pairs(a, b), inside_.at(a), inside_.at(b));
  }

  Status find_limb_centres(std::size_t limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const B trunk = limb < 2 ? B::kUpperChest : B::kHips;
    LimbCentres& c = centres_[limb];
    const auto root = centre(trunk, bones.upper);
    if (!root) return unseen(bones.upper);
    const auto mid = centre(bones.upper, bones.lower);
    if (!mid) return unseen(bones.lower);
    c.root_in_trunk = root->p_in_a;
    c.root_in_upper = root->p_in_b;
    c.mid_in_upper = mid->p_in_a;
    c.mid_in_lower = mid->p_in_b;
    // Hands and feet are rarely seen, and a centre from a few wrong poses of their tags
    // rotates the lower bone: the end of a straight limb in the standing frames is a
    // sufficient initial value.
    const auto end = centre(bones.lower, bones.end);
    if (end) c.end_in_extremity = end->p_in_b;
    if (const auto straight = straight_end(limb)) {
      c.end_in_lower = *straight;
      return Done{};
    }
    if (!end) return unseen(bones.end);
    c.end_in_lower = end->p_in_a;
    return Done{};
  }

  /// Returns the end of the lower bone, in its cluster's frame, for a limb that is
  /// straight while standing and of usual length. nullopt if its bones are not seen then.
  std::optional<glm::dvec3> straight_end(std::size_t limb) const {
    const HumanLimb& bones = human_limbs()[limb];
    const LimbCentres& c = centres_[limb];
    if (!standing_.contains(bones.upper) || !standing_.contains(bones.lower)) {
      return std::nullopt;
    }
    const glm::dvec3 along = glm::normalize(standing_.at(bones.upper).rotation *
                                            (c.mid_in_upper - c.root_in_upper));
    const double length_m = glm::length(average_[bones.end]);
    return c.mid_in_lower +
           glm::conjugate(standing_.at(bones.lower).rotation) * (along * length_m);
  }

  /// Returns the sum of squared distances between the bone's axis and the lines along its
  /// tags' normals. [m^2]
  double off_axis_m2(B bone, const glm::dvec3& origin, const glm::dvec3& axis) const {
    double sum = 0.0;
    for (const auto& [tag, cluster_from_tag] : clusters_.at(bone)->cluster_from_tag) {
      const glm::dvec3 normal = cluster_from_tag.rotation * glm::dvec3(0, 0, 1);
      const glm::dvec3 across = glm::cross(axis, normal);
      // A tag that faces along the bone gives no information.
      const double off_m = glm::dot(cluster_from_tag.translation - origin, across) /
                           (glm::length(across) + 0.05);
      sum += off_m * off_m;
    }
    return sum;
  }

  /// Movement hardly determines the position of a knee or elbow along its hinge: there it
  /// comes from the tags, which face away from the bones.
  void slide_along_hinge(std::size_t limb) {
    constexpr double kMaxDistance_m = 0.15;
    constexpr double kStep_m = 0.005;
    // Weight of a slide in the cost: a metre of slide counts like this distance off the
    // axes.
    constexpr double kInertia = 0.1;
    const HumanLimb& bones = human_limbs()[limb];
    if (!standing_.contains(bones.upper) || !standing_.contains(bones.lower)) return;
    LimbCentres& c = centres_[limb];
    const glm::dvec3 in_upper = hinge_in(bones.upper, limb);
    const glm::dvec3 in_lower = hinge_in(bones.lower, limb);
    if (glm::length(in_upper) < kBendsAtAll || glm::length(in_lower) < kBendsAtAll)
      return;
    const glm::dvec3 hinge_in_upper = glm::normalize(in_upper);
    const glm::dvec3 hinge_in_lower = glm::normalize(in_lower);
    double best_m = 0.0;
    double min_m2 = std::numeric_limits<double>::infinity();
    for (double slide_m = -kMaxDistance_m; slide_m <= kMaxDistance_m;
         slide_m += kStep_m) {
      const glm::dvec3 upper =
          glm::normalize(c.mid_in_upper + slide_m * hinge_in_upper - c.root_in_upper);
      const glm::dvec3 lower = glm::conjugate(standing_.at(bones.lower).rotation) *
                               (standing_.at(bones.upper).rotation * upper);
      const double off_m2 =
          off_axis_m2(bones.upper, c.root_in_upper, upper) +
          off_axis_m2(bones.lower, c.mid_in_lower + slide_m * hinge_in_lower, lower) +
          kInertia * kInertia * slide_m * slide_m;
      if (off_m2 >= min_m2) continue;
      min_m2 = off_m2;
      best_m = slide_m;
    }
    c.mid_in_upper += best_m * hinge_in_upper;
    c.mid_in_lower += best_m * hinge_in_lower;
    if (const auto straight = straight_end(limb)) c.end_in_lower = *straight;
  }

  void set_hips() {
    const RigidTransform& world = standing_.at(B::kHips);
    const glm::dvec3 left = centres_[2].root_in_trunk;
    const glm::dvec3 right = centres_[3].root_in_trunk;
    const glm::dvec3 up = glm::conjugate(world.rotation) * glm::dvec3(0, 1, 0);
    const glm::dquat turn = rotation_onto(left - right, up, {1, 0, 0}, {0, 1, 0});
    const glm::dvec3 origin = turn * (0.5 * (left + right)) +
                              glm::dvec3(0, out_.body.hips_above_hip_centres_m, 0);
    out_.segment_from_cluster[B::kHips] = {turn, -origin};
    out_.lengths[index(Length::kHalfHipWidth)] = 0.5 * glm::length(left - right);
  }

  void set_thorax() {
    const RigidTransform& world = standing_.at(B::kUpperChest);
    const glm::dvec3 left = centres_[0].root_in_trunk;
    const glm::dvec3 right = centres_[1].root_in_trunk;
    const glm::dvec3 up = glm::conjugate(world.rotation) * glm::dvec3(0, 1, 0);
    const glm::dquat turn = rotation_onto(left - right, up, {1, 0, 0}, {0, 1, 0});
    const auto usual_m = [&](Length length) { return out_.lengths[index(length)]; };
    const glm::dvec3 base(usual_m(Length::kShoulderOut),
                          usual_m(Length::kShoulderUp),
                          usual_m(Length::kShoulderForward));
    const glm::dvec3 origin =
        turn * (0.5 * (left + right)) - glm::dvec3(0, base.y, base.z);
    out_.segment_from_cluster[B::kUpperChest] = {turn, -origin};
    const double clavicle_m = std::max(0.05, 0.5 * glm::length(left - right) - base.x);
    out_.lengths[index(Length::kLeftShoulder)] = clavicle_m;
    out_.lengths[index(Length::kRightShoulder)] = clavicle_m;
  }

  void set_trunk_lengths() {
    const auto origin = [&](B bone) {
      return (standing_.at(bone) * inverse(out_.segment_from_cluster.at(bone)))
          .translation;
    };
    const double height_m = glm::distance(origin(B::kHips), origin(B::kUpperChest));
    constexpr std::array<Length, 3> kTrunk{
        Length::kSpine, Length::kChest, Length::kUpperChest};
    double usual_m = 0.0;
    for (const Length l : kTrunk) usual_m += out_.lengths[index(l)];
    for (const Length l : kTrunk) out_.lengths[index(l)] *= height_m / usual_m;
  }

  /// Returns the hinge in the frame of bone `reference`, as long as the root mean square
  /// sine of the limb's bends: the mean direction of upper x lower over all frames. A
  /// limb that bends far bends in its natural direction, which determines the sign: small
  /// bends in both directions (a person who stands with bent elbows) do not outweigh a
  /// few large ones.
  glm::dvec3 hinge_in(B reference, std::size_t limb) const {
    const HumanLimb& bones = human_limbs()[limb];
    const LimbCentres& c = centres_[limb];
    const glm::dvec3 u = glm::normalize(c.mid_in_upper - c.root_in_upper);
    const glm::dvec3 l = glm::normalize(c.end_in_lower - c.mid_in_lower);
    std::vector<Eigen::Vector3d> bends;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const SegmentPair& pair : pairs(bones.upper, bones.lower)) {
      const glm::dvec3 in_world =
          glm::cross(pair.world_from_a.rotation * u, pair.world_from_b.rotation * l);
      const glm::dquat& frame = reference == bones.upper ? pair.world_from_a.rotation
                                                         : pair.world_from_b.rotation;
      const glm::dvec3 bend = glm::conjugate(frame) * in_world;
      bends.emplace_back(bend.x, bend.y, bend.z);
      spread += bends.back() * bends.back().transpose();
    }
    if (bends.empty()) return glm::dvec3(0.0);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spectrum(
        spread / static_cast<double>(bends.size()));
    Eigen::Vector3d hinge = spectrum.eigenvectors().col(2);
    double skew = 0.0;
    for (const Eigen::Vector3d& bend : bends) skew += std::pow(hinge.dot(bend), 3);
    hinge *= std::copysign(std::sqrt(std::max(0.0, spectrum.eigenvalues()[2])), skew);
    return {hinge.x(), hinge.y(), hinge.z()};
  }

  void set_limb(std::size_t limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const LimbCentres& c = centres_[limb];
    const glm::dvec3 along = limb_axis(limb);
    const auto place = [&](B bone, const glm::dvec3& from, const glm::dvec3& to) {
      glm::dvec3 hinge = hinge_in(bone, limb);
      if (glm::length(hinge) < kBendsAtAll) hinge = standing_hinge(bone, limb);
      const glm::dquat turn = rotation_onto(to - from, hinge, along, bones.hinge_axis);
      out_.segment_from_cluster[bone] = {turn, -(turn * from)};
    };
    place(bones.upper, c.root_in_upper, c.mid_in_upper);
    place(bones.lower, c.mid_in_lower, c.end_in_lower);
    out_.lengths[index(kLimbParameters[limb].upper)] =
        glm::distance(c.root_in_upper, c.mid_in_upper);
    out_.lengths[index(kLimbParameters[limb].lower)] =
        glm::distance(c.mid_in_lower, c.end_in_lower);
  }

  /// Returns the hinge of a limb that never bent: that of a T-pose rotated to a hanging
  /// limb.
  glm::dvec3 standing_hinge(B bone, std::size_t limb) const {
    const B trunk = limb < 2 ? B::kUpperChest : B::kHips;
    const glm::dquat world_from_trunk =
        standing_.at(trunk).rotation *
        glm::conjugate(out_.segment_from_cluster.at(trunk).rotation);
    const auto here = standing_.find(bone);
    const glm::dquat world =
        here != standing_.end() ? here->second.rotation : world_from_trunk;
    const glm::dvec3 axis =
        limb < 2 ? glm::dvec3(limb == 0 ? -1.0 : 1.0, 0.0, 0.0) : glm::dvec3(1, 0, 0);
    return glm::conjugate(world) * (world_from_trunk * axis);
  }

  glm::dquat standing_rotation(B bone) const {
    return standing_.at(bone).rotation *
           glm::conjugate(out_.segment_from_cluster.at(bone).rotation);
  }

  void set_head() {
    if (!standing_.contains(B::kHead)) return;
    const RigidTransform thorax = standing_.at(B::kUpperChest) *
                                  inverse(out_.segment_from_cluster.at(B::kUpperChest));
    const double neck_m =
        out_.lengths[index(Length::kNeck)] + out_.lengths[index(Length::kHead)];
    place_standing(
        B::kHead,
        rotation_onto(
            {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, thorax.rotation * glm::dvec3(1, 0, 0)),
        thorax * glm::dvec3(0, neck_m, 0));
  }

  void set_extremity(std::size_t limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const LimbCentres& c = centres_[limb];
    if (!c.end_in_extremity) return;
    if (!standing_.contains(bones.end) || !standing_.contains(bones.lower)) {
      set_extremity_moving(limb);
      return;
    }
    const glm::dquat lower = standing_rotation(bones.lower);
    const glm::dquat flat =
        rotation_onto({0, 1, 0}, {1, 0, 0}, {0, 1, 0}, lower * glm::dvec3(1, 0, 0));
    const glm::dquat world = limb < 2 ? lower : flat;
    const glm::dquat turn = glm::conjugate(world) * standing_.at(bones.end).rotation;
    out_.segment_from_cluster[bones.end] = {turn, -(turn * *c.end_in_extremity)};
  }

  /// Sets a hand or foot that is not seen while standing in line with the limb on
  /// average.
  void set_extremity_moving(std::size_t limb) {
    const HumanLimb& bones = human_limbs()[limb];
    glm::dquat sum(0, 0, 0, 0);
    for (const SegmentPair& pair : pairs(bones.lower, bones.end)) {
      const glm::dquat lower =
          pair.world_from_a.rotation *
          glm::conjugate(out_.segment_from_cluster.at(bones.lower).rotation);
      const glm::dquat turn = glm::conjugate(lower) * pair.world_from_b.rotation;
      sum = glm::dot(sum, turn) < 0.0 ? sum - turn : sum + turn;
    }
    const glm::dquat turn = glm::normalize(sum);
    out_.segment_from_cluster[bones.end] = {turn,
                                            -(turn * *centres_[limb].end_in_extremity)};
  }

  void place_standing(B bone, const glm::dquat& world, const glm::dvec3& origin) {
    const RigidTransform world_from_segment{world, origin};
    out_.segment_from_cluster[bone] = inverse(world_from_segment) * standing_.at(bone);
  }

  const Proportions& average_;
  std::map<B, RigidTransform> standing_;
  std::map<B, glm::dvec3> inside_;
  std::map<B, const TagCluster*> clusters_;
  std::vector<ClusterPoses> frames_;
  std::array<LimbCentres, 4> centres_;
  SegmentFrames out_;
};

}  // namespace

Result<SegmentFrames> find_segment_frames(std::span<const TagCluster> clusters,
                                          std::span<const ClusterPoses> standing,
                                          std::span<const ClusterPoses> moving,
                                          const Proportions& average) {
  return FrameFinder(clusters, standing, moving, average).run();
}

}  // namespace marey::reconstruct
