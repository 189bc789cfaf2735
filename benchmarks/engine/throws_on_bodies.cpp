// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/throws_on_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <glm/geometric.hpp>

#include "app/motion/retarget_files.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using engine::CharacterId;
using engine::Engine;
using engine::ThrowParameters;
constexpr double kToDegrees = 180.0 / 3.14159265358979323846;
constexpr std::size_t kBodies = 5;

}  // namespace

std::vector<RigidTransform> shown_joints(const Engine& engine, CharacterId who) {
  const Skeleton& skeleton = engine.player(who).character().skeleton;
  std::vector<RigidTransform> joints(skeleton.joints.size());
  world_from_joints(skeleton, engine.pose(who), joints);
  return joints;
}

glm::dquat turned(const retarget::BodyMap& map,
                  const std::vector<RigidTransform>& joints,
                  JointIndex joint) {
  return joints[index(joint)].rotation *
         glm::conjugate(map.joints[index(joint)].t_pose_from_joint);
}

engine::CharacterSpec spec_of(const Skeleton& body) {
  engine::CharacterSpec spec;
  spec.map = *retarget::map_body(body);
  spec.character = *retarget::make_character("body", body, spec.map);
  spec.reaches = true;
  return spec;
}

std::vector<Skeleton> bodies_for(const Skeleton& own) {
  testing::Dice dice(11);
  std::vector<Skeleton> out{own};
  while (out.size() < kBodies) out.push_back(testing::random_humanoid(dice));
  return out;
}

Result<engine::ClipSource> read_throw(const fs::path& file) {
  const auto read = app::read_motion({file});
  if (!read) return read.error();
  engine::ClipSource source;
  source.name = "throw";
  source.motion = read->motion;
  auto map = retarget::map_body(source.motion.skeleton);
  if (!map) return map.error();
  source.map = *std::move(map);
  source.contacts = retarget::detect_contacts(source.motion, source.map);
  const std::size_t wrist = index(source.map.limbs[1]->end);
  const double hz = source.motion.rate.hz;
  double fastest = 0.0;
  double release_s = 0.0;
  glm::dvec3 before(0.0);
  for (std::size_t i = 0; i < source.motion.poses.size(); ++i) {
    const auto joints = world_from_joints(source.motion.skeleton, source.motion.poses[i]);
    const double step = glm::distance(joints[wrist].translation, before);
    before = joints[wrist].translation;
    const double at_s = static_cast<double>(i) / hz;
    if (i == 0 || at_s < 0.8 || step <= fastest) continue;
    fastest = step;
    release_s = at_s;
  }
  // Only a second around the release.
  const auto first = static_cast<std::ptrdiff_t>((release_s - 0.7) * hz);
  const auto last = static_cast<std::ptrdiff_t>((release_s + 0.7) * hz);
  auto& poses = source.motion.poses;
  const auto count = static_cast<std::ptrdiff_t>(poses.size());
  poses.erase(poses.begin() + std::min(last, count), poses.end());
  poses.erase(poses.begin(), poses.begin() + first);
  source.contacts = retarget::detect_contacts(source.motion, source.map);
  const double event_s = release_s - static_cast<double>(first) / hz;
  source.annotations.notes.push_back({"release", event_s, event_s});
  return source;
}

namespace {

struct ThrowErrors {
  double place_mm = 0.0;
  double angle_deg = 0.0;
  double speed_percent = 0.0;
  double time_ms = 0.0;
  int played = 0;
  int beyond_reach = 0;
};

struct ThrowFrame {
  glm::dvec3 wrist{0.0};
  glm::dvec3 ball{0.0};
  glm::dvec3 hips{0.0};
  double heading_rad = 0.0;
};

ThrowFrame throw_frame(const Engine& engine, CharacterId who, double palm_m) {
  const retarget::BodyMap& map = engine.player(who).map();
  const auto joints = shown_joints(engine, who);
  const retarget::LimbMap& arm = *map.limbs[1];
  ThrowFrame out;
  out.wrist = joints[index(arm.end)].translation;
  out.ball = out.wrist + turned(map, joints, arm.end) * (palm_m * arm.along_in_t_pose);
  out.hips = joints[index(map.hips())].translation;
  const glm::dquat hips = turned(map, joints, map.hips());
  out.heading_rad = 2.0 * std::atan2(hips.y, hips.w);
  return out;
}

// Continues three frames that are a step apart by `steps` steps from the last one: value,
// and difference per step.
std::array<glm::dvec3, 2> continued(const std::array<ThrowFrame, 3>& f,
                                    glm::dvec3 ThrowFrame::*value,
                                    double steps) {
  const glm::dvec3 slope = 0.5 * (3.0 * f[2].*value - 4.0 * f[1].*value + f[0].*value);
  const glm::dvec3 bend = f[2].*value - 2.0 * f[1].*value + f[0].*value;
  return {f[2].*value + steps * slope + 0.5 * steps * steps * bend, slope + steps * bend};
}

void judge_throw(const ThrowParameters& judged,
                 const ThrowParameters& wanted,
                 ThrowErrors& out) {
  const auto worse = [](double& worst, double error) {
    worst = std::max(worst, std::abs(error));
  };
  worse(out.place_mm,
        1e3 * glm::distance(judged.wrist_in_heading_m, wanted.wrist_in_heading_m));
  worse(out.speed_percent, 1e2 * (judged.speed_m_s / wanted.speed_m_s - 1.0));
  worse(out.time_ms, 1e3 * (judged.release_s - wanted.release_s));
  const glm::dvec3 u =
      engine::throw_direction(0.0, judged.azimuth_rad, judged.elevation_rad);
  const glm::dvec3 v =
      engine::throw_direction(0.0, wanted.azimuth_rad, wanted.elevation_rad);
  worse(out.angle_deg, kToDegrees * std::asin(glm::length(glm::cross(u, v))));
}

engine::ThrowChanges changed(const ThrowParameters& p, int parameter, double by) {
  engine::ThrowChanges out;
  const glm::dvec3& w = p.wrist_in_heading_m;
  if (parameter == 0) out.x_m = w.x + 0.1 * by;
  if (parameter == 1) out.y_m = w.y + 0.1 * by;
  if (parameter == 2) out.z_m = w.z + 0.1 * by;
  if (parameter == 3) out.azimuth_rad = p.azimuth_rad + 0.35 * by;
  if (parameter == 4) {
    out.elevation_rad = std::clamp(p.elevation_rad + 0.35 * by, -1.5, 1.5);
  }
  if (parameter == 5) out.speed_m_s = p.speed_m_s * (1.0 + 0.3 * by);
  if (parameter == 6) out.release_s = p.release_s + 0.15 * by;
  return out;
}

void play_throw(const std::shared_ptr<const engine::MotionBase>& base,
                const Skeleton& body,
                int parameter,
                double by,
                ThrowErrors& out) {
  Engine engine = *Engine::make(base, {.step_hz = 1000.0});
  const CharacterId who = *engine.add(spec_of(body));
  engine::ThrowWish wish;
  wish.action.clip = "throw";
  wish.action.entry_search_s = 0.0;
  const auto captured = engine.ask(who, wish);
  if (!captured) return;
  wish.asked = changed(captured->captured, parameter, by);
  const auto answer = engine.ask(who, wish);
  if (!answer || !answer->reachable) {
    ++out.beyond_reach;
    return;
  }
  if (!engine.play(who, wish)) return;
  const double palm_m = engine::reach_lengths(body, engine.player(who).map(), 1).palm_m;
  std::array<ThrowFrame, 3> last{};
  for (int i = 0; i < 1300; ++i) {
    engine.advance();
    const auto& result = engine.player(who).throwing(1)->result();
    if (!result) {
      last = {last[1], last[2], throw_frame(engine, who, palm_m)};
      continue;
    }
    const double at_s = result->ball.time_s;
    const double steps = (at_s - (engine.time_s() - engine.step_s())) / engine.step_s();
    const auto wrist = continued(last, &ThrowFrame::wrist, steps);
    const auto ball = continued(last, &ThrowFrame::ball, steps);
    const auto hips = continued(last, &ThrowFrame::hips, steps);
    const glm::dquat turn =
        glm::angleAxis(-last[2].heading_rad, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 velocity = turn * (ball[1] / engine.step_s());
    ThrowParameters judged;
    judged.wrist_in_heading_m = turn * (wrist[0] - glm::dvec3(hips[0].x, 0.0, hips[0].z));
    judged.speed_m_s = glm::length(velocity);
    judged.azimuth_rad = std::atan2(velocity.x, velocity.z);
    judged.elevation_rad = std::asin(velocity.y / judged.speed_m_s);
    judged.release_s = at_s;
    judge_throw(judged, answer->wanted, out);
    ++out.played;
    return;
  }
}

}  // namespace

ResultTable throw_table(const engine::ClipSource& source) {
  const auto base = *engine::MotionBase::make(*engine::make_moves({&source, 1}));
  const std::array<const char*, 7> names{
      "x", "y", "z", "azimuth", "elevation", "speed", "instant"};
  ResultTable table;
  table.id = "throws";
  table.title = "Throws on 5 bodies, 9 values of each parameter, worst";
  table.columns = {{"parameter"},
                   {"place mm", 3},
                   {"direction deg", 3},
                   {"speed %", 3},
                   {"time ms", 3},
                   {"played", 0},
                   {"beyond reach", 0}};
  for (int parameter = 0; parameter < 7; ++parameter) {
    ThrowErrors errors;
    for (const Skeleton& body : bodies_for(source.motion.skeleton)) {
      for (int value = -4; value <= 4; ++value) {
        play_throw(base, body, parameter, value / 4.0, errors);
      }
    }
    table.rows.push_back({std::string(names[static_cast<std::size_t>(parameter)]),
                          errors.place_mm,
                          errors.angle_deg,
                          errors.speed_percent,
                          errors.time_ms,
                          static_cast<double>(errors.played),
                          static_cast<double>(errors.beyond_reach)});
  }
  return table;
}

}  // namespace marey
