// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/contact_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"
#include "retarget/contacts/descent_arrest.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/foot_paths.h"

namespace marey::retarget {
namespace {

// The fastest instant of the swing lies within this before the strike. [s]
constexpr double kSwing_s = 0.4;
// A foot whose heel was never faster than this made no step.
constexpr double kMinSwing_legs_per_s = 0.7;
// A part is on the floor if it is lower than this above its lowest height of the stance.
constexpr double kOnFloor_legs = 0.045;

// All that the rules need: lengths in metres, times in frames.
struct EdgeScene {
  const EdgePaths& paths;
  double hz;
  int count;
  int search;  // Maximum distance of an edge, in frames.
  double strike_height_m;
  double strike_speed;  // Share of the swing's.
  double toe_off_speed_m_per_s;
  double min_swing_m_per_s;
  double min_arrest_m_per_s2;
  double arrest_delay_s;
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
    // Back to where the point is clearly higher, then forward to the level: noise on the
    // floor is no flight.
    int t = low;
    while (t > 0 && scene.height_m(side, point, t) < level_m + scene.strike_height_m) --t;
    while (t < low && scene.height_m(side, point, t) >= level_m) ++t;
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
  const double swing = swing_speed(scene, path, stance_first);
  if (swing < scene.min_swing_m_per_s) return std::nullopt;
  const double slow = scene.strike_speed * swing;
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

// First instant at which the floor arrests the descent of the foot, near the instant at
// which its advance ends. The ball's height gives the most distinct step: the heel's
// depends on the shoe.
std::optional<EdgeAt> strike_by_arrest(const EdgeScene& scene,
                                       std::size_t side,
                                       const EdgeAt& slowed) {
  std::vector<double> heights_m;
  for (const glm::dvec3& p : scene.paths[side][kBallPoint].p_in_world) {
    heights_m.push_back(p.y);
  }
  const auto arrest = find_descent_arrest(heights_m, scene.hz, slowed.frame);
  if (!arrest || arrest->change_m_per_s2 < scene.min_arrest_m_per_s2) return std::nullopt;
  const double frame = arrest->frame - scene.arrest_delay_s * scene.hz;
  if (frame < 0.0) return std::nullopt;
  return EdgeAt{frame, slowed.part};
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
  if (!slowed || !is_near(*slowed)) return std::nullopt;
  if (const auto arrested = strike_by_arrest(scene, side, *slowed)) {
    return edge(*arrested, EdgeRule::kArrest);
  }
  return edge(*slowed, EdgeRule::kSlowing);
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
  const EdgePaths paths = edge_paths(motion, map, options.smoothing_s, floor_velocity);
  const double leg_m = map.leg_length_m;
  const EdgeScene scene{paths,
                        motion.rate.hz,
                        static_cast<int>(motion.poses.size()),
                        static_cast<int>(std::lround(options.search_s * motion.rate.hz)),
                        options.strike_height_legs * leg_m,
                        options.strike_speed_share,
                        options.toe_off_speed_legs_per_s * leg_m,
                        kMinSwing_legs_per_s * leg_m,
                        options.arrest_legs_per_s2 * leg_m,
                        options.arrest_delay_s,
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

// Moves the ends of the runs within the stance `from` to those of `to`.
void move_runs(const FrameRange& from,
               const FrameRange& to,
               std::vector<FrameRange>& runs) {
  for (FrameRange& run : runs) {
    if (run.last < from.first || run.first > from.last) continue;
    run.first = run.first == from.first ? to.first : std::max(run.first, to.first);
    run.last = run.last == from.last ? to.last : std::min(run.last, to.last);
  }
  std::erase_if(runs, [](const FrameRange& run) { return run.first > run.last; });
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

void move_to_edges(const ContactEdges& edges, FrameRate rate, Contacts& contacts) {
  for (std::size_t side = 0; side < 2; ++side) {
    FootContacts& foot = contacts.feet[side];
    MAREY_ASSERT(edges.feet[side].size() == foot.stance.size());
    // From the last to the first: the stance after has moved already.
    int next_first = contacts.frame_count + 1;
    for (std::size_t i = foot.stance.size(); i-- > 0;) {
      const FrameRange from = foot.stance[i];
      const StanceEdges& found = edges.feet[side][i];
      FrameRange to = from;
      if (found.strike) {
        to.first = static_cast<int>(std::ceil(found.strike->time_s * rate.hz));
        // Not into the frames of the stance before, nor into those next to it.
        const int free = i > 0 ? foot.stance[i - 1].last + 2 : 0;
        to.first = std::clamp(to.first, std::min(free, from.first), from.last);
      }
      if (found.toe_off) {
        to.last = static_cast<int>(std::floor(found.toe_off->time_s * rate.hz));
        to.last = std::max(from.last, std::min(to.last, next_first - 2));
      }
      move_runs(from, to, foot.heel);
      move_runs(from, to, foot.ball);
      foot.stance[i] = to;
      next_first = to.first;
      std::erase_if(foot.heel_up, [&](FrameRange& run) {
        if (run.last >= from.first && run.first <= from.last) {
          run.first = std::max(run.first, to.first);
        }
        return run.first > run.last;
      });
    }
  }
}

Contacts detect_loaded_contacts(const Motion& motion,
                                const BodyMap& map,
                                const DetectContactsOptions& options,
                                const ContactEdgeOptions& edge_options) {
  Contacts contacts = detect_contacts(motion, map, options);
  move_to_edges(
      find_contact_edges(motion, map, contacts, edge_options), motion.rate, contacts);
  return contacts;
}

}  // namespace marey::retarget
