// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/contact_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "retarget/body/foot_shape.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

// The back of the heel, at the ankle's height, and the rear end of the sole: distances
// behind the ankle in lengths from ankle to ball. The former is that of a marker on a
// running shoe, chosen on one run and one drop jump; the latter is the full extent of the
// heel of foot_shape.h.
constexpr double kBackInBall = 0.7;
constexpr double kHeelInBall = kHeelInFoot * (1.0 + kToesInBall);
// The fastest instant of the swing lies within this before the strike. [s]
constexpr double kSwing_s = 0.4;
// The belt's velocity is that of most low frames, within this.
constexpr double kSameBelt_legs_per_s = 0.35;
// A part is on the floor if it is lower than this above its lowest height of the stance.
constexpr double kOnFloor_legs = 0.045;

enum EdgePoint : std::size_t {
  kBackPoint,
  kHeelPoint,
  kBallPoint,
  kTipPoint,
  kEdgePoints
};

// One point of a foot over the motion. Velocities are slopes of fitted lines.
struct EdgePath {
  std::vector<glm::dvec3> p_in_world;
  std::vector<double> across_m_per_s;  // Horizontal speed relative to the floor.
  std::vector<double> up_m_per_s;
};

using EdgePaths = std::array<std::array<EdgePath, kEdgePoints>, 2>;

void fit_velocities(double hz,
                    double smoothing_s,
                    const glm::dvec3& floor_velocity,
                    EdgePath& path) {
  const int count = static_cast<int>(path.p_in_world.size());
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * smoothing_s * hz)));
  for (int t = 0; t < count; ++t) {
    const int first = std::max(0, t - half);
    const int last = std::min(count - 1, t + half);
    const double middle = 0.5 * (first + last);
    glm::dvec3 slope(0.0);
    double weight = 0.0;
    for (int k = first; k <= last; ++k) {
      slope += (k - middle) * path.p_in_world[static_cast<std::size_t>(k)];
      weight += (k - middle) * (k - middle);
    }
    if (weight > 0.0) slope *= hz / weight;
    const glm::dvec3 relative = slope - floor_velocity;
    path.across_m_per_s.push_back(std::hypot(relative.x, relative.z));
    path.up_m_per_s.push_back(slope.y);
  }
}

EdgePaths edge_paths(const Motion& motion, const BodyMap& map) {
  EdgePaths paths;
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    for (std::size_t side = 0; side < 2; ++side) {
      const FootMap& foot = map.feet[side];
      const JointIndex ankle = map.leg(static_cast<int>(side)).end;
      const auto toes =
          map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      const glm::dquat turn = rotation_from_t_pose(map, world_from_joint, ankle);
      const glm::dquat toes_turn =
          toes ? rotation_from_t_pose(map, world_from_joint, *toes) : turn;
      const glm::dvec3 at = world_from_joint[index(ankle)].translation;
      const glm::dvec3 along = foot.ball_from_ankle_in_t_pose;
      const double length_m = std::hypot(along.x, along.z);
      const glm::dvec3 back(0.0, 0.0, -kBackInBall * length_m);
      const glm::dvec3 heel(0.0, -foot.ankle_height_m, -kHeelInBall * length_m);
      const glm::dvec3 ball = at + turn * along;
      paths[side][kBackPoint].p_in_world.push_back(at + turn * back);
      paths[side][kHeelPoint].p_in_world.push_back(at + turn * heel);
      paths[side][kBallPoint].p_in_world.push_back(ball);
      paths[side][kTipPoint].p_in_world.push_back(
          ball + toes_turn * foot.tip_from_ball_in_t_pose);
    }
  }
  return paths;
}

// All that the rules need: lengths in metres, times in frames.
struct EdgeScene {
  const EdgePaths& paths;
  double hz;
  int count;
  int search;  // Maximum distance of an edge, in frames.
  double strike_height_m;
  double strike_speed;  // Share of the swing's.
  double toe_off_speed_m_per_s;
  double flight_height_m;
  double on_floor_m;

  [[nodiscard]] double height_m(std::size_t side, std::size_t point, int t) const {
    return paths[side][point].p_in_world[static_cast<std::size_t>(t)].y;
  }
  [[nodiscard]] int clamped(int t) const { return std::clamp(t, 0, count - 1); }
  // Frame between `first` and `last` in which the point is lowest; the first of several.
  [[nodiscard]] int lowest(std::size_t side,
                           std::size_t point,
                           int first,
                           int last) const {
    int best = clamped(first);
    for (int t = best; t <= clamped(last); ++t) {
      if (height_m(side, point, t) < height_m(side, point, best)) best = t;
    }
    return best;
  }
};

// Time in frames at which the line from `before` at t - 1 to `after` at t passes `level`.
double passing(int t, double before, double after, double level) {
  return t - 1 + (level - before) / (after - before);
}

struct EdgeAt {
  double frame = 0.0;
  FootPart part = FootPart::kHeel;
};

// First instant at which a part of the foot is near its lowest height after a flight.
std::optional<EdgeAt> strike_by_height(const EdgeScene& scene,
                                       std::size_t side,
                                       int stance_first) {
  std::optional<EdgeAt> out;
  for (const std::size_t point : {kBackPoint, kBallPoint, kTipPoint}) {
    const int low = scene.lowest(
        side, point, stance_first - scene.search, stance_first + scene.search);
    const double level_m = scene.height_m(side, point, low) + scene.strike_height_m;
    int t = low;
    while (t > 0 && scene.height_m(side, point, t - 1) < level_m) --t;
    if (t == 0) continue;
    const double frame = passing(
        t, scene.height_m(side, point, t - 1), scene.height_m(side, point, t), level_m);
    const FootPart part = point == kBackPoint ? FootPart::kHeel : FootPart::kBall;
    if (!out || frame < out->frame) out = EdgeAt{frame, part};
  }
  return out;
}

// True if the other foot is off the floor at that frame.
bool is_in_flight(const EdgeScene& scene, std::size_t side, int t) {
  const std::size_t other = 1 - side;
  const int reach = static_cast<int>(std::lround(0.5 * scene.hz));
  for (const std::size_t point : {kBackPoint, kBallPoint}) {
    const int low = scene.lowest(other, point, t - reach, t + reach);
    const double above_m = scene.height_m(other, point, scene.clamped(t)) -
                           scene.height_m(other, point, low);
    if (above_m < scene.flight_height_m) return false;
  }
  return true;
}

// Maximum horizontal speed of a point in the swing that ends at a frame. [m/s]
double swing_speed(const EdgeScene& scene, const EdgePath& path, int t) {
  const int first = scene.clamped(t - static_cast<int>(std::lround(kSwing_s * scene.hz)));
  return *std::max_element(path.across_m_per_s.begin() + first,
                           path.across_m_per_s.begin() + t + 1);
}

// First instant from which one point, while low, advances no more.
std::optional<double> slowing(const EdgeScene& scene,
                              std::size_t side,
                              std::size_t point,
                              int stance_first) {
  const EdgePath& path = scene.paths[side][point];
  const auto speed = [&](int t) {
    return path.across_m_per_s[static_cast<std::size_t>(t)];
  };
  const int low =
      scene.lowest(side, point, stance_first - scene.search, stance_first + scene.search);
  const double on_floor_m = scene.height_m(side, point, low) + scene.on_floor_m;
  const double slow = scene.strike_speed * swing_speed(scene, path, stance_first);
  const auto rests = [&](int t) {
    return speed(t) < slow && scene.height_m(side, point, t) < on_floor_m;
  };
  // A slow walker's foot is detected while it still advances.
  int t = stance_first;
  while (!rests(t) && t < scene.clamped(stance_first + scene.search)) ++t;
  if (!rests(t)) return std::nullopt;
  while (t > 0 && rests(t - 1)) --t;
  if (t == 0) return std::nullopt;
  return speed(t - 1) < slow ? t : passing(t, speed(t - 1), speed(t), slow);
}

// First instant at which the heel, or the ball if it lands first, advances no more.
std::optional<EdgeAt> strike_by_slowing(const EdgeScene& scene,
                                        std::size_t side,
                                        int stance_first) {
  const auto heel = slowing(scene, side, kHeelPoint, stance_first);
  const auto ball = slowing(scene, side, kBallPoint, stance_first);
  if (heel && (!ball || *heel <= *ball)) return EdgeAt{*heel, FootPart::kHeel};
  if (ball) return EdgeAt{*ball, FootPart::kBall};
  return std::nullopt;
}

std::optional<ContactEdge> find_strike(const EdgeScene& scene,
                                       std::size_t side,
                                       int stance_first) {
  const auto edge = [&](const EdgeAt& at, EdgeRule rule) {
    return ContactEdge{at.frame / scene.hz, at.part, rule};
  };
  const auto is_near = [&](const EdgeAt& at) {
    return std::abs(at.frame - stance_first) <= scene.search;
  };
  const auto landing = strike_by_height(scene, side, stance_first);
  constexpr double kBefore_s = 0.03;
  if (landing && is_near(*landing) &&
      is_in_flight(scene,
                   side,
                   static_cast<int>(std::floor(landing->frame - kBefore_s * scene.hz)))) {
    return edge(*landing, EdgeRule::kHeight);
  }
  const auto slowed = strike_by_slowing(scene, side, stance_first);
  if (slowed && is_near(*slowed)) return edge(*slowed, EdgeRule::kSlowing);
  return std::nullopt;
}

std::optional<ContactEdge> find_toe_off(const EdgeScene& scene,
                                        std::size_t side,
                                        int stance_last) {
  const EdgePath& ball = scene.paths[side][kBallPoint];
  const auto speed = [&](int t) {
    const auto k = static_cast<std::size_t>(t);
    return std::hypot(ball.across_m_per_s[k], 0.5 * ball.up_m_per_s[k]);
  };
  const int end = std::min(scene.count - 1, stance_last + scene.search);
  for (int t = stance_last + 1; t <= end; ++t) {
    if (speed(t) < scene.toe_off_speed_m_per_s) continue;
    const double before = speed(t - 1);
    const double frame = before < scene.toe_off_speed_m_per_s
                             ? passing(t, before, speed(t), scene.toe_off_speed_m_per_s)
                             : t - 1;
    return ContactEdge{frame / scene.hz, FootPart::kBall, EdgeRule::kLeaving};
  }
  return std::nullopt;
}

ContactEdges edges_of(const Motion& motion,
                      const BodyMap& map,
                      const Contacts& contacts,
                      const glm::dvec3& floor_velocity,
                      const ContactEdgeOptions& options) {
  ContactEdges out;
  out.floor_velocity_in_world = floor_velocity;
  EdgePaths paths = edge_paths(motion, map);
  for (auto& foot : paths) {
    for (EdgePath& path : foot) {
      fit_velocities(motion.rate.hz, options.smoothing_s, floor_velocity, path);
    }
  }
  const double leg_m = map.leg_length_m;
  const EdgeScene scene{paths,
                        motion.rate.hz,
                        static_cast<int>(motion.poses.size()),
                        static_cast<int>(std::lround(options.search_s * motion.rate.hz)),
                        options.strike_height_legs * leg_m,
                        options.strike_speed_share,
                        options.toe_off_speed_legs_per_s * leg_m,
                        options.flight_height_legs * leg_m,
                        kOnFloor_legs * leg_m};
  for (std::size_t side = 0; side < 2; ++side) {
    for (const FrameRange& stance : contacts.feet[side].stance) {
      StanceEdges edges{stance, {}, {}};
      if (stance.first > 0) edges.strike = find_strike(scene, side, stance.first);
      if (stance.last + 1 < scene.count) {
        edges.toe_off = find_toe_off(scene, side, stance.last);
      }
      out.feet[side].push_back(edges);
    }
  }
  return out;
}

// Returns the commonest horizontal velocity of the balls while they are low: the one with
// most others within the tolerance. nullopt if it is not that of most of them.
std::optional<glm::dvec3> belt_velocity(const Motion& motion, const BodyMap& map) {
  constexpr double kLow = 0.35;           // Share of the frames that are low.
  constexpr double kMost = 0.5;           // Share of low frames on the belt.
  constexpr std::size_t kMaxTried = 400;  // Bounds the cost.
  const EdgePaths paths = edge_paths(motion, map);
  std::vector<glm::dvec2> low;
  for (const auto& foot : paths) {
    const auto& p = foot[kBallPoint].p_in_world;
    if (p.size() < 3) return std::nullopt;
    std::vector<double> heights;
    for (const glm::dvec3& at : p) heights.push_back(at.y);
    const double level_m = quantile(heights, kLow);
    for (std::size_t t = 1; t + 1 < p.size(); ++t) {
      if (p[t].y > level_m) continue;
      const glm::dvec3 v = 0.5 * motion.rate.hz * (p[t + 1] - p[t - 1]);
      low.emplace_back(v.x, v.z);
    }
  }
  const double same = kSameBelt_legs_per_s * map.leg_length_m;
  const std::size_t step = std::max<std::size_t>(1, low.size() / kMaxTried);
  std::size_t most = 0;
  glm::dvec2 mean(0.0);
  for (std::size_t i = 0; i < low.size(); i += step) {
    std::size_t near = 0;
    glm::dvec2 sum(0.0);
    for (const glm::dvec2& v : low) {
      if (glm::distance(v, low[i]) > same) continue;
      ++near;
      sum += v;
    }
    if (near <= most) continue;
    most = near;
    mean = sum / static_cast<double>(near);
  }
  if (static_cast<double>(most) < kMost * static_cast<double>(low.size())) {
    return std::nullopt;
  }
  return glm::dvec3(mean.x, 0.0, mean.y);
}

bool has_stance(const Contacts& contacts) {
  return !contacts.feet[0].stance.empty() || !contacts.feet[1].stance.empty();
}

}  // namespace

ContactEdges find_contact_edges(const Motion& motion,
                                const BodyMap& map,
                                const Contacts& contacts,
                                const ContactEdgeOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(motion.poses.size()));
  return edges_of(motion, map, contacts, glm::dvec3(0.0), options);
}

ContactEdges find_contact_edges(const Motion& motion,
                                const BodyMap& map,
                                const ContactEdgeOptions& options) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  const Contacts contacts = detect_contacts(motion, map);
  if (has_stance(contacts)) {
    return edges_of(motion, map, contacts, glm::dvec3(0.0), options);
  }
  const auto belt = belt_velocity(motion, map);
  if (!belt) return {};
  Motion on_belt = motion;
  for (std::size_t t = 0; t < on_belt.poses.size(); ++t) {
    on_belt.poses[t].root_in_world -= static_cast<double>(t) / motion.rate.hz * *belt;
  }
  const Contacts moving = detect_contacts(on_belt, map);
  if (!has_stance(moving)) return {};
  return edges_of(motion, map, moving, *belt, options);
}

}  // namespace marey::retarget
