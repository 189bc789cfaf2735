// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures motion models on bodies, from the shown postures, by forward kinematics of
// its own.
//
//   measure_models_bodies ../shared/data/mocap
//
// Throws: CMU 02_05, the ball leaves at the greatest speed of the right wrist; 7
// parameters by 9 values on 5 bodies, at 1000 steps/s. Steered walks: 8 goals on 5 bodies
// at 60 steps/s. The slower one of ankle and ball is the point that bears. Answers: the
// cost of Engine::ask().
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include <glm/geometric.hpp>

#include "benchmarks/engine/steered_clips.h"
#include "benchmarks/engine/throws_on_bodies.h"
#include "benchmarks/parts/result_table.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
using engine::CharacterId;
using engine::Engine;
constexpr double kDegrees = 180.0 / 3.14159265358979323846;

struct StanceFigures {
  double worst_twist_deg = 0.0;
  double worst_slide_cm_s = 0.0;
  double slide_m = 0.0;
  double stood_s = 0.0;
  double worst_away_m = 0.0;
  int arrived = 0;
  int walked = 0;
};

struct FootNow {
  bool stands = false;
  glm::dvec2 ankle{0.0};
  glm::dvec2 ball{0.0};
  double yaw_rad = 0.0;
};

FootNow foot_now(const Engine& engine, CharacterId who, std::size_t side) {
  const engine::CharacterPlayer& player = engine.player(who);
  const retarget::BodyMap& map = player.map();
  const auto joints = shown_joints(engine, who);
  const JointIndex joint =
      *map.joint_of[index(side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot)];
  const glm::dvec3 ankle = joints[index(joint)].translation;
  const glm::dvec3 along =
      turned(map, joints, joint) * map.feet[side].ball_from_ankle_in_t_pose;
  return {player.report().stands[side],
          {ankle.x, ankle.z},
          {ankle.x + along.x, ankle.z + along.z},
          std::atan2(along.x, along.z)};
}

void walk_to(const std::shared_ptr<const engine::MotionBase>& base,
             const Skeleton& body,
             glm::dvec2 goal,
             StanceFigures& out) {
  Engine engine = *Engine::make(base);
  const CharacterId who = *engine.add(spec_of(body));
  engine::SteerWish wish;
  wish.action.clip = base->clip(0).name;
  wish.goal_xz_m = goal;
  if (!engine.play(who, wish)) return;
  ++out.walked;
  std::array<FootNow, 2> last{};
  std::array<double, 2> stood_yaw{};
  for (int i = 0; i < 2400; ++i) {
    engine.advance();
    for (std::size_t side = 0; side < 2; ++side) {
      const FootNow now = foot_now(engine, who, side);
      if (!last[side].stands) {
        stood_yaw[side] = now.yaw_rad;
      } else if (now.stands) {
        const double slide_m = std::min(glm::distance(now.ankle, last[side].ankle),
                                        glm::distance(now.ball, last[side].ball));
        const double twist =
            kDegrees * std::abs(std::remainder(now.yaw_rad - stood_yaw[side],
                                               2.0 * 3.14159265358979323846));
        out.worst_twist_deg = std::max(out.worst_twist_deg, twist);
        out.worst_slide_cm_s = std::max(out.worst_slide_cm_s, 6000.0 * slide_m);
        out.slide_m += slide_m;
        out.stood_s += 1.0 / 60.0;
      }
      last[side] = now;
    }
    const engine::SteerPlayer* steer = engine.player(who).steering();
    if (steer != nullptr && steer->last().arrived) {
      ++out.arrived;
      break;
    }
  }
  const engine::RootPlace& root = engine.player(who).blend().root();
  out.worst_away_m =
      std::max(out.worst_away_m, glm::distance(goal, glm::dvec2(root.x_m, root.z_m)));
}

void add_stance_row(const engine::ClipSource& source, ResultTable& table) {
  const auto moves = engine::make_moves({&source, 1});
  if (!moves) return;
  const auto base = engine::MotionBase::make(*moves);
  if (!base) return;
  StanceFigures figures;
  for (const Skeleton& body : bodies_for(source.motion.skeleton)) {
    for (int i = 0; i < 8; ++i) {
      const double angle = 0.785398 * i;
      walk_to(*base, body, 6.0 * glm::dvec2(std::sin(angle), std::cos(angle)), figures);
    }
  }
  table.rows.push_back({source.name,
                        figures.worst_twist_deg,
                        1e2 * figures.slide_m / std::max(1e-9, figures.stood_s),
                        figures.worst_slide_cm_s,
                        figures.worst_away_m,
                        static_cast<double>(figures.arrived),
                        static_cast<double>(figures.walked)});
}

template <class Ask>
double cost_us(const Ask& ask) {
  std::vector<double> times;
  for (int i = 0; i < 300; ++i) {
    const auto start = std::chrono::steady_clock::now();
    ask();
    times.push_back(std::chrono::duration<double, std::micro>(
                        std::chrono::steady_clock::now() - start)
                        .count());
  }
  std::nth_element(times.begin(), times.begin() + 150, times.end());
  return times[150];
}

ResultTable ask_table(const engine::ClipSource& thrown, const engine::ClipSource& walk) {
  std::array sources{thrown, walk};
  sources[0].annotations.notes.push_back({"arrive", 0.7, 0.7});
  const auto base = *engine::MotionBase::make(*engine::make_moves(sources));
  Engine engine = *Engine::make(base);
  const CharacterId who = *engine.add(spec_of(thrown.motion.skeleton));
  engine::ActionWish plays;
  plays.clip = walk.name;
  (void)engine.play(who, plays);
  engine.advance(30);
  engine::ReachWish reach;
  reach.action.clip = "throw";
  reach.target.p_in_world = {0.2, 1.2, 0.5};
  engine::ThrowWish throws;
  throws.action.clip = "throw";
  throws.asked.speed_m_s = 8.0;
  throws.aim_in_world = glm::dvec3(0.5, 1.0, 6.0);
  engine::FollowWish follow;
  follow.target_in_world = {0.2, 1.2, 0.5};
  engine::SteerWish steer;
  steer.action.clip = walk.name;
  steer.goal_xz_m = {3.0, 4.0};
  ResultTable table;
  table.id = "ask";
  table.title = "Cost of Engine::ask(), median of 300";
  table.columns = {{"model"}, {"us", 1}};
  table.rows = {{std::string("reach"), cost_us([&] { (void)engine.ask(who, reach); })},
                {std::string("throw"), cost_us([&] { (void)engine.ask(who, throws); })},
                {std::string("follow"), cost_us([&] { (void)engine.ask(who, follow); })},
                {std::string("steer"), cost_us([&] { (void)engine.ask(who, steer); })}};
  return table;
}

int run(const fs::path& mocap) {
  const auto thrown = read_throw(mocap / "cmu_asfamc/02_05.amc");
  const auto walk = read_cycle(mocap / "cmu_asfamc/02_01.amc", "walk 02_01");
  if (!thrown || !walk) {
    std::fprintf(
        stderr, "%s\n", (!thrown ? thrown.error() : walk.error()).message().c_str());
    return 1;
  }
  print_table(ask_table(*thrown, *walk));
  ResultTable stances;
  stances.id = "stances";
  stances.title = "Standing feet of walks to 8 goals on 5 bodies";
  stances.columns = {{"motion"},
                     {"worst twist deg", 2},
                     {"mean slide cm/s", 3},
                     {"worst slide cm/s", 2},
                     {"worst arrival m", 3},
                     {"arrived", 0},
                     {"walked", 0}};
  add_stance_row(*walk, stances);
  for (const auto& [name, file] : std::vector<std::pair<std::string, fs::path>>{
           {"run 02_03", mocap / "cmu_asfamc/02_03.amc"},
           {"walk bandai", mocap / "bandai/dataset-1_walk_normal_001.bvh"},
           {"dance bandai", mocap / "bandai/dataset-1_dance-short_normal_001.bvh"}}) {
    const auto source = read_cycle(file, name);
    if (source) add_stance_row(*source, stances);
  }
  print_table(stances);
  print_table(throw_table(*thrown));
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: measure_models_bodies MOCAP\n");
    return 2;
  }
  return marey::run(argv[1]);
}
